#pragma once

#include <cstdint>

namespace isotherm {

/// What one pixel of the ideal thermal camera says about the surface that it shows, in 16 bytes.
struct ThermalPixel {
  static constexpr float kSlopeScale = 64.0F;
  static constexpr std::int32_t kSeen = 1 << 8;        ///< Both cameras see the surface here.
  static constexpr std::int32_t kAssignable = 1 << 9;  ///< And its temperature may be assigned.

  float depth_m;        ///< Of the model's surface along the thermal camera's z; 0 = none.
  float celsius;        ///< At the pixel's centre.
  std::int32_t slopes;  ///< d celsius / dv << 16 | d celsius / du, signed, in 1 / kSlopeScale K/px.
  std::int32_t flags;   ///< kSeen, kAssignable, and classes where ThermalVoxel has them.
};
static_assert(sizeof(ThermalPixel) == 16);

/// Bilinear look-up of one row of a picture.
struct ResampleRowArgs {
  const float* picture;  ///< Whole picture, NaN = no value.
  std::int32_t stride;
  const std::int32_t* source;  ///< Index of the upper left of four pixels, -1 = outside.
  const float* fraction_x;
  const float* fraction_y;
  std::int32_t width;
};
void ResampleRow(const ResampleRowArgs& args, float* out);

/// Distances of a row of vertices (world, metres) from `position`; a huge one for NaN.
void DistanceRow(const float* vx, const float* vy, const float* vz, const float* position,
                 std::int32_t width, float* distance_m);

/// One row of the thermal picture beside the model as the thermal camera sees it.
struct PixelRowArgs {
  // The model's vertices and normals in world, NaN = no surface.
  const float* vx;
  const float* vy;
  const float* vz;
  const float* nx;
  const float* ny;
  const float* nz;
  const float* distance_m;  ///< Of this row; can be read `margin` rows and columns around.
  const float* celsius;     ///< Of this row; can be read one row and column around.
  std::int32_t distance_stride, celsius_stride;
  std::int32_t margin;
  std::int32_t width;
  float position[3];  ///< Of the thermal camera in world.
  float z_axis[4];    ///< Depth along the thermal camera's z = z_axis . (p, 1).
  float R_depth[9];   ///< Depth camera from world.
  float t_depth[3];
  float depth_fx, depth_fy, depth_cx, depth_cy;
  float depth_width, depth_height;
  float occlusion_tolerance_m;  ///< Surfaces farther behind the nearest around are hidden.
  float distance_min_m, distance_good_m, distance_max_m;
  float cosine_min_angle, cosine_good_angle, cosine_max_angle;
};
/// Returns how many pixels both cameras see but an occluder's edge is too near.
std::int64_t MakePixelRow(const PixelRowArgs& args, ThermalPixel* pixels);

struct FusionKernelArgs {
  const ThermalPixel* pixels;  ///< Row-major, and one more with depth 0.
  std::int32_t width, height;
  float fx, fy, cx, cy;
  float axes[9];  ///< Columns: step of one voxel along x, y, z in thermal camera coordinates,
                  ///< metres; row-major.
  float max_distance_m;        ///< Between a voxel and the vertex it takes its temperature from.
  std::int32_t max_tsdf_code;  ///< Voxels farther from the surface are passed over.
  bool validate;               ///< Worse conditions do not replace better ones (algorithm 6).
};
struct FusionKernelCounts {
  std::int64_t considered = 0;
  std::int64_t assigned = 0;
};
/// Algorithms 5 and 6 for the 512 voxels of a block whose first voxel's centre is at `first`
/// (thermal camera coordinates, metres).
void FuseBlock(const FusionKernelArgs& args, const float* first, const std::uint32_t* tsdf,
               std::uint32_t* thermal, FusionKernelCounts& counts);

}  // namespace isotherm
