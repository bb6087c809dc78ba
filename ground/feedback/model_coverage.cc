#include "ground/feedback/model_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ground/tsdf/voxel_layout.h"

namespace isotherm {
namespace {

/// Change of the distance from voxel to voxel, in voxels, beyond which a change of sign is no
/// surface (SurfaceOptions::max_slope).
constexpr float kMaxSlope = 3.0F;

/// Cells of this many blocks (4 x 4 x 4, 6 cm at voxels of 2 mm) gather what is lacking: about the
/// surface that one view aims at. Smaller: thousands of targets; larger: faces of several
/// directions average out to none. Not tuned.
constexpr int kCellShift = 2;

/// Blocks that are looked at for each one that has a surface to measure, at most: most blocks have
/// none, and a large model of free space must not take a message's time.
constexpr int kMaxVisitedPerMeasured = 16;

/// Below it a cell is empty: sums of areas that are added and taken off again leave this much by
/// rounding.
constexpr double kNoArea_m2 = 1e-9;

GridIndex BlockAt(const VoxelGrid& grid, const Eigen::Vector3d& p_map) {
  return ((p_map - grid.min_m) / grid.block_size_m()).array().floor().matrix().cast<int>();
}

GridIndex Along(int axis) { return GridIndex::Unit(axis); }

/// A block and the three that follow it along the axes, for pairs of neighbouring voxels.
class PairReader {
 public:
  PairReader(const TsdfVolume& tsdf, const ThermalVolume& thermal, std::int32_t block,
             float min_weight)
      : tsdf_(tsdf),
        thermal_(thermal),
        min_weight_(std::max(
            1U, static_cast<std::uint32_t>(std::ceil(min_weight * TsdfVoxel::kWeightScale)))) {
    const GridIndex& at = tsdf.block_coordinates(block);
    blocks_ = {block, tsdf.Find(at + Along(0)), tsdf.Find(at + Along(1)), tsdf.Find(at + Along(2))};
  }

  /// A voxel of the block, or one step beyond its end along one axis.
  struct Place {
    std::int32_t block;
    int local;
  };
  Place At(const GridIndex& local) const {
    return {blocks_[0], local.x() + kBlockSide * (local.y() + kBlockSide * local.z())};
  }
  Place Next(const GridIndex& local, int axis) const {
    GridIndex next = local;
    const bool beyond = ++next[axis] == kBlockSide;
    if (beyond) next[axis] = 0;
    Place place = At(next);
    if (beyond) place.block = blocks_[static_cast<std::size_t>(axis) + 1];
    return place;
  }
  /// NaN where nothing was observed.
  float Distance(const Place& place) const {
    if (place.block == TsdfVolume::kNoBlock) return NAN;
    const TsdfVoxel voxel = tsdf_.voxels(place.block)[static_cast<std::size_t>(place.local)];
    return TsdfLayout::WeightCode(voxel.bits) >= min_weight_ ? voxel.tsdf() : NAN;
  }
  ThermalVoxel Thermal(const Place& place) const {
    return thermal_.voxels(place.block)[static_cast<std::size_t>(place.local)];
  }

 private:
  const TsdfVolume& tsdf_;
  const ThermalVolume& thermal_;
  const std::uint32_t min_weight_;
  std::array<std::int32_t, 4> blocks_;
};

/// False if no pair of MeasureBlock() can change sign.
bool MayHaveSurface(const TsdfVolume& tsdf, std::int32_t block) {
  if (tsdf.may_end_rays(block)) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t next = tsdf.Find(tsdf.block_coordinates(block) + Along(axis));
    if (next != TsdfVolume::kNoBlock && tsdf.may_end_rays(next)) return true;
  }
  return false;
}

/// The cell that a block belongs to, one for each direction that surfaces face.
std::uint64_t CellKey(const GridIndex& block, const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto side = static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.0 ? 1 : 0));
  std::uint64_t key = side;
  for (int i = 0; i < 3; ++i) {
    constexpr int kBitsPerAxis = 20;
    key = (key << kBitsPerAxis) | static_cast<std::uint64_t>(block[i] >> kCellShift);
  }
  return key;
}

/// Returns a block's surface as it counts, with what other sub-maps have of it.
BlockSurface Counted(BlockSurface surface, const SharedSurface& elsewhere) {
  if (elsewhere.counts_elsewhere) return {};
  const double total_m2 = surface.areas.total_m2();
  const double lacking_m2 = surface.lacking_m2();
  const double lacking_in_all_m2 = (1.0 - elsewhere.good_fraction) * total_m2;
  if (lacking_in_all_m2 >= lacking_m2) return surface;
  const double scale = lacking_in_all_m2 / lacking_m2;
  surface.areas.acceptable_m2 *= scale;
  surface.areas.bad_m2 *= scale;
  surface.areas.never_m2 *= scale;
  surface.areas.good_m2 = total_m2 - lacking_in_all_m2;
  surface.lacking_position *= scale;
  surface.lacking_normal *= scale;
  return surface;
}

}  // namespace

