#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include "common/testing/kernel_checks.h"
#include "ground/tsdf/integration_kernel.h"
#include "ground/tsdf/tsdf_volume.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Tribool;

/// Holds what MakeSampleRow must make of a pixel, before it is rounded to a DepthSample.
struct Sample {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double weight = 0.0;
  Tribool has_normal = Tribool::kNo;
};

inline Sample MakeSample(const SampleRowArgs& a, int x) {
  constexpr double kReferenceDepth = 0.5;
  constexpr double kMinWeight = 0.25;
  constexpr double kEdgeWeight = 0.125;
  Sample sample;
  const double depth = a.depth_m[x];
  if (!(depth > 0.0)) return sample;
  const Eigen::Vector3d ray((x - static_cast<double>(a.cx)) / a.fx, a.ray_y, 1.0);
  const Eigen::Vector3d to_camera = -ray.normalized();
  const Eigen::Vector3d n(a.nx[x], a.ny[x], a.nz[x]);
  sample.p = depth * ray;
  sample.weight = std::clamp(std::pow(kReferenceDepth / depth, 2), kMinWeight, 1.0);
  sample.has_normal = AtLeastZero(n.dot(to_camera), testing::kSinglePrecision);
  const bool has_normal = sample.has_normal == Tribool::kYes;
  sample.n = has_normal && !a.along_ray ? n : to_camera;
  sample.weight *= has_normal ? std::min(1.0, n.dot(to_camera)) : kEdgeWeight;
  return sample;
}

/// The table entries that FindMissingBlocks must name for pixel x; nullopt where rounding may
/// choose the block.
inline std::optional<std::set<std::int32_t>> MissingBlocks(const BandRowArgs& a, int x) {
  constexpr double kNearFace = 1e-3;  // Blocks.
  std::set<std::int32_t> missing;
  const double depth = a.depth_m[x];
  if (x % 2 != 0 || !(depth > 0.0)) return missing;
  const Eigen::Vector3d ray((x - static_cast<double>(a.cx)) / a.fx, a.ray_y, 1.0);
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(a.R).cast<double>();
  const Eigen::Vector3d t = Eigen::Map<const Eigen::Vector3f>(a.t).cast<double>();
  for (int i = -a.half_steps; i <= a.half_steps; ++i) {
    const double z = depth + static_cast<double>(a.truncation_m) * i / a.half_steps / ray.norm();
    const Eigen::Vector3d p = R * (z * ray) + t;
    if (!p.allFinite()) continue;
    if (((p.array() - p.array().round()).abs() < kNearFace).any()) return std::nullopt;
    const Eigen::Array3d block = p.array().floor();
    const Eigen::Array3d last(a.blocks[0], a.blocks[1], a.blocks[2]);
    if ((block < 1.0).any() || (block > last).any()) continue;
    const auto entry =
        static_cast<std::int32_t>(block.x() + block.y() * a.stride_y + block.z() * a.stride_z);
    if (a.table[entry] < 0) missing.insert(entry);
  }
  return missing;
}

/// Holds what a voxel must become, unless rounding decides.
struct VoxelUpdate {
  TsdfVoxel voxel;
  bool certain = true;  ///< Not so near a pixel's or the band's border that rounding decides.
};

/// Returns what IntegrateBlock must make of a voxel at `p` (camera coordinates, metres) if it gets
/// the distance wrong by `error_m`.
inline VoxelUpdate UpdateVoxel(const IntegrationKernelArgs& a, const Eigen::Vector3d& p,
                               TsdfVoxel voxel, double error_m) {
  constexpr double kNearPixelBorder = 2e-3;  // Pixels.
  constexpr double kNearBandBorder = 2e-6;   // Metres.
  constexpr double kNearWeightStep = 0.02;   // Weight codes.
  constexpr double kMinCertainty = 0.02;
  VoxelUpdate result{voxel};
  const auto decide = [&result](double value, double slack) {
    if (std::abs(value) < slack) result.certain = false;
    return value >= 0.0;
  };
  if (!decide(p.z(), kNearBandBorder) || p.z() == 0.0) return result;
  const double u = a.fx * p.x() / p.z() + a.cx + 0.5;
  const double v = a.fy * p.y() / p.z() + a.cy + 0.5;
  if (!decide(std::min({u, v, a.width - u, a.height - v}), kNearPixelBorder)) return result;
  decide(std::abs(u - std::round(u)), kNearPixelBorder);
  decide(std::abs(v - std::round(v)), kNearPixelBorder);
  if (!result.certain) return result;
  const DepthSample& s = a.samples[static_cast<int>(v) * a.width + static_cast<int>(u)];
  const double weight =
      (s.normal_z_weight & DepthSample::kLowerMask) / double{DepthSample::kWeightScale};
  if (weight <= 0.0) return result;
  const double truncation = a.truncation_m;
  const double along_ray = s.depth_m - p.z();
  const double distance =
      (static_cast<std::int16_t>(s.normal_xy & DepthSample::kLowerMask) * p.x() +
       (s.normal_xy >> DepthSample::kUpperShift) * p.y() +
       (s.normal_z_weight >> DepthSample::kUpperShift) * p.z() - s.scaled_offset) /
          DepthSample::kNormalScale +
      error_m;
  const bool is_free = decide(along_ray - 2.0 * truncation, kNearBandBorder);
  if (!is_free && !(decide(along_ray + 2.0 * truncation, kNearBandBorder) &&
                    decide(distance + truncation, kNearBandBorder))) {
    return result;
  }
  const double tsdf = is_free ? 1.0 : std::min(1.0, distance / truncation);
  const double noise_reach =
      std::min(1.0, static_cast<double>(a.noise_at_1m) * s.depth_m * s.depth_m / truncation);
  const double certainty =
      std::clamp((1.0 + tsdf) / std::max(kMinCertainty, 1.0 - noise_reach), kMinCertainty, 1.0);
  const double new_weight = weight * certainty;
  const double total = voxel.weight() + new_weight;
  if (!decide(total * TsdfVoxel::kWeightScale - 0.5, kNearWeightStep)) return result;
  const double averaged = (voxel.tsdf() * double{voxel.weight()} + tsdf * new_weight) / total;
  const auto tsdf_code = static_cast<std::int32_t>(std::lrint(averaged * TsdfVoxel::kTsdfScale));
  const auto weight_code = static_cast<std::uint32_t>(
      std::lrint(std::min(total, double{a.max_weight}) * TsdfVoxel::kWeightScale));
  result.voxel.bits = TsdfLayout::Pack(tsdf_code, weight_code);
  return result;
}

}  // namespace isotherm::reference
