#pragma once

#include <array>
#include <cstdint>

#include "ground/surface/block_layout.h"
#include "ground/thermal/sigma_code.h"
#include "ground/thermal/voxel_layout.h"

namespace isotherm {

/// Holds what one pixel of the ideal thermal camera says about the surface that it shows, in 16
/// bytes.
struct ThermalPixel {
  static constexpr float kSlopeScale = 64.0F;
  static constexpr int kSlopeVShift = 16;
  static constexpr std::int32_t kSlopeUMask = 0xFFFF;
  static constexpr std::int32_t kMaxSlopeCode = 32767;

  /// Both cameras see the surface here.
  static constexpr std::int32_t kSeen = 1 << ThermalLayout::kDisagreementShift;
  /// And its temperature may be assigned.
  static constexpr std::int32_t kAssignable = 2 << ThermalLayout::kDisagreementShift;
  static constexpr int kCosineShift = ThermalLayout::kCodeShift;
  static constexpr float kCosineScale = 255.0F;
  static constexpr int kSigmaShift = kCosineShift + 8;

  float depth_m;        ///< Depth of the model's surface along the thermal camera's z; 0 = none.
  float celsius;        ///< At the pixel's centre.
  std::int32_t slopes;  ///< d celsius / dv above d celsius / du, signed, in 1 / kSlopeScale K/px.
  std::int32_t flags;   ///< A ThermalVoxel's word but for three fields: kSeen and kAssignable take
                        ///< the place of the disagreement; the cosine of the emission angle, in
                        ///< 1 / kCosineScale from kCosineShift on, that of the temperature; and
                        ///< from kSigmaShift on stands the SigmaCode of an assignable one.

