#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// A target as it was found in one image, before anything is known of the camera.
struct DetectedTarget {
  std::vector<Eigen::Vector2d> features;  ///< Centres of their images, by feature.
  bool holes_bright = false;
};

/// Finds all features of the target and numbers them as seen from its front, or says in one
/// sentence why it cannot: not found, cut by the border, another grid, mirrored, saturated, not a
/// number. The image's unit does not matter; NaN has no value.
Result<DetectedTarget> DetectTarget(const Image<float>& image, const CalibrationTarget& target);

/// How much the features scatter between frames of one pose: the largest root mean square of any
/// feature around its mean, pixels (thesis 5.2.3). Frames without the target do not count; nullopt
/// with fewer than three others.
std::optional<double> FeatureScatter(const std::vector<Image<float>>& frames,
                                     const CalibrationTarget& target);

}  // namespace isotherm