std::uint64_t PieceOf(const VoxelGrid& grid, const Eigen::Vector3d& p_map,
                      const Eigen::Vector3d& normal_map) {
  return CellKey(BlockAt(grid, p_map), normal_map);
}

void SurfaceAreas::Add(MeasurementQuality quality, double area_m2) {
  switch (quality) {
    case MeasurementQuality::kGood:
      good_m2 += area_m2;
      return;
    case MeasurementQuality::kAcceptable:
      acceptable_m2 += area_m2;
      return;
    case MeasurementQuality::kBad:
      bad_m2 += area_m2;
      return;
    case MeasurementQuality::kNever:
      never_m2 += area_m2;
      return;
  }
}

SurfaceAreas& SurfaceAreas::operator+=(const SurfaceAreas& other) {
  good_m2 += other.good_m2;
  acceptable_m2 += other.acceptable_m2;
  bad_m2 += other.bad_m2;
  never_m2 += other.never_m2;
  return *this;
}

SurfaceAreas& SurfaceAreas::operator-=(const SurfaceAreas& other) {
  good_m2 -= other.good_m2;
  acceptable_m2 -= other.acceptable_m2;
  bad_m2 -= other.bad_m2;
  never_m2 -= other.never_m2;
  return *this;
}

BlockSurface MeasureBlock(const TsdfVolume& tsdf, const ThermalVolume& thermal, std::int32_t block,
                          float min_weight) {
  const VoxelGrid& grid = tsdf.grid();
  const PairReader pairs(tsdf, thermal, block, min_weight);
  const auto max_change =
      static_cast<float>(kMaxSlope * grid.voxel_size_m / tsdf.truncation_distance_m());
  const double voxel_area_m2 = grid.voxel_size_m * grid.voxel_size_m;
  BlockSurface surface;
  for (int i = 0; i < kBlockVoxels; ++i) {
    const GridIndex local(BlockLayout::X(i), BlockLayout::Y(i), BlockLayout::Z(i));
    const PairReader::Place here = pairs.At(local);
    const float distance = pairs.Distance(here);
    if (!(std::abs(distance) < max_change)) continue;  // Nor if it was never observed.
    std::array<PairReader::Place, 3> next;
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    std::array<bool, 3> crosses{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      next[a] = pairs.Next(local, axis);
      const float change = pairs.Distance(next[a]) - distance;
      if (!(std::abs(change) <= max_change)) continue;
      gradient[axis] = change;
      crosses[a] = (distance <= 0.0F) != (distance + change <= 0.0F);
    }
    const float length = gradient.norm();
    if (!(length > 0.0F)) continue;
    // A plane of area A with normal n crosses A (|nx| + |ny| + |nz|) / h^2 edges.
    const Eigen::Vector3d normal = (gradient / length).cast<double>();
    const double area_m2 = voxel_area_m2 / normal.lpNorm<1>();
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (!crosses[a]) continue;
      const bool nearer = std::abs(distance) <= std::abs(distance + gradient[axis]);
      ThermalVoxel voxel = pairs.Thermal(nearer ? here : next[a]);
      // The surface lies between two voxels; its temperature may be kept by either.
      if (!voxel.assessed()) voxel = pairs.Thermal(nearer ? next[a] : here);
      const MeasurementQuality quality = voxel.quality();
      const Eigen::Vector3d at =
          area_m2 * grid.VoxelCentre(tsdf.block_coordinates(block) * kBlockSide + local);
      surface.areas.Add(quality, area_m2);
      surface.position += at;
      surface.normal += area_m2 * normal;
      if (quality == MeasurementQuality::kGood) continue;
      surface.lacking_position += at;
      surface.lacking_normal += area_m2 * normal;
    }
  }
  return surface;
}

void ModelCoverage::AddToCell(const GridIndex& block, const BlockSurface& surface, double sign) {
  if (!(surface.lacking_m2() > 0.0) || surface.lacking_normal.isZero()) return;
  const std::uint64_t key = CellKey(block, surface.lacking_normal);
  Cell& cell = cells_[key];
  cell.area_m2 += sign * surface.lacking_m2();
  cell.position += sign * surface.lacking_position;
  cell.normal += sign * surface.lacking_normal;
  if (cell.area_m2 < kNoArea_m2) cells_.erase(key);
}

