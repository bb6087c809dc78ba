#include "edge/source/frame_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/frame/sensor_name.h"
#include "common/options/option_problems.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// The last count stands for all that is hotter.
constexpr std::uint16_t kLastCount = 65534;

}  // namespace

Status Validate(const FrameCheckOptions& options) {
  OptionProblems problems("frame_check");
  problems.CheckRange("expert.min_celsius", options.expert().min_celsius(), -273.0, 3000.0);
  problems.CheckRange("expert.max_celsius", options.expert().max_celsius(), -273.0, 3000.0);
  if (options.expert().max_celsius() <= options.expert().min_celsius()) {
    problems.Add("expert.max_celsius",
                 fmt::format("is {}, must be above min_celsius, which is {}",
                             options.expert().max_celsius(), options.expert().min_celsius()));
  }
  problems.CheckRange("expert.max_bad_in_a_row", options.expert().max_bad_in_a_row(), 1, 100'000);
  problems.CheckRange("expert.retry_min_s", options.expert().retry_min_s(), 0.01, 60.0);
  problems.CheckRange("expert.min_valid_ratio", options.expert().min_valid_ratio(), 0.0, 1.0);
  problems.CheckRange("expert.blind_after_s", options.expert().blind_after_s(), 0.0, 60.0);
  // The longest wait is not below the first one: the back-off only grows.
  problems.CheckRange("expert.retry_max_s", options.expert().retry_max_s(),
                      options.expert().retry_min_s(), 600.0);
  return problems.ToStatus();
}

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
