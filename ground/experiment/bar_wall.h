#pragma once

#include "common/simulation/scene_builder.h"

namespace isotherm {

/// A wall of hot and cold bars side by side, flush, and below it parts that the tracker holds on
/// to. Black bodies in surroundings of 23 °C, so that a temperature is wrong only by motion and
/// blur.
struct BarWall {
  /// 30 K apart, far above the camera's noise.
  static constexpr double kCold_celsius = 30.0, kHot_celsius = 60.0;
  static constexpr double kFirst_m = 0.02;  ///< Where the first bar begins; it is cold.
  static constexpr double kBar_m = 0.016;   ///< Width of a bar.
  static constexpr double kWall_m = 0.80;   ///< Its plane, along z.

  static SceneBuilder Make();
};

}  // namespace isotherm
