#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "common/base/status.h"
#include "common/rig/sensor_models.h"
#include "ground/radiometric_calibration/aperture_image.h"

namespace isotherm {

/// Holds an aperture image and how it belongs to others.
struct ApertureView {
  ApertureImage image;
  int setting = 0;  ///< Views of one setting show the black body at one temperature.
};

/// Tells what aperture images say of a camera's scene influence.
struct InfluenceReport {
  SceneInfluence influence;
  /// Covariance of near_fraction, near_sigma_px and total_fraction, by leaving out one view after
  /// the other.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Root mean square of how far the black body reads from the others' mean of its setting, as
  /// measured and corrected, each view by what the others tell. Kelvin.
  double apart_before_k = 0.0, apart_after_k = 0.0;
  int views = 0;  ///< Only with others of their setting.

  /// Views that were left out read less than half as far apart once they are corrected.
  bool IsKnown() const;
  /// Standard uncertainty of a value, numbered as in `covariance`.
  double Sigma(int value) const { return std::sqrt(covariance(value, value)); }
};

/// Finds the scene influence with which the black body of one setting reads the same through each
/// hole and all over the hole, and the plate the same all over the image (thesis 5.1, figures 5.6
/// to 5.9). What black body and plate read then is free: an error of all readings does not matter.
/// Refuses views that cannot tell: fewer than three holes at any one temperature, or too much
/// alike.
Result<InfluenceReport> FitInfluence(const std::vector<ApertureView>& views);

/// Root mean square of how far the black body reads from the others' mean of its setting once
/// `influence` is taken out, kelvin.
double ApartWithout(const SceneInfluence& influence, const std::vector<ApertureView>& views);

}  // namespace isotherm
