#include "ground/feedback/tried_surface.h"

#include <cmath>

namespace isotherm {
namespace {

/// Side of the cells, larger than the distance between the rays of a look (a centimetre), so that
/// each look meets each cell.
constexpr double kTriedCell_m = 0.016;

/// Looks after which surface that is not measured well will not be: half a second of feedback.
/// Fewer: what one shutter event or one smeared frame kept from being measured is given up; more:
/// the rig stands before edges that are too steep. Not tuned.
constexpr int kEnoughLooks = 5;

/// A cell in which nothing was lacking for this many looks is well.
constexpr int kLooksBetween = 2;

std::uint64_t Key(const Eigen::Vector3d& p_map) {
  // Indices may be negative: their lowest 21 bits tell 2^21 cells apart, which is 31 km.
  constexpr int kBitsPerAxis = 21;
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::int64_t>(std::floor(p_map[axis] / kTriedCell_m));
    key = (key << kBitsPerAxis) |
          (static_cast<std::uint64_t>(index) & ((std::uint64_t{1} << kBitsPerAxis) - 1));
  }
  return key;
}

}  // namespace

void TriedSurface::Note(const Eigen::Vector3d& p_map, std::uint64_t piece, bool is_well) {
  const std::uint64_t key = Key(p_map);
  const auto found = cells_.find(key);
  if (found == cells_.end()) {
    if (!is_well) cells_[key] = {piece, 1, look_};
    return;
  }
  Cell& cell = found->second;
  if (!is_well) {
    if (cell.last_look == look_) return;
    cell.last_look = look_;
    if (++cell.looks == kEnoughLooks) ++vain_[cell.piece];
    return;
  }
  // At the border of what is well there are points of both kinds in one cell.
  if (look_ - cell.last_look < kLooksBetween) return;
  if (cell.looks >= kEnoughLooks) --vain_[cell.piece];
  cells_.erase(found);
}

bool TriedSurface::IsVain(const Eigen::Vector3d& p_map) const {
  const auto found = cells_.find(Key(p_map));
  return found != cells_.end() && found->second.looks >= kEnoughLooks;
}

double TriedSurface::VainArea(std::uint64_t piece) const {
  const auto found = vain_.find(piece);
  return found == vain_.end() ? 0.0 : kTriedCell_m * kTriedCell_m * found->second;
}

}  // namespace isotherm
