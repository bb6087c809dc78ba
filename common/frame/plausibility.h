#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Doubts say of what can be read but cannot be right, in a sentence each, what was found, the
/// likely cause, and what to do. They are empty if nothing is in doubt.
using Doubts = std::vector<std::string>;

/// Units of a calibration: cameras more than a metre apart, a delay of more than a second, depth in
/// whole metres.
Doubts DoubtsAbout(const Rig& rig);

/// When the frames of one sensor were taken.
struct StreamTimes {
  std::uint64_t frames = 0;
  CaptureTime first{}, last{};
  double period_s = 0.0;  ///< Median time between frames; 0 for fewer than two.
};

/// Sorts `times`.
StreamTimes MeasureTimes(std::vector<CaptureTime>& times);

/// Less than one frame a second (stamps in another unit), and streams that do not overlap (two
/// clocks). Thermal times are meant to have the calibrated delay in them.
Doubts DoubtsAboutTimes(const StreamTimes& depth, const StreamTimes& thermal);

/// Typical depths that no depth camera of this kind measures.
Doubts DoubtsAboutDepths(double median_raw, double depth_scale);

/// Mean of the pixels of thermal images that have a value, and how many have none (0) or the
/// largest (65535) that there is.
struct ThermalPixels {
  double mean_centikelvin = 0.0;
  double none_ratio = 0.0;
  double saturated_ratio = 0.0;
};
Doubts DoubtsAboutTemperatures(const ThermalPixels& pixels);

/// Collects what the functions above assess from the frames of one scan, in bounded time and memory
/// per frame: all stamps, and pixels of few frames. Thread-compatible.
class PlausibilityCheck {
 public:
  explicit PlausibilityCheck(const Rig& rig) : rig_(rig) {}

  /// Each frame's stamp, as recorded. True: the frame's pixels are to be shown, too (frames 1, 2,
  /// 4, 8, ... of each sensor).
  bool AddDepth(CaptureTime time);
  bool AddThermal(CaptureTime time);
  void LookAtDepth(const Image<std::uint16_t>& depth_raw, double depth_scale);
  void LookAtThermal(const Image<std::uint16_t>& centikelvin);

  /// Median of the raw depths seen; 0 = none.
  double MedianDepthRaw() const;
  Doubts Find() const;

 private:
  const Rig rig_;
  std::vector<CaptureTime> depth_times_, thermal_times_;
  std::vector<std::uint16_t> depths_raw_;
  double depth_scale_ = 0.0;
  std::uint64_t depth_pixels_ = 0;
  std::uint64_t thermal_pixels_ = 0, thermal_none_ = 0, thermal_saturated_ = 0;
  double thermal_sum_ = 0.0;
};

}  // namespace isotherm
