#pragma once

#include <span>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/stamped_pose.h"
#include "ground/evaluation/error_statistics.h"

namespace isotherm {

/// Says which poses are compared.
struct TrajectoryEvaluationOptions {
  /// A pose and its truth are of the same frame if their stamps differ by no more. Nothing is
  /// interpolated.
  Nanoseconds tolerance = std::chrono::milliseconds(1);
  /// Only the first so many poses of the truth; 0 = all.
  std::size_t first = 0;
  /// Stamps of frames that are left out (repeats of the frame before), in order of time.
  std::vector<CaptureTime> left_out;
};

/// Holds how far the poses of a trajectory are from the truth.
struct TrajectoryErrors {
  std::size_t truth_poses = 0;  ///< In question: the first N without those left out.
  std::size_t left_out = 0;
  std::size_t matched = 0;  ///< How many of the truth poses in question were matched.
  std::size_t without_truth =
      0;  ///< Estimated poses that have no truth (beyond the first N not counted).
  ErrorStatistics aligned_m;  ///< Position, after the rigid alignment that fits all positions best.
  ErrorStatistics from_first_m;  ///< Position, with the first matched poses made equal.
  ErrorStatistics
      aligned_rad;  ///< Orientation, after the same alignment (loose for short or straight paths).
  ErrorStatistics from_first_rad;  ///< Orientation, with the first matched poses made equal.
  double length_m = 0.0;           ///< Length of the matched true path.
  RigidTransform T_truth_world = RigidTransform::Identity();  ///< From the first matched pose.
};

/// Compares `T_world_depth` of an estimated trajectory with the truth. Both in order of time. Fails
/// if no pose has a partner.
Result<TrajectoryErrors> EvaluateTrajectory(std::span<const StampedPose> estimated,
                                            std::span<const StampedPose> truth,
                                            const TrajectoryEvaluationOptions& options);

}  // namespace isotherm
