#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/frame/image.h"
#include "ground/camera_calibration/polygon_coverage.h"

namespace isotherm {

/// Holds what is known of one hole's image before it is fitted.
struct BlobModel {
  Polygon outline;  ///< As predicted, pixels: what is behind the hole is seen through it.
  Polygon window;   ///< Only pixels in it count: the hole and a part of the board around it.
  /// The rim of a hole in a thick board; between it and `outline` its wall is seen. Empty: none.
  Polygon rim;
  double wall_fill = 0.0;  ///< The wall looks like the board (0), like what is behind (1), between.
  bool fit_wall = false;
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();  ///< Where to begin.
  double blur_px = 0.6;
  double scale = 1.0;
  /// Absent: it is fitted, too. A hole that the image's border cuts cannot tell its size from its
  /// place.
  std::optional<double> known_scale;
};

/// How a predicted outline must be moved, blurred and scaled to look like the image.
struct BlobFit {
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< The shift's, from the noise.
  double blur_px = 0.0;
  double scale = 1.0;
  double wall_fill = 0.0;
  double wall_sigma = 0.0;  ///< Standard deviation of it, if it was fitted.
  double contrast = 0.0;    ///< Inside minus outside, in the image's units.
  double noise = 0.0;       ///< Standard deviation of what is left, in the image's units.
};

/// Fits the outline, filled and blurred, before a background that may rise to a side, as may the
/// filling: least squares over the window's pixels, robust against what does not belong there. Sees
/// the shape that the lens and the tilt make of the hole, so that no centre is taken for another.
/// NaN pixels do not count. nullopt if there is too little to see or it does not converge.
std::optional<BlobFit> FitBlob(const Image<float>& image, const BlobModel& model);

}  // namespace isotherm
