#pragma once

#include <cstdint>
#include <span>

#include "ground/tracker/surface_maps.h"

namespace isotherm {

/// Everything a row of rays needs, in voxel coordinates (voxel centres at integers). Plain numbers:
/// no options, no Eigen, so that the kernel can be compiled for several instruction sets.
struct RaycastKernelArgs {
  const std::int32_t* table;   ///< Block indices, x fastest, -1 = none.
  const std::int32_t* voxels;  ///< TsdfVoxel words of block 0.
  std::int32_t blocks_x, blocks_y, blocks_z;
  std::int32_t min_weight_code;  ///< In TsdfVoxel weight units, at least 1.
  float truncation_vox;

  float origin[3];  ///< Camera position.
  float R[9];       ///< World from camera, row-major.
  float fx, fy, cx, cy;
  float voxel_m;
  float world_origin[3];  ///< Camera position in metres.

  const float* near_vox;  ///< Per tile: depth along z where marching starts, in voxels.
  const float* far_vox;   ///< Per tile: where it ends; not above near = no block there.
  std::int32_t tiles_per_row;
};

/// Pixels per side of a tile of the range map.
inline constexpr int kRaycastTile = 8;

/// Casts the rays of image row `y` and writes all six planes of `maps` (world, metres; NaN = no
/// surface).
void RaycastRow(const RaycastKernelArgs& args, int y, SurfaceMaps& maps);

}  // namespace isotherm
