#include "ground/initial_pose.h"

#include <algorithm>
#include <vector>

namespace isotherm {

RigidTransform PoseFacingCentre(const VoxelGrid& grid, const Image<float>& depth_m) {
  std::vector<float> depths;
  for (const float z : depth_m.pixels()) {
    if (z > 0.0F) depths.push_back(z);
  }
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = 0.5 * (grid.min_m + grid.max_m());
  if (!depths.empty()) {
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    pose.translation().z() -= *middle;
  }
  return pose;
}

}  // namespace isotherm
