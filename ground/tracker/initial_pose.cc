#include "ground/tracker/initial_pose.h"

#include <vector>

#include "common/base/quantile.h"

namespace isotherm {

RigidTransform PoseFacingCentre(const VoxelGrid& grid, const Image<float>& depth_m) {
  std::vector<float> depths;
  for (const float z : depth_m.pixels()) {
    if (z > 0.0F) depths.push_back(z);
  }
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = 0.5 * (grid.min_m + grid.max_m());
  if (!depths.empty()) pose.translation().z() -= TakeMedian(depths);
  return pose;
}

}  // namespace isotherm
