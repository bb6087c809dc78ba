#pragma once

#include "ground/camera_calibration/calibration_report.h"

namespace isotherm {

/// Returns what a joint calibration says of the pose between its two cameras.
PoseReport ReportPose(const TargetCalibration& calibration);

/// Moves one of a pose's six parameters: rotation vector, translation.
void MovePose(int parameter, double step, RigidTransform& pose);

/// Where the second camera shows the points that the first camera sees at the grid's pixels, at a
/// depth. NaN outside its image.
ProjectionMap TransferPoints(const BundleState& state, const Eigen::Vector2i& first_size_px,
                             const Eigen::Vector2i& second_size_px, double depth_m);

}  // namespace isotherm
