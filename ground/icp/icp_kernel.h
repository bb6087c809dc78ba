#pragma once

#include <array>
#include <cstdint>

#include "ground/surface/surface_maps.h"

namespace isotherm {

/// Holds what one pass of ICP needs, as plain numbers, so that the kernel can be compiled for
/// several instruction sets. Matrices are row-major. Current maps are in camera coordinates, model
/// maps in `map`, metres.
struct IcpKernelArgs {
  const SurfaceMaps* current;
  const SurfaceMaps* model;
  float R_map_depth[9], t_map_depth[3];
  float R_model_depth[9],
      t_model_depth[3];  ///< From the current camera to the model view's camera.
  float fx, fy, cx, cy;  ///< Intrinsics of the model view.
  float volume_min[3], volume_max[3];
  float max_squared_distance_m2;
  float min_normal_cosine;
  float reference_depth_m;  ///< Weight of a residual: (reference depth / depth)^4.
};

/// Sums over some pixels: upper triangle of H (21), g (6), squared residuals (1); twist =
/// (translation, rotation about the current camera's position).
struct IcpKernelSums {
  std::array<float, 28> sums{};
  std::int64_t inliers = 0;
  std::int64_t candidates = 0;  ///< Valid pixels inside the volume.
  std::int64_t overlap = 0;     ///< Candidates behind which the model has a surface, near or not.
};

/// Adds the pixels of rows [first_row, last_row) to `sums`.
void AccumulateIcpRows(const IcpKernelArgs& args, int first_row, int last_row, IcpKernelSums& sums);

}  // namespace isotherm
