#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/rig/rig.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Doubts are sentences about what can be read but cannot be right. Each says what was found, the
/// likely cause, and what to do. There are none if nothing is in doubt.
using Doubts = std::vector<std::string>;

/// Doubts a calibration whose units seem wrong: cameras more than a metre apart, a delay of more
/// than a second, depth in whole metres.
Doubts DoubtsAbout(const Rig& rig);

/// The capture times of one sensor's frames in short.
struct StreamTimes {
  std::uint64_t frames = 0;
  CaptureTime first{}, last{};
  double period_s = 0.0;  ///< Median time between frames; 0 for fewer than two.
};

/// Measures the capture times of one sensor; sorts `times`.
StreamTimes MeasureTimes(std::vector<CaptureTime>& times);

/// Doubts streams of less than one frame a second (stamps in another unit), and streams that do not
/// overlap (two clocks). Thermal times are meant to have the calibrated delay in them.
Doubts DoubtsAboutTimes(const StreamTimes& depth, const StreamTimes& thermal);

/// Doubts a median that no depth camera of this kind measures.
Doubts DoubtsAboutDepths(double median_raw, double depth_scale);

/// The pixels of thermal images in short: the mean of those that have a value, and the ratios of
/// those that have none (0) or the largest (65535) that there is.
struct ThermalPixels {
  RadiometricScale scale{};
  double mean_raw = 0.0;
  double none_ratio = 0.0;
  double saturated_ratio = 0.0;
};

/// Doubts thermal images that are not in their scale, or hold no temperatures.
Doubts DoubtsAboutTemperatures(const ThermalPixels& pixels);

}  // namespace isotherm
