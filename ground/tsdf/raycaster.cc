#include "ground/tsdf/raycaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRowsPerTask = 8;

/// Looks voxels up with the block of the last look-up at hand.
class VoxelCursor {
 public:
  VoxelCursor(const TsdfVolume& volume, float min_weight)
      : volume_(volume), min_weight_(static_cast<std::uint32_t>(min_weight * TsdfVoxel::kWeightScale)) {}

  /// First voxel of the block that holds `voxel`; null if there is none.
  const TsdfVoxel* Block(const GridIndex& voxel) {
    const GridIndex block(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    if (block != block_) {
      block_ = block;
      const std::int32_t index = volume_.Find(block);
      voxels_ = index == TsdfVolume::kNoBlock ? nullptr : volume_.voxels(index).data();
    }
    return voxels_;
  }

  static std::size_t Local(const GridIndex& voxel) {
    return static_cast<std::size_t>((voxel.x() & 7) | ((voxel.y() & 7) << 3) | ((voxel.z() & 7) << 6));
  }

  bool Observed(TsdfVoxel voxel) const {
    return voxel.observed() && (voxel.bits & 0xFFFFU) >= min_weight_;
  }

  /// NaN where nothing was observed.
  float Tsdf(const GridIndex& voxel) {
    const TsdfVoxel* block = Block(voxel);
    if (block == nullptr) return kNan;
    const TsdfVoxel v = block[Local(voxel)];
    return Observed(v) ? v.tsdf() : kNan;
  }

  /// NaN unless all eight voxels around were observed.
  float Interpolate(const Eigen::Vector3f& p) {
    const Eigen::Vector3f lower = p.array().floor();
    const Eigen::Vector3f f = p - lower;
    const GridIndex i = lower.cast<int>();
    std::array<float, 8> d;
    if ((i.x() & 7) != 7 && (i.y() & 7) != 7 && (i.z() & 7) != 7) {
      const TsdfVoxel* block = Block(i);
      if (block == nullptr) return kNan;
      const std::size_t local = Local(i);
      for (std::size_t k = 0; k < 8; ++k) {
        const TsdfVoxel v = block[local + (k & 1) + ((k >> 1) & 1) * 8 + (k >> 2) * 64];
        if (!Observed(v)) return kNan;
        d[k] = v.tsdf();
      }
    } else {
      for (int k = 0; k < 8; ++k) d[k] = Tsdf(i + GridIndex(k & 1, (k >> 1) & 1, k >> 2));
    }
    const float x00 = d[0] + f.x() * (d[1] - d[0]);
    const float x10 = d[2] + f.x() * (d[3] - d[2]);
    const float x01 = d[4] + f.x() * (d[5] - d[4]);
    const float x11 = d[6] + f.x() * (d[7] - d[6]);
    const float y0 = x00 + f.y() * (x10 - x00);
    const float y1 = x01 + f.y() * (x11 - x01);
    return y0 + f.z() * (y1 - y0);
  }

  Eigen::Vector3f Gradient(const Eigen::Vector3f& p) {
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3f offset = Eigen::Vector3f::Zero();
      offset[axis] = 1.0F;
      gradient[axis] = Interpolate(p + offset) - Interpolate(p - offset);
    }
    return gradient;
  }

 private:
  const TsdfVolume& volume_;
  const std::uint32_t min_weight_;
  GridIndex block_ = GridIndex::Constant(std::numeric_limits<int>::min());
  const TsdfVoxel* voxels_ = nullptr;
};

/// A ray in voxel coordinates: origin + t * direction, t in voxels.
struct Ray {
  Eigen::Vector3f origin, direction, inverse_direction;
  Eigen::Vector3f At(float t) const { return origin + t * direction; }
};

