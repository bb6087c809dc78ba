#include "ground/console/camera_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/png/png.h"
#include "common/recording/foxglove.pb.h"

namespace isotherm {
namespace {

constexpr float kGreys = 254.0F;  // 1 to 255; 0 = no value.

/// Every n-th pixel's value by `value(raw)`, NaN = none.
template <typename Value>
Image<float> ThinOut(const Image<std::uint16_t>& raw, int max_width, const Value& value) {
  const int stride = std::max(1, (raw.width() + max_width - 1) / max_width);
  Image<float> thin(raw.width() / stride, raw.height() / stride);
  for (int y = 0; y < thin.height(); ++y) {
    for (int x = 0; x < thin.width(); ++x) thin.At(x, y) = value(raw.At(x * stride, y * stride));
  }
  return thin;
}

void Encode(const Image<float>& values, live::CameraImage& image) {
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      if (std::isnan(values.At(x, y))) continue;
      lowest = std::min(lowest, values.At(x, y));
      highest = std::max(highest, values.At(x, y));
    }
  }
  if (lowest > highest) return;
  image.set_min(lowest);
  image.set_max(highest);
  const float greys_per_unit = highest > lowest ? kGreys / (highest - lowest) : 0.0F;
  std::vector<std::uint8_t> grey;
  grey.reserve(static_cast<std::size_t>(values.width()) *
               static_cast<std::size_t>(values.height()));
  for (int y = 0; y < values.height(); ++y) {
    for (int x = 0; x < values.width(); ++x) {
      const float value = values.At(x, y);
      grey.push_back(std::isnan(value) ? std::uint8_t{0}
                                       : static_cast<std::uint8_t>(
                                             1 + std::lround((value - lowest) * greys_per_unit)));
    }
  }
  const auto png = EncodePng({.width = values.width(),
                              .height = values.height(),
                              .channels = 1,
                              .bits = 8,
                              .bytes = grey,
                              .is_fleeting = true});
  if (png) image.set_png(png->data(), png->size());
}

void SetHeader(const FrameHeader& header, live::CameraImage& image) {
  image.set_frame_number(header.frame_number);
  image.set_capture_time_ns(static_cast<std::uint64_t>(ToNanoseconds(header.capture_time)));
}

/// `convert(raw)` gives the value that is sent.
template <typename Convert>
std::string RawImageOf(const FrameHeader& header, const Image<std::uint16_t>& raw,
                       const char* frame_id, const Convert& convert) {
  foxglove::RawImage image;
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  const std::int64_t ns = ToNanoseconds(header.capture_time);
  image.mutable_timestamp()->set_seconds(ns / kPerSecond);
  image.mutable_timestamp()->set_nanos(static_cast<std::int32_t>(ns % kPerSecond));
  image.set_frame_id(frame_id);
  image.set_width(static_cast<std::uint32_t>(raw.width()));
  image.set_height(static_cast<std::uint32_t>(raw.height()));
  image.set_encoding("16UC1");
  image.set_step(static_cast<std::uint32_t>(raw.width()) * 2);
  std::string& data = *image.mutable_data();
  data.reserve(static_cast<std::size_t>(raw.width()) * static_cast<std::size_t>(raw.height()) * 2);
  for (int y = 0; y < raw.height(); ++y) {
    for (int x = 0; x < raw.width(); ++x) {
      const std::uint16_t value = convert(raw.At(x, y));
      data.push_back(static_cast<char>(value & 0xFF));
      data.push_back(static_cast<char>(value >> 8));
    }
  }
  return image.SerializeAsString();
}

}  // namespace

live::CameraImage ToCameraImage(const DepthFrame& frame, int max_width) {
  live::CameraImage image;
  image.set_sensor(live::CameraImage::DEPTH);
  image.set_valid(true);
  SetHeader(frame.header, image);
  const auto scale = static_cast<float>(1.0 / frame.depth_scale);
  Encode(ThinOut(frame.depth_raw, max_width,
                 [scale](std::uint16_t raw) {
                   return raw == kNoDepth || raw == kNoDepthSaturated
                              ? std::numeric_limits<float>::quiet_NaN()
                              : scale * static_cast<float>(raw);
                 }),
         image);
  return image;
}

live::CameraImage ToCameraImage(const ThermalFrame& frame, int max_width) {
  live::CameraImage image;
  image.set_sensor(live::CameraImage::THERMAL);
  image.set_valid(frame.valid);
  SetHeader(frame.header, image);
  Encode(ThinOut(frame.temperature_raw, max_width,
                 [&frame](std::uint16_t raw) {
                   return raw == 0 ? std::numeric_limits<float>::quiet_NaN()
                                   : frame.scale.Celsius(raw);
                 }),
         image);
  return image;
}

std::string ToRawImage(const DepthFrame& frame) {
  constexpr double kMillimetres = 1000.0;
  const double scale = kMillimetres / frame.depth_scale;
  return RawImageOf(frame.header, frame.depth_raw, "depth", [scale](std::uint16_t raw) {
    return raw == kNoDepthSaturated
               ? kNoDepth
               : static_cast<std::uint16_t>(std::min(65535.0, std::round(scale * raw)));
  });
}

std::string ToRawImage(const ThermalFrame& frame) {
  return RawImageOf(frame.header, frame.temperature_raw, "thermal", [&](std::uint16_t raw) {
    return raw == 0 ? std::uint16_t{0} : kCentikelvin.NearestCountOf(frame.scale.Celsius(raw));
  });
}

}  // namespace isotherm
