#pragma once

#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/target_calibration.h"

namespace isotherm {

/// Mean reprojection errors by the thesis's two definitions (5.1), pixels.
struct ReprojectionError {
  double rms_px = 0.0;
  double mae_px = 0.0;
};

/// Returns the errors of one camera's features.
ReprojectionError ReprojectionErrorOf(const TargetCalibration& calibration, int camera);

/// By how much each parameter of a camera's lens would have to change for the reprojection error
/// (5.1a) to grow by `increase_px`, the views' poses adapted (thesis table 5.2). In the parameters'
/// own units. From the second derivatives at the solution, so only in the order of magnitude where
/// changes are large.
Result<std::vector<double>> ParameterSensitivity(const TargetCalibration& calibration, int camera,
                                                 double increase_px);

/// Says which features of each image of a camera count (thesis table 5.3).
enum class FeatureSubset { kAll, kNearBorders, kNearMiddle };

/// The calibration of one camera (then its camera 0) from the half of each image's features that
/// are farthest from the image's middle, or nearest to it.
Result<TargetCalibration> CalibrateFromSubset(const TargetCalibration& calibration, int camera,
                                              FeatureSubset subset);

}  // namespace isotherm
