#include "common/recording/frame_protos.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/recording/proto_parts.h"

namespace isotherm::recording {
namespace {

template <typename Message>
void SetFrame(const FrameHeader& header, const EncodedImage& image,
              const std::optional<CaptureTime>& arrival, Message& message) {
  SetTime(header.capture_time, *message.mutable_timestamp());
  FrameInfo& frame = *message.mutable_frame();
  frame.set_session(header.session);
  frame.set_frame_number(header.frame_number);
  frame.set_device_ticks(header.device_ticks.time_since_epoch().count());
  frame.set_capture_sigma_ns(header.capture_sigma.count());
  if (arrival) SetTime(*arrival, *frame.mutable_arrival());
  frame.set_encoding(static_cast<std::uint32_t>(image.encoding));
  frame.set_width(static_cast<std::uint32_t>(image.width));
  frame.set_height(static_cast<std::uint32_t>(image.height));
}

template <typename Message>
Result<FrameHeader> GetHeader(const Message& message, CaptureTime log_time,
                              std::uint32_t sequence) {
  FrameHeader header;
  // Recordings of other programs may have no more than MCAP's own fields.
  header.capture_time = log_time;
  header.frame_number = sequence;
  if (message.has_timestamp()) {
    const std::optional<CaptureTime> time = ToTime(message.timestamp());
    if (!time) return Err(DataLoss("its timestamp is out of range"));
    header.capture_time = *time;
  }
  if (!message.has_frame()) return header;
  const FrameInfo& frame = message.frame();
  header.session = frame.session();
  header.frame_number = frame.frame_number();
  // Ticks are microseconds; beyond this, arithmetic in nanoseconds would overflow.
  constexpr std::int64_t kMaxTicks = kMaxRecordedNanoseconds / 1000;
  if (frame.device_ticks() > kMaxTicks || frame.device_ticks() < -kMaxTicks)
    return Err(DataLoss("its camera's clock is out of range"));
  header.device_ticks = DeviceTicks(std::chrono::microseconds(frame.device_ticks()));
  header.capture_sigma =
      Nanoseconds(std::clamp<std::int64_t>(frame.capture_sigma_ns(), 0, kMaxRecordedNanoseconds));
  return header;
}

template <typename Message>
std::optional<CaptureTime> GetArrival(const Message& message) {
  return message.frame().has_arrival() ? ToTime(message.frame().arrival()) : std::nullopt;
}

std::vector<std::uint8_t> TakeBytes(std::string* data) { return {data->begin(), data->end()}; }

/// Sides that no camera has, so that width times height stays far from overflowing.
constexpr std::uint32_t kMaxImageSide = 1U << 16;

Result<EncodedImage> TakeImage(foxglove::CompressedImage& message) {
  const FrameInfo& frame = message.frame();
  if (frame.width() == 0 || frame.height() == 0 || frame.width() > kMaxImageSide ||
      frame.height() > kMaxImageSide ||
      frame.encoding() > std::numeric_limits<std::uint8_t>::max()) {
    return Err(DataLoss(fmt::format("image of {} x {} in encoding {} is not one of Isotherm's",
                                    frame.width(), frame.height(), frame.encoding())));
  }
  return EncodedImage{.encoding = static_cast<Encoding>(frame.encoding()),
                      .width = static_cast<int>(frame.width()),
                      .height = static_cast<int>(frame.height()),
                      .payload = TakeBytes(message.mutable_data())};
}

Result<EncodedImage> TakeImage(foxglove::RawImage& message) {
  const std::uint64_t row_bytes = std::uint64_t{message.width()} * sizeof(std::uint16_t);
  const std::uint64_t expected = std::uint64_t{message.step()} * message.height();
  if (message.encoding() != "16UC1" && message.encoding() != "mono16") {
    return Err(
        DataLoss(fmt::format("image encoding \"{}\" is not 16-bit grey", message.encoding())));
  }
  if (message.width() == 0 || message.height() == 0 || message.width() > kMaxImageSide ||
      message.height() > kMaxImageSide || message.step() < row_bytes ||
      message.data().size() != expected) {
    return Err(DataLoss(fmt::format("image of {} x {}, step {}, has {} bytes", message.width(),
                                    message.height(), message.step(), message.data().size())));
  }
  // Without a FrameInfo, as other programs write it, this reads as kRaw16.
  const std::uint32_t encoding = message.frame().encoding();
  if (encoding > static_cast<std::uint32_t>(kLastEncoding) ||
      !IsRaw(static_cast<Encoding>(encoding))) {
    return Err(
        DataLoss(fmt::format("raw image in encoding {} is not one of Isotherm's", encoding)));
  }
  EncodedImage image{.encoding = static_cast<Encoding>(encoding),
                     .width = static_cast<int>(message.width()),
                     .height = static_cast<int>(message.height()),
                     .payload = TakeBytes(message.mutable_data())};
  if (message.step() == row_bytes) return image;
  for (std::uint64_t y = 0; y < message.height(); ++y) {  // Rows are padded: close the gaps.
    const auto row = image.payload.begin() + static_cast<std::ptrdiff_t>(y * message.step());
    std::copy(row, row + static_cast<std::ptrdiff_t>(row_bytes),
              image.payload.begin() + static_cast<std::ptrdiff_t>(y * row_bytes));
  }
  image.payload.resize(static_cast<std::size_t>(row_bytes * message.height()));
  return image;
}

}  // namespace

template <typename Image>
Image ToMessage(const EncodedDepthFrame& frame, const std::optional<CaptureTime>& arrival) {
  Image message;
  message.set_frame_id(std::string(kDepthFrame));
  SetFrame(frame.header, frame.image, arrival, message);
  message.mutable_depth()->set_depth_scale(frame.depth_scale);
  return message;
}

template <typename Image>
Image ToMessage(const EncodedThermalFrame& frame, const std::optional<CaptureTime>& arrival) {
  Image message;
  message.set_frame_id(std::string(kThermalFrame));
  SetFrame(frame.header, frame.image, arrival, message);
  ThermalInfo& thermal = *message.mutable_thermal();
  thermal.set_nuc_state(static_cast<std::uint32_t>(frame.nuc_state));
  thermal.set_nuc_source(static_cast<std::uint32_t>(frame.nuc_source));
  if (frame.seconds_since_nuc) thermal.set_seconds_since_nuc(*frame.seconds_since_nuc);
  const ThermalHousekeeping& housekeeping = frame.housekeeping;
  // Absent is how a message says "not known": readers elsewhere may not expect NaN.
  if (!std::isnan(housekeeping.fpa_celsius)) thermal.set_fpa_celsius(housekeeping.fpa_celsius);
  if (!std::isnan(housekeeping.housing_celsius)) {
    thermal.set_housing_celsius(housekeeping.housing_celsius);
  }
  if (!std::isnan(housekeeping.shutter_celsius)) {
    thermal.set_shutter_celsius(housekeeping.shutter_celsius);
  }
  thermal.set_valid(frame.valid);
  if (IsScaled(frame.image.encoding)) {
    thermal.set_kelvin_per_count(frame.scale.kelvin_per_count);
    thermal.set_offset_kelvin(frame.scale.offset_kelvin);
  }
  return message;
}

void SetImageData(EncodedImage&& image, foxglove::CompressedImage& message) {
  message.set_format(image.encoding == Encoding::kPng16
                         ? "png"
                         : fmt::format("isotherm-{}", static_cast<int>(image.encoding)));
  message.set_data(image.payload.data(), image.payload.size());
}

void SetImageData(EncodedImage&& image, foxglove::RawImage& message) {
  CHECK(IsRaw(image.encoding));
  message.mutable_frame()->set_encoding(static_cast<std::uint32_t>(image.encoding));
  message.set_width(static_cast<std::uint32_t>(image.width));
  message.set_height(static_cast<std::uint32_t>(image.height));
  message.set_step(static_cast<std::uint32_t>(image.width) * sizeof(std::uint16_t));
  message.set_encoding("16UC1");
  message.set_data(image.payload.data(), image.payload.size());
}

template <typename Image>
Result<RecordedDepth> ToDepth(Image& message, CaptureTime log_time, std::uint32_t sequence) {
  RecordedDepth depth;
  Result<FrameHeader> header = GetHeader(message, log_time, sequence);
  if (!header) return Err(std::move(header.error()));
  depth.frame.header = *header;
  depth.arrival = GetArrival(message);
  // Otherwise millimetres, as nearly all programs write them.
  if (message.has_depth()) depth.frame.depth_scale = message.depth().depth_scale();
  Result<EncodedImage> image = TakeImage(message);
  if (!image) return Err(std::move(image.error()));
  depth.frame.image = std::move(*image);
  return depth;
}

template <typename Image>
Result<RecordedThermal> ToThermal(Image& message, CaptureTime log_time, std::uint32_t sequence) {
  RecordedThermal thermal;
  Result<FrameHeader> header = GetHeader(message, log_time, sequence);
  if (!header) return Err(std::move(header.error()));
  EncodedThermalFrame& frame = thermal.frame;
  frame.header = *header;
  thermal.arrival = GetArrival(message);
  const ThermalInfo& info = message.thermal();
  frame.nuc_state = KnownOr(info.nuc_state(), NucState::kError, NucState::kUnknown);
  frame.nuc_source = KnownOr(info.nuc_source(), NucSource::kInferred, NucSource::kUnknown);
  // What cannot be is not known: the frame's pixels are right all the same.
  if (std::isfinite(info.seconds_since_nuc()) && info.seconds_since_nuc() >= 0.0 &&
      info.has_seconds_since_nuc()) {
    frame.seconds_since_nuc = info.seconds_since_nuc();
  }
  if (info.has_fpa_celsius()) frame.housekeeping.fpa_celsius = info.fpa_celsius();
  if (info.has_housing_celsius()) frame.housekeeping.housing_celsius = info.housing_celsius();
  if (info.has_shutter_celsius()) frame.housekeeping.shutter_celsius = info.shutter_celsius();
  // Absent reads as false: temperatures of other programs are not trusted unless they say so.
  frame.valid = info.valid();
  Result<EncodedImage> image = TakeImage(message);
  if (!image) return Err(std::move(image.error()));
  frame.image = std::move(*image);
  if (!IsScaled(frame.image.encoding)) return thermal;
  frame.scale = {info.kelvin_per_count(), info.offset_kelvin()};
  if (Status status = Validate(frame.scale); !status.ok())
    return Err(DataLoss("its temperatures have an impossible scale: " + status.message()));
  return thermal;
}

template foxglove::RawImage ToMessage(const EncodedDepthFrame&, const std::optional<CaptureTime>&);
template foxglove::RawImage ToMessage(const EncodedThermalFrame&,
                                      const std::optional<CaptureTime>&);
template foxglove::CompressedImage ToMessage(const EncodedDepthFrame&,
                                             const std::optional<CaptureTime>&);
template foxglove::CompressedImage ToMessage(const EncodedThermalFrame&,
                                             const std::optional<CaptureTime>&);
template Result<RecordedDepth> ToDepth(foxglove::RawImage&, CaptureTime, std::uint32_t);
template Result<RecordedDepth> ToDepth(foxglove::CompressedImage&, CaptureTime, std::uint32_t);
template Result<RecordedThermal> ToThermal(foxglove::RawImage&, CaptureTime, std::uint32_t);
template Result<RecordedThermal> ToThermal(foxglove::CompressedImage&, CaptureTime, std::uint32_t);

}  // namespace isotherm::recording
