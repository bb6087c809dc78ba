#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "ground/tsdf/tsdf_volume.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

/// Rays through the trilinearly interpolated distance in small steps, then bisection.
class Raycaster {
 public:
  /// Holds where a ray meets the surface.
  struct Hit {
    Eigen::Vector3d p;  ///< World, metres.
    Eigen::Vector3d n;
  };

  Raycaster(const TsdfVolume& volume, float min_weight)
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
      Eigen::Vector3d fraction;
      for (int axis = 0; axis < 3; ++axis)
        fraction[axis] = side[axis] != 0 ? f[axis] : 1.0 - f[axis];
      value += corner * fraction.prod();
      if (gradient == nullptr) continue;
      for (int axis = 0; axis < 3; ++axis) {
        (*gradient)[axis] += (side[axis] != 0 ? corner : -corner) * fraction[(axis + 1) % 3] *
                             fraction[(axis + 2) % 3];
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

}  // namespace isotherm::reference
