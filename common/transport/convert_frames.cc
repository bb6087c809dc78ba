#include <isotherm_frames.h>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"

namespace isotherm {
namespace {

isotherm_wire_FrameStamp ToWireStamp(const FrameHeader& header) {
  return {.session = header.session,
          .frame_number = header.frame_number,
          .device_ticks_us = header.device_ticks.time_since_epoch().count(),
          .capture_time_ns = ToNanoseconds(header.capture_time),
          .capture_sigma_ns = header.capture_sigma.count()};
}

FrameHeader FromWireStamp(const isotherm_wire_FrameStamp& stamp) {
  return {.session = stamp.session,
          .frame_number = stamp.frame_number,
          .device_ticks = DeviceTicks(DeviceClock::duration(stamp.device_ticks_us)),
          .capture_time = CaptureTimeFromNanoseconds(stamp.capture_time_ns),
          .capture_sigma = Nanoseconds(stamp.capture_sigma_ns)};
}

isotherm_wire_PackedImage BorrowImage(const EncodedImage& image) {
  isotherm_wire_PackedImage packed{};
  packed.encoding = static_cast<std::uint8_t>(image.encoding);
  packed.width = static_cast<std::uint32_t>(image.width);
  packed.height = static_cast<std::uint32_t>(image.height);
  const auto bytes = static_cast<std::uint32_t>(image.payload.size());
  // The middleware only reads it; the C type has no const.
  packed.payload = {._maximum = bytes,
                    ._length = bytes,
                    ._buffer = const_cast<std::uint8_t*>(image.payload.data()),
                    ._release = false};
  return packed;
}

EncodedImage CopyImage(const isotherm_wire_PackedImage& packed) {
  EncodedImage image;
  image.encoding = static_cast<Encoding>(packed.encoding);
  image.width = static_cast<int>(packed.width);
  image.height = static_cast<int>(packed.height);
  // Copied: the middleware reuses its buffer as soon as the sample is given back.
  image.payload.assign(packed.payload._buffer, packed.payload._buffer + packed.payload._length);
  return image;
}

FrameFields FieldsOf(const isotherm_wire_FrameStamp& stamp,
                     const isotherm_wire_PackedImage& image) {
  return {.frame_number = stamp.frame_number,
          .capture_time_ns = stamp.capture_time_ns,
          .capture_sigma_ns = stamp.capture_sigma_ns,
          .encoding = image.encoding,
          .width = image.width,
          .height = image.height,
          .payload_bytes = image.payload._length};
}

/// Reads the scale of a frame's counts. An old edge does not send one: its counts are centi-kelvin.
std::optional<RefusalCause> FromWireScale(const isotherm_wire_ThermalFrame& from,
                                          EncodedThermalFrame* to) {
  // Centi-kelvin are said by the encoding alone, so that a scale beside it cannot contradict it.
  if (!IsScaled(to->image.encoding)) return std::nullopt;
  if (!from.has_scale) return RefusalCause::kOutOfRange;
  to->scale = {from.kelvin_per_count, from.offset_kelvin};
  return CheckThermalScale(to->scale);
}

}  // namespace

void ToWire(const EncodedDepthFrame& from, isotherm_wire_DepthFrame* to) {
  to->stamp = ToWireStamp(from.header);
  to->depth_scale = from.depth_scale;
  to->image = BorrowImage(from.image);
}

void ToWire(const EncodedThermalFrame& from, isotherm_wire_ThermalFrame* to) {
  to->stamp = ToWireStamp(from.header);
  to->nuc_state = static_cast<std::uint8_t>(from.nuc_state);
  to->nuc_source = static_cast<std::uint8_t>(from.nuc_source);
  to->valid = from.valid;
  to->has_seconds_since_nuc = from.seconds_since_nuc.has_value();
  to->seconds_since_nuc = from.seconds_since_nuc.value_or(0.0);
  to->fpa_celsius = from.housekeeping.fpa_celsius;
  to->housing_celsius = from.housekeeping.housing_celsius;
  to->shutter_celsius = from.housekeeping.shutter_celsius;
  to->image = BorrowImage(from.image);
  to->kelvin_per_count = from.scale.kelvin_per_count;
  to->offset_kelvin = from.scale.offset_kelvin;
  to->has_scale = IsScaled(from.image.encoding);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_DepthFrame& from, EncodedDepthFrame* to) {
  if (const auto cause = CheckFrame(FieldsOf(from.stamp, from.image))) return cause;
  if (const auto cause = CheckDepthScale(from.depth_scale)) return cause;
  to->header = FromWireStamp(from.stamp);
  to->depth_scale = from.depth_scale;
  to->image = CopyImage(from.image);
  return std::nullopt;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_ThermalFrame& from,
                                     EncodedThermalFrame* to) {
  if (const auto cause = CheckFrame(FieldsOf(from.stamp, from.image))) return cause;
  const auto cause = CheckThermal({.nuc_state = from.nuc_state,
                                   .nuc_source = from.nuc_source,
                                   .has_seconds_since_nuc = from.has_seconds_since_nuc,
                                   .seconds_since_nuc = from.seconds_since_nuc,
                                   .fpa_celsius = from.fpa_celsius,
                                   .housing_celsius = from.housing_celsius,
                                   .shutter_celsius = from.shutter_celsius});
  if (cause) return cause;
  to->header = FromWireStamp(from.stamp);
  to->nuc_state = static_cast<NucState>(from.nuc_state);
  to->nuc_source = static_cast<NucSource>(from.nuc_source);
  to->valid = from.valid;
  if (from.has_seconds_since_nuc) to->seconds_since_nuc = from.seconds_since_nuc;
  to->housekeeping = {.fpa_celsius = from.fpa_celsius,
                      .housing_celsius = from.housing_celsius,
                      .shutter_celsius = from.shutter_celsius};
  to->image.encoding =
      static_cast<Encoding>(from.image.encoding);  // Says whether there is a scale.
  if (const auto bad_scale = FromWireScale(from, to)) return bad_scale;
  to->image = CopyImage(from.image);
  return std::nullopt;
}

void ToWire(const ExternalOdometrySample& from, isotherm_wire_ExternalOdometry* to) {
  const ExternalOdometry& pose = from.pose;
  to->session = from.session;
  to->sample_number = from.number;
  CopyText(pose.source, to->source);
  to->capture_time_ns = ToNanoseconds(pose.time);
  to->capture_sigma_ns = pose.time_sigma.count();
  to->t_reference_body = {.tx = pose.translation_m.x(),
                          .ty = pose.translation_m.y(),
                          .tz = pose.translation_m.z(),
                          .qx = pose.rotation.x(),
                          .qy = pose.rotation.y(),
                          .qz = pose.rotation.z(),
                          .qw = pose.rotation.w()};
  to->has_position = pose.has_position();
  to->position_sigma_m =
      pose.has_position() ? pose.position_sigma_m : ExternalOdometry::kUnknownSigma;
  to->rotation_sigma_rad = pose.rotation_sigma_rad;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_ExternalOdometry& from,
                                     ExternalOdometrySample* to) {
  if (from.capture_time_ns < 0 || from.capture_sigma_ns < 0) return RefusalCause::kNegativeTime;
  if (from.sample_number > kMaxFrameNumber) return RefusalCause::kImpossibleNumber;
  to->session = from.session;
  to->number = from.sample_number;
  ExternalOdometry& pose = to->pose;
  pose.source = ReadText(from.source);
  pose.time = CaptureTimeFromNanoseconds(from.capture_time_ns);
  pose.time_sigma = Nanoseconds(from.capture_sigma_ns);
  const isotherm_wire_Pose& T = from.t_reference_body;
  pose.translation_m = {T.tx, T.ty, T.tz};
  pose.rotation = Eigen::Quaterniond(T.qw, T.qx, T.qy, T.qz);
  // Out of range or not, it goes to the odometry stream, which counts what is wrong by cause.
  pose.position_sigma_m =
      from.has_position ? from.position_sigma_m : ExternalOdometry::kNotMeasured;
  pose.rotation_sigma_rad = from.rotation_sigma_rad;
  return std::nullopt;
}

}  // namespace isotherm