void ModelCoverage::Replace(std::int32_t block, const GridIndex& at, const Block& now) {
  Block& known = blocks_[static_cast<std::size_t>(block)];
  // Sums are kept by differences: what a block had goes before what it has now comes, and no
  // message walks over all blocks.
  const BlockSurface before = Counted(known.surface, known.elsewhere);
  areas_ -= before.areas;
  AddToCell(at, before, -1.0);
  known = now;
  const BlockSurface counted = Counted(known.surface, known.elsewhere);
  areas_ += counted.areas;
  AddToCell(at, counted, 1.0);
}

void ModelCoverage::Compare(
    const TsdfVolume& tsdf, int max_blocks,
    const std::function<SharedSurface(const BlockSurface& surface)>& elsewhere) {
  const auto count = static_cast<std::int32_t>(blocks_.size());
  for (std::int32_t i = 0; i < std::min(count, max_blocks); ++i) {
    const std::int32_t block = next_to_compare_;
    if (++next_to_compare_ >= count) {
      next_to_compare_ = 0;
      ++turns_compared_;
    }
    const BlockSurface& surface = blocks_[static_cast<std::size_t>(block)].surface;
    if (!(surface.areas.total_m2() > 0.0)) continue;
    Replace(block, tsdf.block_coordinates(block), {surface, elsewhere(surface)});
  }
}

const BlockSurface* ModelCoverage::SurfaceAt(const TsdfVolume& tsdf,
                                             const Eigen::Vector3d& p_map) const {
  const std::int32_t block = tsdf.Find(BlockAt(tsdf.grid(), p_map));
  if (block == TsdfVolume::kNoBlock || block >= static_cast<std::int32_t>(blocks_.size()))
    return nullptr;
  const BlockSurface& surface = blocks_[static_cast<std::size_t>(block)].surface;
  return surface.areas.total_m2() > 0.0 ? &surface : nullptr;
}

void ModelCoverage::Update(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                           const std::function<bool(std::int32_t block)>& is_spilled,
                           int max_blocks, ThreadPool& pool) {
  const std::int32_t count = tsdf.block_count();
  blocks_.resize(static_cast<std::size_t>(count));
  chosen_.clear();
  const std::int64_t max_visited = std::int64_t{kMaxVisitedPerMeasured} * max_blocks;
  for (std::int64_t i = 0; i < std::min<std::int64_t>(count, max_visited); ++i) {
    if (static_cast<int>(chosen_.size()) == max_blocks) break;
    const std::int32_t block = next_;
    if (++next_ >= count) {
      next_ = 0;
      ++turns_;
    }
    if (is_spilled(block)) continue;
    if (MayHaveSurface(tsdf, block)) {
      chosen_.push_back(block);
    } else if (blocks_[static_cast<std::size_t>(block)].surface.areas.total_m2() > 0.0) {
      Replace(block, tsdf.block_coordinates(block), {});
    }
  }
  measured_.resize(chosen_.size());
  // A frame changes hundreds of blocks: enough tasks for all threads, few enough to hand out. Not
  // tuned.
  constexpr int kBlocksPerTask = 32;
  const int chosen = static_cast<int>(chosen_.size());
  pool.ParallelFor((chosen + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(chosen, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      measured_[k] = MeasureBlock(tsdf, thermal, chosen_[k], min_weight_);
    }
  });
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const SharedSurface elsewhere = blocks_[static_cast<std::size_t>(chosen_[k])].elsewhere;
    Replace(chosen_[k], tsdf.block_coordinates(chosen_[k]), {measured_[k], elsewhere});
  }
}

double ModelCoverage::LackingArea(std::uint64_t cell) const {
  const auto found = cells_.find(cell);
  return found == cells_.end() ? 0.0 : found->second.area_m2;
}

std::vector<LackingSurface> ModelCoverage::Lacking(
    std::size_t max_count,
    const std::function<bool(std::uint64_t cell, double area_m2)>& wanted) const {
  std::vector<std::pair<double, std::uint64_t>> largest;  // Negative area and key: a fixed order.
  largest.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) {
    if (!wanted || wanted(key, cell.area_m2)) largest.emplace_back(-cell.area_m2, key);
  }
  const auto end =
      largest.begin() + static_cast<std::ptrdiff_t>(std::min(max_count, largest.size()));
  std::partial_sort(largest.begin(), end, largest.end());
  std::vector<LackingSurface> lacking;
  for (auto entry = largest.begin(); entry != end; ++entry) {
    const Cell& cell = cells_.at(entry->second);
    const double length = cell.normal.norm();
    if (!(length > 0.0)) continue;
    lacking.push_back(
        {entry->second, cell.position / cell.area_m2, cell.normal / length, cell.area_m2});
  }
  return lacking;
}

}  // namespace isotherm
