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
  /// The ray's direction is of unit length.
  BlockWalk(const VoxelGrid& grid, const SurfaceRay& ray, double reach_m)
      : origin_m_(ray.origin),
        direction_(ray.direction),
        low_m_(grid.min_m + Eigen::Vector3d::Constant(0.5 * grid.voxel_size_m)),
        side_m_(grid.block_size_m()),
        reach_m_(reach_m) {
    const Eigen::Vector3d high = low_m_ + side_m_ * grid.blocks.cast<double>();
    double enter = 0.0, leave = reach_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction_[axis] == 0.0) {
        if (origin_m_[axis] < low_m_[axis] || origin_m_[axis] > high[axis]) leave = -1.0;
        continue;
      }
      const double a = (low_m_[axis] - origin_m_[axis]) / direction_[axis];
      const double b = (high[axis] - origin_m_[axis]) / direction_[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    at_m_ = enter;
    reach_m_ = leave;
    // A ray that misses the grid may begin so far away that no block has its number.
    if (is_over()) return;
    const Eigen::Vector3d position = (origin_m_ + enter * direction_ - low_m_) / side_m_;
    for (int axis = 0; axis < 3; ++axis) {
      block_[axis] =
          std::clamp(static_cast<int>(std::floor(position[axis])), 0, grid.blocks[axis] - 1);
      step_[axis] = direction_[axis] > 0.0 ? 1 : -1;
      per_block_m_[axis] = direction_[axis] == 0.0 ? kNever : side_m_ / std::abs(direction_[axis]);
      const double border = low_m_[axis] + side_m_ * (block_[axis] + (step_[axis] > 0 ? 1 : 0));
      next_m_[axis] =
          direction_[axis] == 0.0 ? kNever : (border - origin_m_[axis]) / direction_[axis];
    }
  }
  bool is_over() const { return at_m_ > reach_m_; }
  const GridIndex& block() const { return block_; }
  /// Names the neighbours whose surface the ray may meet as well, because it runs along the border
  /// to them as exactly as points are stored: a step of -1 or 1 for each such axis.
  GridIndex Beside() const {
    constexpr double kStored_m = 1e-6;
    const double leave_m = std::min(next_m_.minCoeff(), reach_m_);
    GridIndex beside = GridIndex::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const auto is_near = [&](double border_m) {
        return std::abs(origin_m_[axis] + at_m_ * direction_[axis] - border_m) < kStored_m &&
               std::abs(origin_m_[axis] + leave_m * direction_[axis] - border_m) < kStored_m;
      };
      const double border_m = low_m_[axis] + side_m_ * block_[axis];
      if (is_near(border_m)) beside[axis] = -1;
      if (is_near(border_m + side_m_)) beside[axis] = 1;
    }
    return beside;
  }
  void Step() {
    int axis = 0;
    at_m_ = next_m_.minCoeff(&axis);
    block_[axis] += step_[axis];
    next_m_[axis] += per_block_m_[axis];
  }

 private:
  const Eigen::Vector3d origin_m_, direction_;
  const Eigen::Vector3d low_m_;  ///< Lower corner of the first block.
  const double side_m_;
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
  // A ray along an edge that two triangles share must meet one of them.
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const Eigen::Vector3d p = ray.direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0.0) return std::nullopt;
  const Eigen::Vector3d from_a = ray.origin - a;
  const double u = from_a.dot(p) / determinant;
  if (u < -kRounding || u > 1.0 + kRounding) return std::nullopt;
  const Eigen::Vector3d q = from_a.cross(ab);
  const double v = ray.direction.dot(q) / determinant;
  if (v < -kRounding || u + v > 1.0 + kRounding) return std::nullopt;
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
    const GridIndex beside = walk.Beside();
    std::optional<ProbeHit> nearest;
    for (int neighbour = 0; neighbour < 8; ++neighbour) {
      const GridIndex taken(neighbour & 1, neighbour >> 1 & 1, neighbour >> 2 & 1);
      // Each of the blocks that meet at the border once.
      if ((taken.array() != 0 && beside.array() == 0).any()) continue;
      const GridIndex block = walk.block() + taken.cwiseProduct(beside);
      const double limit_m = nearest ? nearest->distance_m : reach_m;
      if (const auto hit = CastAtPart(PartAt(block), unit, limit_m)) nearest = hit;
    }
    if (nearest) return nearest;
  }
  return std::nullopt;
}

}  // namespace isotherm
