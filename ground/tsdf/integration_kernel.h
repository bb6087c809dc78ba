#pragma once

#include <cstdint>

#include "ground/surface/block_layout.h"

namespace isotherm {

/// Holds what one depth pixel says about the surface, in 16 bytes: the plane n . p = offset (camera
/// coordinates, metres, n towards the camera), the depth along z, and the weight of the observation
/// (0 = nothing was seen).
struct DepthSample {
  /// Components of a normal and weights are -1..1 and 0..1 and have 16 bits each, two to a word.
  static constexpr float kNormalScale = 32767.0F;
  static constexpr float kWeightScale = 65535.0F;
  static constexpr int kUpperShift = 16;
  static constexpr std::int32_t kLowerMask = 0xFFFF;

  float depth_m;
  std::int32_t normal_xy;        ///< y above x, each signed, in 1 / kNormalScale.
  std::int32_t normal_z_weight;  ///< z, signed, above the weight in 1 / kWeightScale.
  float scaled_offset;           ///< n . p with the rounded n, times kNormalScale.

  /// `n` unit length, `p` the observed point, 0 <= `weight` <= 1.
  static DepthSample Make(const float* n, const float* p, float weight);
};
static_assert(sizeof(DepthSample) == 16);

/// Holds a row of a depth image with its normals, and how samples are made of it.
struct SampleRowArgs {
  const float* depth_m;  ///< One image row, 0 = no return.
  const float* nx;       ///< Normals in camera coordinates, NaN = none.
  const float* ny;
  const float* nz;
  std::int32_t width;
  float fx, cx;
  float ray_y;     ///< (row - cy) / fy.
  bool along_ray;  ///< Distances along the line of sight instead of to the plane.
};

/// Makes the samples of one image row. Where there is no normal the surface is taken to face the
/// camera, with little weight. Weights fall with the square of the depth and the cosine of the
/// angle.
void MakeSampleRow(const SampleRowArgs& args, DepthSample* samples);

/// Holds what finding blocks near the surface needs; positions in blocks with the table's border
/// block included.
struct BandRowArgs {
  const float* depth_m;
  std::int32_t width;
  float fx, cx;
  float ray_y;
  float R[9];  ///< Blocks from camera, scaled; row-major.
  float t[3];
  float truncation_m;
  std::int32_t half_steps;  ///< The band is sampled at -half_steps .. half_steps along the ray.
  const std::int32_t* table;
  std::int32_t stride_y, stride_z;
  std::int32_t blocks[3];
};

/// Writes the table entries in which no block is yet, for every second pixel of one image row, to
/// `missing` (with repetitions) and returns how many. Room for `BandRowCapacity` entries.
std::int32_t FindMissingBlocks(const BandRowArgs& args, std::int32_t* missing);
inline std::int32_t BandRowCapacity(const BandRowArgs& args) {
  return (args.width + 64) * (2 * args.half_steps + 1);
}

/// Holds what the update of a block needs, as plain numbers, so that the kernel can be compiled for
/// several instruction sets.
struct IntegrationKernelArgs {
  const DepthSample* samples;  ///< Per pixel, row-major, and one more with weight 0.
  std::int32_t width, height;
  float fx, fy, cx, cy;
  float axes[9];  ///< Columns: step of one voxel along x, y, z in camera coordinates, metres;
                  ///< row-major.
  float truncation_m;
  float max_weight;
  float noise_at_1m;  ///< Noise of the depth, metres; grows with the square of the depth.
};

/// Updates the voxel words (TsdfLayout) of a block whose first voxel's centre is at `first` (camera
/// coordinates, metres). Returns whether an observed voxel of it lies at or behind the surface.
bool IntegrateBlock(const IntegrationKernelArgs& args, const float* first, std::uint32_t* voxels);

}  // namespace isotherm
