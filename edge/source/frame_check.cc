#include "edge/source/frame_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/frame/sensor_name.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// The last count stands for all that is hotter.
constexpr std::uint16_t kLastCount = 65534;

}  // namespace

FrameCheck::FrameCheck(const FrameCheckOptions& options)
    : min_celsius_(options.expert().min_celsius()), max_celsius_(options.expert().max_celsius()) {}

void FrameCheck::Expect(const Rig& rig) {
  const auto size = [](const std::optional<CameraModel>& camera) {
    return camera ? Size{camera->width, camera->height} : Size{};
  };
  expected_ = {size(rig.depth), size(rig.thermal)};
}

Status FrameCheck::Process(RawFrame& frame) {
  const int width = frame.pixels.width();
  const int height = frame.pixels.height();
  if (frame.pixels.empty()) {
    return DataLoss(
        fmt::format("{} frame {} has no pixels", NameOf(frame.sensor), frame.frame_number));
  }
  Size& expected = expected_[static_cast<std::size_t>(frame.sensor)];
  // Without a calibration, the first frame decides.
  if (expected.width == 0) expected = {width, height};
  if (width != expected.width || height != expected.height) {
    return DataLoss(fmt::format("{} frame {} is {}x{} pixels instead of {}x{}",
                                NameOf(frame.sensor), frame.frame_number, width, height,
                                expected.width, expected.height));
  }
  if (frame.sensor == Sensor::kThermal && !keep_counts_)
    MaskTemperatures(frame.thermal_scale, frame.pixels);
  return OkStatus();
}

void FrameCheck::MaskTemperatures(const RadiometricScale& scale,
                                  Image<std::uint16_t>& temperature_raw) {
  const std::uint16_t lowest = scale.NearestCountOf(min_celsius_);
  const std::uint16_t highest = std::min(scale.NearestCountOf(max_celsius_), kLastCount);
  std::uint32_t masked = 0;
  for (std::uint16_t& value : temperature_raw.pixels()) {
    const bool outside = value < lowest || value > highest;
    masked += outside ? 1U : 0U;
    // Without a branch: this runs over every pixel.
    value = outside ? std::uint16_t{0} : value;
  }
  masked_pixels_ += masked;
}

}  // namespace isotherm
