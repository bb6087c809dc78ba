#pragma once

#include "common/frame/image.h"
#include "common/geometry/rigid_transform.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

/// T_world_depth that puts the volume's centre on the optical axis at the image's median depth,
/// axes parallel to the camera's. `depth_m`: 0 = no return.
RigidTransform PoseFacingCentre(const VoxelGrid& grid, const Image<float>& depth_m);

}  // namespace isotherm
