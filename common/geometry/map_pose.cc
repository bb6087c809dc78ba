#include "common/geometry/map_pose.h"

namespace isotherm {

WorldPose ToWorld(const MapPose& pose, const RigidTransform& T_world_map) {
  return {T_world_map * pose.T_map_depth, Rotated(pose.covariance, T_world_map.linear())};
}

}  // namespace isotherm
