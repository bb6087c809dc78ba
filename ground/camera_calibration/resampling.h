#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/projection_map.h"
#include "ground/camera_calibration/target_calibration.h"

namespace isotherm {

/// Lens parameters from resampled views: one row per sample.
struct LensSamples {
  Eigen::MatrixXd values;

  Eigen::VectorXd Mean() const;
  Eigen::MatrixXd Covariance() const;
};

/// Draws as many views as there are, with replacement (Efron 1979), `samples` times: how far the
/// result depends on which views were taken. Unlike the covariance it feels errors that the
/// features of one view have in common.
LensSamples BootstrapLens(const TargetCalibration& calibration, int camera, int samples,
                          std::uint64_t seed);

/// The thesis's way (5.2.3): `chosen` of the views without replacement. Its spread is smaller than
/// the result's uncertainty: by the square root of views / chosen - 1.
LensSamples SubsetLens(const TargetCalibration& calibration, int camera, int chosen, int samples,
                       std::uint64_t seed);

/// Two calibrations from disjoint halves of the views. What they differ by must be what both say
/// that they do not know; a small reprojection error proves nothing.
struct CrossValidation {
  ProjectionMap difference;
  ProjectionMap expected;  ///< Standard deviations of the difference.

  /// About 1 if the uncertainties are right.
  double Ratio() const { return difference.Rms(true) / expected.Rms(true); }
};

/// By camera. Fails if a half is too small to calibrate from.
Result<std::vector<CrossValidation>> CrossValidate(const TargetCalibration& calibration);

/// Returns what is known of one camera alone, in whose frame everything then is. Nothing is
/// estimated again.
TargetCalibration SingleCamera(const TargetCalibration& calibration, int camera);

/// The same calibration from some of its observations only, starting at the solution.
Result<TargetCalibration> Recalibrate(const TargetCalibration& calibration,
                                      const std::vector<FeatureObservation>& observations);

}  // namespace isotherm