  static constexpr std::uint8_t Cosine(std::int32_t flags) {
    return static_cast<std::uint8_t>(flags >> kCosineShift & 0xFF);
  }
  static constexpr std::uint8_t Sigma(std::int32_t flags) {
    return static_cast<std::uint8_t>(flags >> kSigmaShift & 0xFF);
  }
};
static_assert(sizeof(ThermalPixel) == 16);

/// Says how the plane through a pixel's vertex, across its normal, goes on within the pixel: along
/// a line of sight du and dv pixels beside the pixel's centre it is at depth
/// depth_m / (1 + u du + v dv), since the inverse depth of a plane is linear in the image. Packed
/// like ThermalPixel::slopes, in 1 / kScale per pixel.
struct PixelPlane {
  static constexpr float kScale = 65536.0F;  ///< 1e-5 of the depth within a pixel.
  static constexpr int kVShift = 16;
  static constexpr std::int32_t kUMask = 0xFFFF;
  static constexpr std::int32_t kMaxCode = 32767;  ///< Half the depth per pixel: all but edge-on.
};
static_assert(((ThermalPixel::kSeen | ThermalPixel::kAssignable) &
               ~static_cast<std::int32_t>(ThermalLayout::kDisagreementMask)) == 0,
              "flags must leave the classes alone");

/// Bilinear look-up of one row of an image.
struct ResampleRowArgs {
  const float* image;  ///< Whole image, NaN = no value.
  std::int32_t stride;
  const std::int32_t* source;  ///< Index of the upper left of four pixels, -1 = outside.
  const float* fraction_x;
  const float* fraction_y;
  std::int32_t width;
};
void ResampleRow(const ResampleRowArgs& args, float* out);

/// Distances of a row of vertices (`map`, metres) from `position`; a huge one for NaN.
void DistanceRow(const float* vx, const float* vy, const float* vz, const float* position,
                 std::int32_t width, float* distance_m);

/// Holds the parts of the standard uncertainty of a pixel's temperature, for inner loops: squares
/// of the quantities of FrameUncertainty (but for the scene), as BudgetOf combines them.
struct SigmaArgs {
  float noise_k2;
  float even_k2;       ///< Common to all pixels: drift and resolution.
  float place_px2;     ///< Registration and the pixel itself, along each axis.
  float voxel_px2_m2;  ///< The same of a voxel, times the square of the depth.
  float time_s2;
  float scene_influence;
  float scene_celsius;
};

/// One row of the thermal image beside the model as the thermal camera sees it.
struct PixelRowArgs {
  // The model's vertices and normals in `map`, NaN = no surface.
  const float* vx;
  const float* vy;
  const float* vz;
  const float* nx;
  const float* ny;
  const float* nz;
  const float* distance_m;  ///< This row's; can be read `margin` rows and columns around.
  const float* celsius;     ///< This row's; can be read one row and column around.
  std::int32_t distance_stride, celsius_stride;
  std::int32_t margin;
  std::int32_t width;
  float position[3];           ///< Position of the thermal camera in `map`.
  float z_axis[4];             ///< Depth along the thermal camera's z = z_axis . (p, 1).
  float x_axis[3], y_axis[3];  ///< The thermal camera's other axes in `map`.
  float R_depth[9];            ///< Depth camera from `map`.
  float t_depth[3];
  float depth_fx, depth_fy, depth_cx, depth_cy;
  float depth_width, depth_height;
  float occlusion_tolerance_m;  ///< Surfaces farther behind the nearest around are hidden.
  float distance_min_m, distance_good_m, distance_max_m;
  float cosine_min_angle, cosine_good_angle, cosine_max_angle;
  float max_footprint_m;  ///< Largest spot of a pixel on the surface; beyond is a bad distance.
  float max_error_k;      ///< Most that the temperature may change within the uncertainty.
  float uncertainty_px;   ///< How uncertain a pixel's place on the surface is; the smear if that is
                          ///< more.
  // Motion (CameraMotion) of the ideal camera, and how long it smears this row.
  float fx, fy, cx;
  float y;  ///< Normalised image coordinate of the row.
  float velocity_m_s[3], rate_rad_s[3];
  float smear_s;
  float smear_good_px, smear_max_px;
  const float* noise_gain;  ///< This row's variance of noise that resampling leaves.
  SigmaArgs sigma;
};
/// Pixels that both cameras see but that are not assigned, by the first reason that applies.
struct PixelRowCounts {
  std::int64_t occluded = 0;  ///< Too near the edge of something nearer.
  std::int64_t smeared = 0;
  std::int64_t steep = 0;
};
/// `planes`: of each pixel (PixelPlane).
PixelRowCounts MakePixelRow(const PixelRowArgs& args, ThermalPixel* pixels, std::int32_t* planes);

/// Holds a thermal frame and the limits within which voxels take its temperatures.
struct FusionKernelArgs {
  const ThermalPixel* pixels;  ///< Row-major, and one more with depth 0.
  const std::int32_t* planes;  ///< One plane per pixel (PixelPlane).
  std::int32_t width, height;
  float fx, fy, cx, cy;
  float axes[9];  ///< Columns: step of one voxel along x, y, z in thermal camera coordinates,
                  ///< metres; row-major.
  float max_distance_m;        ///< Along the line of sight, between a voxel and the plane of the
                               ///< surface that it takes its temperature from.
  std::int32_t max_tsdf_code;  ///< Voxels farther from the surface are passed over.
  bool validate;               ///< Worse conditions do not replace better ones (algorithm 6), nor
                               ///< a larger uncertainty a smaller one under equal classes.
  bool keep_bad;               ///< Bad conditions give a temperature, not only their classes.
  bool keep_lowest;            ///< Keep the lowest of temperatures under good conditions.
};
/// Counts the voxels that a block offered and those that took a temperature.
struct FusionKernelCounts {
  std::int64_t considered = 0;
  std::int64_t assigned = 0;
};
/// Holds what was measured of the voxels of one block: those that took a new temperature, and those
/// that were measured under good conditions, whether they took it or not.
struct BlockMeasurements {
  static constexpr std::int32_t kVoxelMask = kBlockVoxels - 1;
  static constexpr std::int32_t kAssigned = kBlockVoxels;  ///< Beside the voxel's index.
  static constexpr int kRoom = kBlockVoxels + 64;          ///< Vectors are written whole.

  int count = 0;
  std::int32_t voxels[kRoom];  ///< Index and kAssigned.
  std::int32_t words[kRoom];   ///< ThermalLayout without disagreement.
  std::int32_t flags[kRoom];   ///< Flags of the pixel.
};
/// SigmaCodes of the temperatures that a block has, per row of 8 voxels along x; nullptr: of that
/// row none are known.
struct BlockSigmas {
  static constexpr int kRowVoxels = 8;
  static constexpr int kRows = kBlockVoxels / kRowVoxels;
  std::array<const std::uint8_t*, kRows> rows{};
};
/// The 512 voxels of a block.
struct BlockVoxels {
  const float* first;  ///< The first voxel's centre in thermal camera coordinates, metres.
  const std::uint32_t* tsdf;
  const BlockSigmas& sigmas;
  std::uint32_t* thermal;  ///< Is changed.
};
/// Algorithms 5 and 6 for the voxels of a block. `measured` may be nullptr.
void FuseBlock(const FusionKernelArgs& args, const BlockVoxels& block, FusionKernelCounts& counts,
               BlockMeasurements* measured);

}  // namespace isotherm
