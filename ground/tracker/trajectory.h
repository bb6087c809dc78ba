#pragma once

#include <vector>

#include "common/geometry/map_pose.h"
#include "common/geometry/pose_covariance.h"
#include "common/geometry/stamped_pose.h"
#include "ground/atlas/atlas.h"

namespace isotherm {

/// Keeps where the rig was at each tracked frame, in `world` as far as the sub-maps are joined.
/// Closing a loop moves what came before. Thread-compatible.
class Trajectory {
 public:
  /// Adds a tracked frame's pose in sub-map `map`. `sigma` holds in any axes, since it is along the
  /// least certain direction.
  void Add(const StampedMapPose& pose, const PoseSigma& sigma, int map, const Atlas& atlas);
  /// Computes all poses anew after sub-maps were joined or moved.
  void Update(const Atlas& atlas);

  const std::vector<StampedPose>& poses() const { return poses_; }
  /// Returns one standard deviation of each pose, relative to the model.
  const std::vector<PoseSigma>& sigmas() const { return sigmas_; }

 private:
  /// Holds a pose as it was tracked; where its sub-map lies may still change.
  struct TrackedPose {
    StampedMapPose pose;  ///< In the coordinates of sub-map `map`.
    PoseSigma sigma;
    int map = 0;
  };
  /// Appends the pose in `world` if its sub-map is joined.
  void Append(const TrackedPose& tracked, const Atlas& atlas);

  std::vector<TrackedPose> tracked_;
  std::vector<StampedPose> poses_;  ///< The poses of tracked_ that are joined, in `world`.
  std::vector<PoseSigma> sigmas_;
};

}  // namespace isotherm
