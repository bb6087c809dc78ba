#include "ground/feedback/seen_space.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Side of the cells. Smaller: more memory, and holes between silhouettes count as never seen;
/// larger: a whole view is one cell. Not tuned.
constexpr double kSeenCell_m = 0.05;

/// Cells are counted from the volume's corner: no index is negative.
std::uint64_t SeenKey(const Eigen::Array3i& cell) {
  // Three axes in 64 bits.
  constexpr int kBitsPerAxis = 21;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key = (key << kBitsPerAxis) | static_cast<std::uint64_t>(cell[axis]);
  return key;
}

}  // namespace

SeenSpace::SeenSpace(const VoxelGrid& grid, const CameraModel& depth_camera, double max_depth_m)
    : min_m_(grid.min_m),
      size_((grid.size_m() / kSeenCell_m).array().ceil().cast<int>()),
      camera_(depth_camera),
      max_depth_m_(max_depth_m) {}

bool SeenSpace::IsInside(const Cell& cell) const {
  return (cell >= 0).all() && (cell < size_).all();
}

SeenSpace::Cell SeenSpace::CellOf(const Eigen::Vector3d& p_map) const {
  return ((p_map - min_m_) / kSeenCell_m).array().floor().cast<int>();
}

void SeenSpace::Look(const RigidTransform& T_map_depth) {
  const RigidTransform T_depth_map = T_map_depth.inverse();
  // The box around what is in view: no corner of the view is further away than its diagonal.
  const double reach_m =
      max_depth_m_ * std::hypot(1.0, camera_.width / camera_.fx, camera_.height / camera_.fy);
  const Eigen::Vector3d here = T_map_depth.translation();
  const Cell low = CellOf(here.array() - reach_m).max(0);
  const Cell high = CellOf(here.array() + reach_m).min(size_ - 1);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const Cell cell(x, y, z);
        const Eigen::Vector3d p_depth =
            T_depth_map * (min_m_ + kSeenCell_m * (cell.cast<double>() + 0.5).matrix());
        if (p_depth.z() <= 0.0 || p_depth.z() > max_depth_m_) continue;
        const double u = camera_.fx * p_depth.x() / p_depth.z() + camera_.cx;
        const double v = camera_.fy * p_depth.y() / p_depth.z() + camera_.cy;
        if (u < 0.0 || v < 0.0 || u > camera_.width - 1 || v > camera_.height - 1) continue;
        seen_.insert(SeenKey(cell));
      }
    }
  }
}

bool SeenSpace::IsUnseen(const Eigen::Vector3d& p_map) const {
  const Cell cell = CellOf(p_map);
  return IsInside(cell) && !seen_.contains(SeenKey(cell));
}

}  // namespace isotherm
