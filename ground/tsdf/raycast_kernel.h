#pragma once

#include <cstdint>

#include "ground/surface/surface_maps.h"

namespace isotherm {

/// Everything a tile of rays needs. Positions are in voxels with the border block of the table
/// included: the centre of voxel (0, 0, 0) of the volume is at (8, 8, 8). Plain numbers: no
/// options, no Eigen, so that the kernel can be compiled for several instruction sets.
struct RaycastKernelArgs {
  const std::int32_t* table;   ///< Block indices with border, x fastest, -1 = none.
  const std::int32_t* voxels;  ///< TsdfVoxel words of block 0; block -1 exists and is unobserved.
  std::int32_t stride_y, stride_z;  ///< Strides of the table.
  std::int32_t last[3];             ///< The table's last voxel along each axis.
  float low, high[3];               ///< Rays stay inside, half way into the border.
  std::int32_t min_weight_code;     ///< In TsdfVoxel weight units, at least 1.
  float truncation_vox;
  std::int32_t max_refinements;  ///< Newton steps from the change of sign to the surface.
  float max_last_step_vox;       ///< Above this there is no surface.

  float origin[3];  ///< Camera position.
  float R[9];       ///< World from camera, row-major.
  float fx, fy, cx, cy;
  float voxel_m;
  float map_origin[3];  ///< Camera position in metres.
};

/// Pixels per side of a tile.
inline constexpr int kRaycastTile = 8;

/// Casts the rays of the tile whose first pixel is (x, y), from depth `near_vox` to the greater
/// `far_vox` along the camera's z, and writes all six planes of `maps` there (`map`, metres; NaN =
/// no surface).
void RaycastTile(const RaycastKernelArgs& args, int x, int y, float near_vox, float far_vox,
                 SurfaceMaps& maps);

}  // namespace isotherm
