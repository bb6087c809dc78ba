#pragma once

#include <cstdint>

namespace isotherm {

/// What one depth pixel says about the surface: the plane n . p = offset (camera coordinates,
/// metres, n towards the camera), the depth along z, and the weight of the observation (0 = nothing
/// was seen).
struct DepthSample {
  float nx, ny, nz, offset;
  float depth_m;
  float weight;
};
inline constexpr int kDepthSampleFloats = 6;
static_assert(sizeof(DepthSample) == kDepthSampleFloats * sizeof(float));

/// What the update of a block needs, as plain numbers, so that the kernel can be compiled for
/// several instruction sets.
struct IntegrationKernelArgs {
  const float* samples;  ///< DepthSample per pixel, row-major.
  std::int32_t width, height;
  float fx, fy, cx, cy;
  float axes[9];  ///< Columns: step of one voxel along x, y, z in camera coordinates, metres;
                  ///< row-major.
  float truncation_m;
  float max_weight;
};

/// Updates the 512 voxel words of a block whose first voxel's centre is at `first` (camera
/// coordinates, metres).
void IntegrateBlock(const IntegrationKernelArgs& args, const float* first, std::uint32_t* voxels);

}  // namespace isotherm
