#pragma once

#include <cstdint>
#include <vector>

#include "common/doubts/doubts.h"
#include "common/frame/image.h"
#include "common/rig/rig.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Finds the doubts about one scan from its calibration and its frames, in bounded time and memory
/// per frame: it takes all stamps, and the pixels of few frames. Thread-compatible.
class PlausibilityCheck {
 public:
  explicit PlausibilityCheck(const Rig& rig) : rig_(rig) {}

  /// Takes each frame's stamp, as recorded. Returns whether the frame's pixels are to be shown, too
  /// (frames 1, 2, 4, 8, ... of each sensor).
  bool AddDepth(CaptureTime time);
  bool AddThermal(CaptureTime time);
  void LookAtDepth(const Image<std::uint16_t>& depth_raw, double depth_scale);
  void LookAtThermal(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale);

  /// Returns the median of the raw depths seen; 0 if there were none.
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
  RadiometricScale thermal_scale_;
};

}  // namespace isotherm
