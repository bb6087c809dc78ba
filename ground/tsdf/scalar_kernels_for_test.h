#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "common/testing/kernel_checks_for_test.h"
#include "ground/tsdf/culling_kernel.h"
#include "ground/tsdf/integration_kernel.h"
#include "ground/tsdf/tsdf_volume.h"

// What the kernels of this folder must do, one element at a time and in double precision.
namespace isotherm::testing {

/// Relative error of a sum of a few products.
inline constexpr double kSinglePrecision = 1e-6;

/// Whether CullBlocks keeps a block. `precision` 0: all sums are exact.
inline Verdict ScalarCull(const float (&planes)[kFrustumPlanes][4], const std::int32_t* block,
                          double precision) {
  Verdict inside = Verdict::kYes;
  for (const auto& plane : planes) {
    double value = plane[3];
    double magnitude = std::abs(value);
    for (int axis = 0; axis < 3; ++axis) {
      const double term = static_cast<double>(plane[axis]) * block[axis];
      value += term;
      magnitude += std::abs(term);
    }
    inside = Both(inside, AtLeastZero(value, precision * magnitude));
  }
  return inside;
}

/// Holds what MakeSampleRow must make of a pixel, before it is rounded to a DepthSample.
struct ScalarSample {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double weight = 0.0;
  Verdict has_normal = Verdict::kNo;
};

inline ScalarSample MakeScalarSample(const SampleRowArgs& a, int x) {
  constexpr double kReferenceDepth = 0.5;
  constexpr double kMinWeight = 0.25;
  constexpr double kEdgeWeight = 0.125;
  ScalarSample sample;
  const double depth = a.depth_m[x];
  if (!(depth > 0.0)) return sample;
  const Eigen::Vector3d ray((x - static_cast<double>(a.cx)) / a.fx, a.ray_y, 1.0);
  const Eigen::Vector3d to_camera = -ray.normalized();
  const Eigen::Vector3d n(a.nx[x], a.ny[x], a.nz[x]);
  sample.p = depth * ray;
  sample.weight = std::clamp(std::pow(kReferenceDepth / depth, 2), kMinWeight, 1.0);
  sample.has_normal = AtLeastZero(n.dot(to_camera), kSinglePrecision);
  const bool has_normal = sample.has_normal == Verdict::kYes;
  sample.n = has_normal && !a.along_ray ? n : to_camera;
  sample.weight *= has_normal ? std::min(1.0, n.dot(to_camera)) : kEdgeWeight;
  return sample;
}

/// The table entries that FindMissingBlocks must name for pixel x; nullopt where rounding may
/// choose the block.
inline std::optional<std::set<std::int32_t>> ScalarMissingBlocks(const BandRowArgs& a, int x) {
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

struct ScalarUpdate {
  TsdfVoxel voxel;
  bool certain = true;  ///< Not so near a pixel's or the band's border that rounding decides.
};

/// Returns what IntegrateBlock must make of a voxel at `p` (camera coordinates, metres) if it gets
/// the distance wrong by `error_m`.
inline ScalarUpdate UpdateScalarVoxel(const IntegrationKernelArgs& a, const Eigen::Vector3d& p,
                                      TsdfVoxel voxel, double error_m) {
  constexpr double kNearPixelBorder = 2e-3;  // Pixels.
  constexpr double kNearBandBorder = 2e-6;   // Metres.
  constexpr double kNearWeightStep = 0.02;   // Weight codes.
  constexpr double kLeastCertainty = 0.02;
  ScalarUpdate result{voxel};
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
  const double weight = (s.normal_z_weight & 0xFFFF) / double{DepthSample::kWeightScale};
  if (weight <= 0.0) return result;
  const double truncation = a.truncation_m;
  const double along_ray = s.depth_m - p.z();
  const double distance =
      (static_cast<std::int16_t>(s.normal_xy & 0xFFFF) * p.x() + (s.normal_xy >> 16) * p.y() +
       (s.normal_z_weight >> 16) * p.z() - s.scaled_offset) /
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
      std::clamp((1.0 + tsdf) / std::max(kLeastCertainty, 1.0 - noise_reach), kLeastCertainty, 1.0);
  const double new_weight = weight * certainty;
  const double total = voxel.weight() + new_weight;
  if (!decide(total * TsdfVoxel::kWeightScale - 0.5, kNearWeightStep)) return result;
  const double averaged = (voxel.tsdf() * double{voxel.weight()} + tsdf * new_weight) / total;
  const auto tsdf_code = static_cast<std::int32_t>(std::lrint(averaged * TsdfVoxel::kTsdfScale));
  const auto weight_code = static_cast<std::uint32_t>(
      std::lrint(std::min(total, double{a.max_weight}) * TsdfVoxel::kWeightScale));
  result.voxel.bits = (static_cast<std::uint32_t>(tsdf_code) << 16) | weight_code;
  return result;
}

/// Rays through the trilinearly interpolated distance in small steps, then bisection.
class ScalarRaycaster {
 public:
  struct Hit {
    Eigen::Vector3d p;  ///< World, metres.
    Eigen::Vector3d n;
  };

  ScalarRaycaster(const TsdfVolume& volume, float min_weight)
      : grid_(volume.grid()),
        size_(grid_.blocks * kBlockSide),
        tsdf_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                  static_cast<std::size_t>(size_.z()),
              std::numeric_limits<double>::quiet_NaN()) {
    GridIndex voxel;
    std::size_t i = 0;
    for (voxel.z() = 0; voxel.z() < size_.z(); ++voxel.z()) {
      for (voxel.y() = 0; voxel.y() < size_.y(); ++voxel.y()) {
        for (voxel.x() = 0; voxel.x() < size_.x(); ++voxel.x(), ++i) {
          const TsdfVoxel value = volume.VoxelAt(voxel);
          if (value.observed() && value.weight() >= min_weight) tsdf_[i] = value.tsdf();
        }
      }
    }
  }

  /// The first change from positive to negative along the ray. What is first met from behind hides
  /// what lies beyond it.
  std::optional<Hit> Cast(const Eigen::Vector3d& origin_map,
                          const Eigen::Vector3d& direction_map) const {
    constexpr double kStep = 0.25;  // Voxels.
    const Eigen::Vector3d origin = grid_.ToVoxel(origin_map);
    const Eigen::Vector3d direction = direction_map.normalized();
    const double end = (origin - 0.5 * size_.cast<double>()).norm() + size_.cast<double>().norm();
    double before = std::numeric_limits<double>::quiet_NaN();
    for (double t = 0.0; t < end; t += kStep) {
      const double value = Interpolate(origin + t * direction);
      if (value <= 0.0) {
        if (!(before > 0.0)) return std::nullopt;
        return Bisect(origin, direction, t - kStep, t);
      }
      before = value;
    }
    return std::nullopt;
  }

 private:
  double At(const GridIndex& v) const {
    if ((v.array() < 0).any() || (v.array() >= size_.array()).any())
      return std::numeric_limits<double>::quiet_NaN();
    return tsdf_[static_cast<std::size_t>(v.x()) +
                 static_cast<std::size_t>(size_.x()) *
                     (static_cast<std::size_t>(v.y()) +
                      static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(v.z()))];
  }

  /// NaN unless all eight voxels around are observed.
  double Interpolate(const Eigen::Vector3d& p, Eigen::Vector3d* gradient = nullptr) const {
    const Eigen::Vector3d lower = p.array().floor();
    const Eigen::Vector3d f = p - lower;
    double value = 0.0;
    if (gradient != nullptr) gradient->setZero();
    for (int k = 0; k < 8; ++k) {
      const GridIndex side(k & 1, (k >> 1) & 1, k >> 2);
      const double corner = At(lower.cast<int>() + side);
      if (std::isnan(corner)) return corner;
      Eigen::Vector3d share;
      for (int axis = 0; axis < 3; ++axis) share[axis] = side[axis] != 0 ? f[axis] : 1.0 - f[axis];
      value += corner * share.prod();
      if (gradient == nullptr) continue;
      for (int axis = 0; axis < 3; ++axis) {
        (*gradient)[axis] +=
            (side[axis] != 0 ? corner : -corner) * share[(axis + 1) % 3] * share[(axis + 2) % 3];
      }
    }
    return value;
  }

  std::optional<Hit> Bisect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                            double before, double behind) const {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (before + behind);
      (Interpolate(origin + middle * direction) > 0.0 ? before : behind) = middle;
    }
    const Eigen::Vector3d p = origin + behind * direction;
    Eigen::Vector3d gradient;
    if (std::isnan(Interpolate(p, &gradient))) return std::nullopt;
    return Hit{grid_.VoxelCentre(GridIndex::Zero()) + p * grid_.voxel_size_m,
               gradient.normalized()};
  }

  const VoxelGrid grid_;
  const GridIndex size_;
  std::vector<double> tsdf_;
};

}  // namespace isotherm::testing