/// Where the ray is inside the box between `low` and `high`.
std::pair<float, float> Clip(const Ray& ray, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  const Eigen::Array3f a = (low - ray.origin).array() * ray.inverse_direction.array();
  const Eigen::Array3f b = (high - ray.origin).array() * ray.inverse_direction.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

struct March {
  float truncation_vox;
  Eigen::Vector3f low, high;  ///< Of the volume, voxel coordinates.
};

/// Distance along the ray to the surface in voxels, NaN if none.
float FindSurface(const Ray& ray, const March& march, VoxelCursor& cursor) {
  auto [t, end] = Clip(ray, march.low, march.high);
  t = std::max(t, 0.0F);
  float previous_t = kNan;
  float previous = kNan;
  while (t < end) {
    const Eigen::Vector3f p = ray.At(t);
    const GridIndex voxel = (p.array() + 0.5F).floor().cast<int>();
    if (cursor.Block(voxel) == nullptr) {
      const GridIndex block(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
      const Eigen::Vector3f block_low =
          (block * kBlockSide).cast<float>() - Eigen::Vector3f::Constant(0.5F);
      const float exit =
          Clip(ray, block_low, block_low + Eigen::Vector3f::Constant(static_cast<float>(kBlockSide))).second;
      t = std::max(exit, t) + 1e-3F;
      previous = kNan;
      continue;
    }
    const float value = cursor.Tsdf(voxel);
    if (value <= 0.0F) {
      if (!(previous > 0.0F)) {
        if (std::isnan(previous)) return kNan;  // Seen from behind, or an edge that was never observed in front.
      }
      float t0 = previous_t;
      float t1 = t;
      float f0 = cursor.Interpolate(ray.At(t0));
      float f1 = cursor.Interpolate(ray.At(t1));
      // The nearest voxel can be a little ahead of the interpolated surface.
      if (f1 > 0.0F) {
        t0 = t1;
        f0 = f1;
        t1 = t + 1.0F;
        f1 = cursor.Interpolate(ray.At(t1));
      } else if (f0 <= 0.0F) {
        t1 = t0;
        f1 = f0;
        t0 -= 1.0F;
        f0 = cursor.Interpolate(ray.At(t0));
      }
      if (!(f0 > 0.0F && f1 <= 0.0F)) return kNan;
      const float crossing = t0 + (t1 - t0) * f0 / (f0 - f1);
      // One secant step more: distances are not linear along the ray over a whole step.
      const float f = cursor.Interpolate(ray.At(crossing));
      if (std::isnan(f)) return crossing;
      return f > 0.0F ? crossing + (t1 - crossing) * f / (f - f1) : t0 + (crossing - t0) * f0 / (f0 - f);
    }
    previous = value;
    previous_t = t;
    t += std::isnan(value) ? 1.0F : std::max(1.0F, 0.8F * value * march.truncation_vox);
  }
  return kNan;
}

}  // namespace

std::optional<float> InterpolateTsdf(const TsdfVolume& volume, const Eigen::Vector3f& p_voxel, float min_weight) {
  VoxelCursor cursor(volume, min_weight);
  const float value = cursor.Interpolate(p_voxel);
  return std::isnan(value) ? std::nullopt : std::optional<float>(value);
}

void Raycast(const TsdfVolume& volume, const CameraModel& camera, const RigidTransform& T_world_camera,
             float min_weight, ThreadPool& pool, SurfaceMaps& maps) {
  maps.Resize(camera.width, camera.height);
  const VoxelGrid& grid = volume.grid();
  const auto voxel_m = static_cast<float>(grid.voxel_size_m);
  const Eigen::Vector3f origin = grid.ToVoxel(T_world_camera.translation()).cast<float>();
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f world_origin = T_world_camera.translation().cast<float>();
  const March march{static_cast<float>(volume.truncation_distance_m()) / voxel_m, Eigen::Vector3f::Constant(-0.5F),
                    (grid.blocks * kBlockSide).cast<float>() - Eigen::Vector3f::Constant(0.5F)};
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);

  pool.ParallelFor((camera.height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    VoxelCursor cursor(volume, min_weight);
    const int end = std::min(camera.height, (task + 1) * kRowsPerTask);
    for (int y = task * kRowsPerTask; y < end; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        Ray ray;
        ray.origin = origin;
        ray.direction = (R * Eigen::Vector3f((static_cast<float>(x) - cx) / fx, (static_cast<float>(y) - cy) / fy,
                                             1.0F)).normalized();
        ray.inverse_direction = ray.direction.cwiseInverse();
        const float t = FindSurface(ray, march, cursor);
        Eigen::Vector3f n = Eigen::Vector3f::Constant(kNan);
        Eigen::Vector3f p = n;
        if (!std::isnan(t)) {
          n = cursor.Gradient(ray.At(t)).normalized();
          if (n.allFinite()) p = world_origin + ray.direction * (t * voxel_m);
        }
        maps.vx.At(x, y) = p.x();
        maps.vy.At(x, y) = p.y();
        maps.vz.At(x, y) = p.z();
        maps.nx.At(x, y) = n.x();
        maps.ny.At(x, y) = n.y();
        maps.nz.At(x, y) = n.z();
      }
    }
  });
}

}  // namespace isotherm
