#include "common/doubts/plausibility_check.h"

#include <bit>
#include <limits>

#include "common/base/quantile.h"
#include "common/frame/frame.h"

namespace isotherm {
namespace {

/// Every fifth pixel of every fifth row says enough about an image.
constexpr int kPixelStep = 5;

}  // namespace

bool PlausibilityCheck::AddDepth(CaptureTime time) {
  depth_times_.push_back(time);
  return std::has_single_bit(depth_times_.size());
}

bool PlausibilityCheck::AddThermal(CaptureTime time) {
  thermal_times_.push_back(time);
  return std::has_single_bit(thermal_times_.size());
}

void PlausibilityCheck::LookAtDepth(const Image<std::uint16_t>& depth_raw, double depth_scale) {
  depth_scale_ = depth_scale;
  for (int y = 0; y < depth_raw.height(); y += kPixelStep) {
    for (int x = 0; x < depth_raw.width(); x += kPixelStep) {
      ++depth_pixels_;
      const std::uint16_t raw = depth_raw.At(x, y);
      if (raw != kNoDepth && raw != kNoDepthSaturated) depths_raw_.push_back(raw);
    }
  }
}

void PlausibilityCheck::LookAtThermal(const Image<std::uint16_t>& temperature_raw,
                                      const RadiometricScale& scale) {
  thermal_scale_ = scale;
  for (int y = 0; y < temperature_raw.height(); y += kPixelStep) {
    for (int x = 0; x < temperature_raw.width(); x += kPixelStep) {
      const std::uint16_t value = temperature_raw.At(x, y);
      ++thermal_pixels_;
      thermal_none_ += value == 0 ? 1 : 0;
      thermal_saturated_ += value == std::numeric_limits<std::uint16_t>::max() ? 1 : 0;
      thermal_sum_ += value;
    }
  }
}

double PlausibilityCheck::MedianDepthRaw() const {
  if (depths_raw_.empty()) return 0.0;
  std::vector<std::uint16_t> depths = depths_raw_;
  return TakeMedian(depths);
}

Doubts PlausibilityCheck::Find() const {
  Doubts doubts = DoubtsAbout(rig_);
  const auto add = [&doubts](const Doubts& more) {
    doubts.insert(doubts.end(), more.begin(), more.end());
  };
  std::vector<CaptureTime> depth = depth_times_, thermal = thermal_times_;
  StreamTimes thermal_times = MeasureTimes(thermal);
  const Nanoseconds delay = FromSeconds(rig_.thermal_delay_s);
  thermal_times.first += delay;
  thermal_times.last += delay;
  add(DoubtsAboutTimes(MeasureTimes(depth), thermal_times));
  if (depth_pixels_ > 0) add(DoubtsAboutDepths(MedianDepthRaw(), depth_scale_));
  if (thermal_pixels_ > 0) {
    const auto pixels = static_cast<double>(thermal_pixels_);
    const std::uint64_t with_value = thermal_pixels_ - thermal_none_;
    add(DoubtsAboutTemperatures(
        {.scale = thermal_scale_,
         .mean_raw = with_value == 0 ? 0.0 : thermal_sum_ / static_cast<double>(with_value),
         .none_ratio = static_cast<double>(thermal_none_) / pixels,
         .saturated_ratio = static_cast<double>(thermal_saturated_) / pixels}));
  }
  return doubts;
}

}  // namespace isotherm
