#include "ground/measuring/surface_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isotherm {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Walks from block to block along a ray (J. Amanatides, A. Woo, "A fast voxel traversal algorithm
/// for ray tracing", 1987). Cubes of a block reach half a voxel into the next one, so positions are
/// shifted by half a voxel: a block then stands for the cubes that start in it.
class BlockWalk {
 public:
  BlockWalk(const VoxelGrid& grid, const SurfaceRay& ray, double reach_m) : reach_m_(reach_m) {
    const double side_m = grid.block_size_m();
    const Eigen::Vector3d direction = ray.direction.normalized();
    const Eigen::Vector3d shift = Eigen::Vector3d::Constant(0.5 * grid.voxel_size_m);
    const Eigen::Vector3d low = grid.min_m + shift;
    const Eigen::Vector3d high = grid.max_m() + shift;
    double enter = 0.0, leave = reach_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0.0) {
        if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) leave = -1.0;
        continue;
      }
      const double a = (low[axis] - ray.origin[axis]) / direction[axis];
      const double b = (high[axis] - ray.origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    at_m_ = enter;
    reach_m_ = leave;
    // A ray that misses the grid may begin so far away that no block has its number.
    if (is_over()) return;
    const Eigen::Vector3d position = (ray.origin + enter * direction - low) / side_m;
    for (int axis = 0; axis < 3; ++axis) {
      block_[axis] =
          std::clamp(static_cast<int>(std::floor(position[axis])), 0, grid.blocks[axis] - 1);
      step_[axis] = direction[axis] > 0.0 ? 1 : -1;
      per_block_m_[axis] = direction[axis] == 0.0 ? kNever : side_m / std::abs(direction[axis]);
      const double border = low[axis] + side_m * (block_[axis] + (step_[axis] > 0 ? 1 : 0));
      next_m_[axis] =
          direction[axis] == 0.0 ? kNever : (border - ray.origin[axis]) / direction[axis];
    }
  }
  bool is_over() const { return at_m_ > reach_m_; }
  const GridIndex& block() const { return block_; }
  /// Where the ray leaves the block, metres from its origin.
  double end_m() const { return next_m_.minCoeff(); }
  void Step() {
    int axis = 0;
    at_m_ = next_m_.minCoeff(&axis);
    block_[axis] += step_[axis];
    next_m_[axis] += per_block_m_[axis];
  }

 private:
  double reach_m_;
  double at_m_ = 0.0;
  GridIndex block_ = GridIndex::Zero();
  GridIndex step_ = GridIndex::Zero();
  Eigen::Vector3d next_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d per_block_m_ = Eigen::Vector3d::Zero();
};

/// The nearest triangle of a part that the ray meets.
std::optional<ProbeHit> CastAtPart(const Surface& part, const SurfaceRay& ray, double reach_m) {
  std::optional<ProbeHit> nearest;
  double best = reach_m;
  for (const Eigen::Vector3i& t : part.triangles) {
    const auto corner = [&](int i) -> const CloudPoint& {
      return part.points[static_cast<std::size_t>(t[i])];
    };
    const auto hit =
        IntersectTriangle(ray, corner(0).position_m.cast<double>(),
                          corner(1).position_m.cast<double>(), corner(2).position_m.cast<double>());
    if (!hit || hit->distance > best) continue;
    best = hit->distance;
    const auto u = static_cast<float>(hit->u), v = static_cast<float>(hit->v);
    nearest = {
        .point = ray.origin + hit->distance * ray.direction,
        .normal = ((1.0F - u - v) * corner(0).normal + u * corner(1).normal + v * corner(2).normal)
                      .normalized(),
        .distance_m = hit->distance};
  }
  return nearest;
}

}  // namespace

std::optional<TriangleHit> IntersectTriangle(const SurfaceRay& ray, const Eigen::Vector3d& a,
                                             const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d p = ray.direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0.0) return std::nullopt;
  const Eigen::Vector3d from_a = ray.origin - a;
  const double u = from_a.dot(p) / determinant;
  if (u < 0.0 || u > 1.0) return std::nullopt;
  const Eigen::Vector3d q = from_a.cross(ab);
  const double v = ray.direction.dot(q) / determinant;
  if (v < 0.0 || u + v > 1.0) return std::nullopt;
  const double distance = ac.dot(q) / determinant;
  if (distance < 0.0) return std::nullopt;
  return TriangleHit{distance, u, v};
}

const Surface& SurfaceProbe::PartAt(const GridIndex& block) {
  static const Surface kNothing;
  const std::int32_t index = tsdf_.Find(block);
  if (index == TsdfVolume::kNoBlock) return kNothing;
  const auto [place, is_new] = parts_.try_emplace(index);
  if (is_new) place->second = mesher_.Extract(tsdf_, thermal_, std::array{index});
  return place->second;
}

std::optional<ProbeHit> SurfaceProbe::Cast(const SurfaceRay& ray, double reach_m) {
  if (!ray.origin.allFinite() || !ray.direction.allFinite() || ray.direction.isZero())
    return std::nullopt;
  const SurfaceRay unit{ray.origin, ray.direction.normalized()};
  for (BlockWalk walk(tsdf_.grid(), unit, reach_m); !walk.is_over(); walk.Step()) {
    if (const auto hit = CastAtPart(PartAt(walk.block()), unit, reach_m)) return hit;
  }
  return std::nullopt;
}

}  // namespace isotherm
