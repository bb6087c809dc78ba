#include "edge/frame/frame_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

std::uint16_t CelsiusToCentikelvin(double celsius) {
  const double centikelvin = (celsius + kCelsiusZero_k) * kCentikelvinPerKelvin;
  return static_cast<std::uint16_t>(std::clamp(std::round(centikelvin), 1.0, 65534.0));
}

std::string_view NameOf(Sensor sensor) { return sensor == Sensor::kDepth ? "depth" : "thermal"; }

}  // namespace

FrameCheck::FrameCheck(const FrameCheckOptions& options)
    : min_centikelvin_(CelsiusToCentikelvin(options.expert().min_celsius())),
      max_centikelvin_(CelsiusToCentikelvin(options.expert().max_celsius())) {}

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
  if (expected.width == 0) expected = {width, height};
  if (width != expected.width || height != expected.height) {
    return DataLoss(fmt::format("{} frame {} is {}x{} pixels instead of {}x{}",
                                NameOf(frame.sensor), frame.frame_number, width, height,
                                expected.width, expected.height));
  }
  if (frame.sensor == Sensor::kThermal && !keep_counts_) MaskTemperatures(frame.pixels);
  return OkStatus();
}

void FrameCheck::MaskTemperatures(Image<std::uint16_t>& centikelvin) {
  const std::uint16_t lowest = min_centikelvin_;
  const std::uint16_t highest = max_centikelvin_;
  std::uint32_t masked = 0;
  for (std::uint16_t& value : centikelvin.pixels()) {
    const bool outside = value < lowest || value > highest;
    masked += outside ? 1U : 0U;
    value = outside ? std::uint16_t{0} : value;
  }
  masked_pixels_ += masked;
}

}  // namespace isotherm
