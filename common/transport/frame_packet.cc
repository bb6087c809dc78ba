#include "common/transport/frame_packet.h"

#include <isotherm_frames.h>

#include <algorithm>
#include <limits>

#include "common/transport/conversions.h"
#include "common/transport/frame_packet.pb.h"

namespace isotherm {
namespace {

using transport::FramePacket;

/// A larger one is as unknown as the largest octet.
std::uint8_t Octet(std::uint32_t value) {
  return static_cast<std::uint8_t>(
      std::min<std::uint32_t>(value, std::numeric_limits<std::uint8_t>::max()));
}

/// Enters what both kinds of frame have; `wire` holds the frame as the whole one would be sent.
template <typename Wire>
void PackCommon(const Wire& wire, FramePacket* packet) {
  packet->set_session(wire.stamp.session);
  packet->set_frame_number(wire.stamp.frame_number);
  packet->set_device_ticks_us(wire.stamp.device_ticks_us);
  packet->set_capture_time_ns(wire.stamp.capture_time_ns);
  packet->set_capture_sigma_ns(wire.stamp.capture_sigma_ns);
  packet->set_encoding(wire.image.encoding);
  packet->set_width(wire.image.width);
  packet->set_height(wire.image.height);
  packet->set_payload(wire.image.payload._buffer, wire.image.payload._length);
}

/// The payload is borrowed from `packet`.
template <typename Wire>
void UnpackCommon(const FramePacket& packet, Wire* wire) {
  wire->stamp = {.session = packet.session(),
                 .frame_number = packet.frame_number(),
                 .device_ticks_us = packet.device_ticks_us(),
                 .capture_time_ns = packet.capture_time_ns(),
                 .capture_sigma_ns = packet.capture_sigma_ns()};
  const std::string& payload = packet.payload();
  const auto bytes = static_cast<std::uint32_t>(payload.size());
  wire->image.encoding = Octet(packet.encoding());
  wire->image.width = packet.width();
  wire->image.height = packet.height();
  // Only read; the C type has no const.
  wire->image.payload = {
      ._maximum = bytes,
      ._length = bytes,
      ._buffer = reinterpret_cast<std::uint8_t*>(const_cast<char*>(payload.data())),
      ._release = false};
}

std::vector<std::uint8_t> Serialized(const FramePacket& packet) {
  std::vector<std::uint8_t> bytes(packet.ByteSizeLong());
  packet.SerializeToArray(bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

bool Parse(std::span<const std::uint8_t> bytes, FramePacket* packet) {
  return bytes.size() <= std::numeric_limits<int>::max() &&
         packet->ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

}  // namespace

std::vector<std::uint8_t> PackFrame(const EncodedDepthFrame& frame) {
  isotherm_wire_DepthFrame wire{};
  ToWire(frame, &wire);
  FramePacket packet;
  PackCommon(wire, &packet);
  packet.mutable_depth()->set_depth_scale(wire.depth_scale);
  return Serialized(packet);
}

std::vector<std::uint8_t> PackFrame(const EncodedThermalFrame& frame) {
  isotherm_wire_ThermalFrame wire{};
  ToWire(frame, &wire);
  FramePacket packet;
  PackCommon(wire, &packet);
  transport::ThermalPart& thermal = *packet.mutable_thermal();
  thermal.set_nuc_state(wire.nuc_state);
  thermal.set_nuc_source(wire.nuc_source);
  thermal.set_valid(wire.valid);
  if (wire.has_seconds_since_nuc) thermal.set_seconds_since_nuc(wire.seconds_since_nuc);
  thermal.set_fpa_celsius(wire.fpa_celsius);
  thermal.set_housing_celsius(wire.housing_celsius);
  thermal.set_shutter_celsius(wire.shutter_celsius);
  if (wire.has_scale) {
    thermal.set_kelvin_per_count(wire.kelvin_per_count);
    thermal.set_offset_kelvin(wire.offset_kelvin);
  }
  return Serialized(packet);
}

std::optional<RefusalCause> UnpackFrame(std::span<const std::uint8_t> bytes,
                                        EncodedDepthFrame* frame) {
  FramePacket packet;
  if (!Parse(bytes, &packet) || !packet.has_depth()) return RefusalCause::kIncomplete;
  isotherm_wire_DepthFrame wire{};
  UnpackCommon(packet, &wire);
  wire.depth_scale = packet.depth().depth_scale();
  return FromWire(wire, frame);
}

std::optional<RefusalCause> UnpackFrame(std::span<const std::uint8_t> bytes,
                                        EncodedThermalFrame* frame) {
  FramePacket packet;
  if (!Parse(bytes, &packet) || !packet.has_thermal()) return RefusalCause::kIncomplete;
  const transport::ThermalPart& thermal = packet.thermal();
  isotherm_wire_ThermalFrame wire{};
  UnpackCommon(packet, &wire);
  wire.nuc_state = Octet(thermal.nuc_state());
  wire.nuc_source = Octet(thermal.nuc_source());
  wire.valid = thermal.valid();
  wire.has_seconds_since_nuc = thermal.has_seconds_since_nuc();
  wire.seconds_since_nuc = thermal.seconds_since_nuc();
  wire.fpa_celsius = thermal.fpa_celsius();
  wire.housing_celsius = thermal.housing_celsius();
  wire.shutter_celsius = thermal.shutter_celsius();
  wire.has_scale = thermal.has_kelvin_per_count() && thermal.has_offset_kelvin();
  wire.kelvin_per_count = thermal.kelvin_per_count();
  wire.offset_kelvin = thermal.offset_kelvin();
  return FromWire(wire, frame);
}

}  // namespace isotherm
