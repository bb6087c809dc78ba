#pragma once

#include <vector>

#include "common/geometry/map_pose.h"
#include "common/geometry/pose_covariance.h"
#include "common/geometry/stamped_pose.h"
#include "ground/atlas/atlas.h"

namespace isotherm {

/// Where the rig was at each tracked frame, in `world` as far as the sub-maps are joined. Closing a
/// loop moves what came before. Thread-compatible.
class Trajectory {
 public:
  /// `sigma` may be in any axes, since it is along the least certain direction.
  void Add(const StampedMapPose& pose, const PoseSigma& sigma, int map, const Atlas& atlas);
  /// Sub-maps were joined or moved: all poses are computed anew.
  void Update(const Atlas& atlas);

  const std::vector<StampedPose>& poses() const { return poses_; }
  /// One standard deviation of each pose, relative to the model.
  const std::vector<PoseSigma>& sigmas() const { return sigmas_; }

 private:
  struct TrackedPose {
    StampedMapPose pose;  ///< In the coordinates of sub-map `map`.
    PoseSigma sigma;
    int map = 0;
  };
  /// If the sub-map is joined.
  void Append(const TrackedPose& tracked, const Atlas& atlas);

  std::vector<TrackedPose> tracked_;
  std::vector<StampedPose> poses_;  ///< The poses of tracked_ that are joined, in `world`.
  std::vector<PoseSigma> sigmas_;
};

}  // namespace isotherm
