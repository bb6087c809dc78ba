#include "ground/measuring/area_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ground/measuring/flat_polygon.h"

namespace isotherm {
namespace {

/// Surface that stands in front of the corners by up to this is part of what one sees.
constexpr double kInFront_m = 0.03;
/// Cells of the depth grid, in voxels, and how far behind the nearest surface of its cell a
/// triangle still counts as seen: a slope of 70 degrees over one and a half cells.
constexpr double kCell_vox = 2.0;
constexpr double kBehind_vox = 8.0;
/// Surface that is turned away from the viewer by more than this cosine is not seen.
constexpr double kMinFacing = 0.02;

}  // namespace

/// A triangle that may be inside.
struct AreaOutline::Candidate {
  std::array<const CloudPoint*, 3> corners;
  std::array<Eigen::Vector3d, 3> in_plane;
  Eigen::Vector3d centre;  ///< In the plane.
  double area_m2 = 0.0;
};

/// The nearest surface in each cell of the plane.
class AreaOutline::DepthGrid {
 public:
  DepthGrid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m)
      : low_(low), cell_m_(cell_m) {
    // A grid that is finer than this shows nothing more: large areas get larger cells.
    constexpr double kMaxSide = 4096.0;
    const Eigen::Vector2d size = high - low;
    cell_m_ = std::max(cell_m_, size.maxCoeff() / kMaxSide);
    width_ = static_cast<int>(size.x() / cell_m_) + 1;
    height_ = static_cast<int>(size.y() / cell_m_) + 1;
    nearest_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                    std::numeric_limits<double>::infinity());
  }
  void Add(const Eigen::Vector3d& p) {
    double& nearest = At(p);
    nearest = std::min(nearest, p.z());
  }
  double& At(const Eigen::Vector3d& p) {
    const auto cell = [&](double value, double low, int count) {
      return std::clamp(static_cast<int>((value - low) / cell_m_), 0, count - 1);
    };
    return nearest_[static_cast<std::size_t>(cell(p.y(), low_.y(), height_)) *
                        static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(cell(p.x(), low_.x(), width_))];
  }

 private:
  Eigen::Vector2d low_;
  double cell_m_;
  int width_ = 1, height_ = 1;
  std::vector<double> nearest_;
};

AreaOutline::AreaOutline(std::span<const Eigen::Vector3d> corners,
                         const Eigen::Vector3d& direction) {
  const Eigen::Vector3d forward = direction.normalized();
  Eigen::Index flattest = 0;
  forward.cwiseAbs().minCoeff(&flattest);
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::Unit(flattest)).normalized();
  axes_.row(0) = right;
  axes_.row(1) = forward.cross(right);
  axes_.row(2) = forward;
  low_.setConstant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  nearest_m_ = std::numeric_limits<double>::infinity();
  farthest_m_ = -nearest_m_;
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector3d p = InPlane(corner);
    polygon_.emplace_back(p.x(), p.y());
    low_ = low_.cwiseMin(polygon_.back());
    high_ = high_.cwiseMax(polygon_.back());
    nearest_m_ = std::min(nearest_m_, p.z());
    farthest_m_ = std::max(farthest_m_, p.z());
  }
  nearest_m_ -= kInFront_m;
  farthest_m_ += (high_ - low_).norm();
}

bool AreaOutline::MayHold(const VoxelGrid& grid, const GridIndex& block) const {
  const double side_m = grid.block_size_m();
  const Eigen::Vector3d centre =
      InPlane(grid.min_m + side_m * (block.cast<double>() + Eigen::Vector3d::Constant(0.5)));
  const double radius_m = side_m;  // Half the diagonal and half a voxel are less.
  return (centre.head<2>().array() >= low_.array() - radius_m).all() &&
         (centre.head<2>().array() <= high_.array() + radius_m).all() &&
         centre.z() >= nearest_m_ - radius_m && centre.z() <= farthest_m_ + radius_m;
}

std::vector<AreaOutline::Candidate> AreaOutline::Candidates(SurfaceProbe& probe) const {
  std::vector<Candidate> candidates;
  const TsdfVolume& tsdf = probe.tsdf();
  for (std::int32_t block = 0; block < tsdf.block_count(); ++block) {
    if (!MayHold(tsdf.grid(), tsdf.block_coordinates(block))) continue;
    const Surface& part = probe.PartAt(tsdf.block_coordinates(block));
    for (const Eigen::Vector3i& t : part.triangles) {
      Candidate candidate;
      for (int i = 0; i < 3; ++i) {
        const auto corner = static_cast<std::size_t>(i);
        candidate.corners[corner] = &part.points[static_cast<std::size_t>(t[i])];
        candidate.in_plane[corner] = InPlane(candidate.corners[corner]->position_m.cast<double>());
      }
      const auto& p = candidate.in_plane;
      candidate.centre = (p[0] + p[1] + p[2]) / 3.0;
      if (candidate.centre.z() < nearest_m_ || candidate.centre.z() > farthest_m_) continue;
      // Counter-clockwise seen from outside: the normal points to the viewer.
      const Eigen::Vector3d doubled = (p[1] - p[0]).cross(p[2] - p[0]);
      candidate.area_m2 = 0.5 * doubled.norm();
      if (-doubled.z() <= kMinFacing * doubled.norm()) continue;
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

std::vector<AreaPiece> AreaOutline::Pieces(SurfaceProbe& probe) const {
  const std::vector<Candidate> candidates = Candidates(probe);
  const double voxel_m = probe.tsdf().grid().voxel_size_m;
  DepthGrid depths(low_, high_, kCell_vox * voxel_m);
  for (const Candidate& candidate : candidates) {
    depths.Add(candidate.centre);
    for (const Eigen::Vector3d& p : candidate.in_plane) depths.Add(p);
  }
  std::vector<AreaPiece> pieces;
  for (const Candidate& candidate : candidates) {
    if (candidate.centre.z() > depths.At(candidate.centre) + kBehind_vox * voxel_m) continue;
    const double inside =
        FractionInside({candidate.in_plane[0].head<2>(), candidate.in_plane[1].head<2>(),
                        candidate.in_plane[2].head<2>()},
                       polygon_);
    if (inside <= 0.0) continue;
    for (const CloudPoint* corner : candidate.corners)
      pieces.push_back({corner, inside * candidate.area_m2 / 3.0});
  }
  return pieces;
}

}  // namespace isotherm
