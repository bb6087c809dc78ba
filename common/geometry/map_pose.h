#pragma once

#include "common/geometry/pose_covariance.h"
#include "common/geometry/rigid_transform.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Says where the depth camera is in the coordinates of a sub-map (`map`), and how certain that is.
struct MapPose {
  int map = 0;  ///< The sub-map's index in the atlas.
  RigidTransform T_map_depth = RigidTransform::Identity();
  /// The covariance is along the sub-map's axes. It is 0 for a pose that was chosen, not measured.
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// The same in `world`.
struct WorldPose {
  RigidTransform T_world_depth = RigidTransform::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// Takes a pose to `world` together with its covariance: neither means anything in the axes of the
/// other. `T_world_map` is where the pose's sub-map is.
WorldPose ToWorld(const MapPose& pose, const RigidTransform& T_world_map);

/// Names a pose in `world` as one in the first sub-map: the coordinates of the two are the same.
/// After GroundPipeline::Finish the whole model is in the first sub-map, and its surface, too, is
/// in `world`.
inline const RigidTransform& InFirstMap(const RigidTransform& T_world_camera) {
  return T_world_camera;
}

/// A pose of the depth camera on the time line, in the coordinates of the sub-map that it was
/// tracked against.
struct StampedMapPose {
  CaptureTime time;
  RigidTransform T_map_depth;
};

}  // namespace isotherm
