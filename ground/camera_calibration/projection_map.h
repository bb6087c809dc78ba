#pragma once

#include <Eigen/Core>
#include <vector>

#include "ground/camera_calibration/bundle.h"

namespace isotherm {

/// One number at each point of a grid over a camera's image, pixels. Between cameras with the same
/// image size, points correspond.
struct ProjectionMap {
  static constexpr int kColumns = 25, kRows = 19;
  Eigen::Vector2i size_px = Eigen::Vector2i::Zero();
  std::vector<Eigen::Vector2d> values_px;  ///< Row by row; NaN: the lens shows nothing there.

  Eigen::Vector2d PixelOf(int index) const;
  /// Root mean square, and largest length, over the inner 80 % of the image or all of it.
  double Rms(bool inner) const;
  double Max(bool inner) const;
  double LengthAt(int index) const { return values_px[static_cast<std::size_t>(index)].norm(); }
};

/// How uncertain it is where a lens shows a direction, after the best rotation of the camera, which
/// no calibration of one camera can tell: standard deviations in u and v. `covariance` is that of
/// the lens's parameters.
ProjectionMap ProjectionSigmas(const BundleCamera& camera, const Eigen::MatrixXd& covariance,
                               const Eigen::Vector2i& size_px);

/// By how much `other` shows the directions elsewhere that `reference` shows at the grid's points,
/// after the best rotation: the one with the least squares over the inner 80 % of the image.
ProjectionMap CompareProjections(const BundleCamera& reference, const BundleCamera& other,
                                 const Eigen::Vector2i& size_px);

/// The fraction of all points where `differences` are within `sigmas` standard deviations.
double FractionWithin(const ProjectionMap& differences, const ProjectionMap& standard_deviations,
                      double sigmas);

}  // namespace isotherm
