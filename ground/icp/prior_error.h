#pragma once

#include <algorithm>

namespace isotherm {

/// Tells how far off the motion may be that holds unobservable directions, one sigma.
struct PriorError {
  /// Error of the motion since the frame before, in the same sense each time: adds up frame by
  /// frame.
  double translation_growth_m = 0.0;
  double rotation_growth_rad = 0.0;
  /// Error of this pose alone: does not add up while each frame is held by the same source.
  double translation_noise_m = 0.0;
  double rotation_noise_rad = 0.0;
  /// The frame before was held by the same source, so that its noise is gone with this one.
  bool continues = false;
};

/// The error after a velocity that may be off by `sigma_m_s` at the depth of the scene, after
/// `seconds`.
inline PriorError ConstantVelocityError(double sigma_m_s, double seconds, double mean_depth_m) {
  const double growth_m = sigma_m_s * std::max(0.0, seconds);
  return {.translation_growth_m = growth_m, .rotation_growth_rad = growth_m / mean_depth_m};
}

}  // namespace isotherm
