#include "ground/feedback/scan_coverage.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

/// Two sub-maps have the same surface where both have some within this many voxels along its
/// normal: they fit within a voxel or two where loops are closed, and a surface may lie just at the
/// border of a block.
constexpr double kApart_vox = 1.5;
/// The same, if it faces the same way (cosine): the other side of a sheet is another surface.
constexpr double kSameSide = 0.7;
/// The same, if the other block has this fraction of its area at least: less is the end of a
/// surface that the other sub-map hardly saw. Grids do not coincide, so a block of one has a
/// quarter of its area in a block of the other and more. At such an end up to the rest of a block
/// counts as the other sub-map has it. Not tuned.
constexpr double kEnoughOfIt = 0.25;

/// A sub-map that may have the same surface as another one.
struct Neighbour {
  const ModelCoverage& coverage;
  const TsdfVolume& tsdf;
  RigidTransform T_neighbour_map;  ///< From the coordinates of the other one.
  bool counts_first;               ///< Surface that both have counts in the neighbour.
};

/// Returns what a neighbour has of a surface; nullptr if it has none of it.
const BlockSurface* SameSurface(const Neighbour& neighbour, const BlockSurface& surface) {
  const double area_m2 = surface.areas.total_m2();
  const Eigen::Vector3d p = neighbour.T_neighbour_map * (surface.position / area_m2);
  const Eigen::Vector3d n = neighbour.T_neighbour_map.linear() * surface.normal.normalized();
  const double step_m = kApart_vox * neighbour.tsdf.grid().voxel_size_m;
  for (const double offset_m : {0.0, step_m, -step_m}) {
    const BlockSurface* other = neighbour.coverage.SurfaceAt(neighbour.tsdf, p + offset_m * n);
    if (other == nullptr || other->normal.isZero()) continue;
    if (other->areas.total_m2() >= kEnoughOfIt * area_m2 &&
        other->normal.dot(n) >= kSameSide * other->normal.norm()) {
      return other;
    }
  }
  return nullptr;
}

}  // namespace

void ScanCoverage::Compare(const Atlas& atlas, int map, int max_blocks) {
  std::vector<Neighbour> neighbours;
  for (const auto& [other, part] : parts_) {
    if (other == map || !atlas.map(other).joined || !atlas.map(map).joined) continue;
    const bool counts_first = map != active_ && (other == active_ || other < map);
    neighbours.push_back({part.coverage, *atlas.map(other).tsdf,
                          atlas.map(other).T_world_map.inverse() * atlas.map(map).T_world_map,
                          counts_first});
  }
  parts_.at(map).coverage.Compare(
      *atlas.map(map).tsdf, max_blocks, [&](const BlockSurface& surface) {
        SharedSurface shared;
        if (surface.normal.isZero()) return shared;
        for (const Neighbour& neighbour : neighbours) {
          const BlockSurface* same = SameSurface(neighbour, surface);
          if (same == nullptr) continue;
          shared.counts_elsewhere |= neighbour.counts_first;
          shared.good_fraction =
              std::max(shared.good_fraction, same->areas.good_m2 / same->areas.total_m2());
        }
        return shared;
      });
}

void ScanCoverage::NoteChanges(const Atlas& atlas) {
  CHECK(parts_.size() <= static_cast<std::size_t>(atlas.size()));
  std::vector<bool> joined;
  for (int map = 0; map < atlas.size(); ++map) {
    parts_.try_emplace(map, min_weight_);
    joined.push_back(atlas.map(map).joined);
  }
  if (active_ == atlas.active_index() && joined_ == joined) return;
  // A turn may be under way: the second that ends from now on had all blocks.
  constexpr int kWholeTurn = 2;
  Part& left = parts_.at(active_);
  if (active_ != atlas.active_index()) left.turns_wanted = left.coverage.turns() + kWholeTurn;
  for (auto& [map, part] : parts_)
    part.turns_compared_wanted = part.coverage.turns_compared() + kWholeTurn;
  active_ = atlas.active_index();
  joined_ = std::move(joined);
}

void ScanCoverage::Update(const Atlas& atlas, const IsSpilled& is_spilled, int max_blocks,
                          ThreadPool& pool) {
  const auto measure = [&](int map) {
    const TsdfVolume& tsdf = *atlas.map(map).tsdf;
    parts_.at(map).coverage.Update(
        tsdf, *atlas.map(map).thermal, [&](std::int32_t block) { return is_spilled(tsdf, block); },
        max_blocks, pool);
  };
  NoteChanges(atlas);
  measure(active_);
  if (parts_.size() > 1) {
    Compare(atlas, active_, max_blocks);
    auto next = parts_.upper_bound(next_map_);
    if (next == parts_.end()) next = parts_.begin();
    if (next->first == active_ && ++next == parts_.end()) next = parts_.begin();
    next_map_ = next->first;
    if (next->second.coverage.turns() < next->second.turns_wanted) measure(next_map_);
    Compare(atlas, next_map_, max_blocks);
  }
  for (auto& [map, part] : parts_) {
    part.counts = map == active_ || joined_[static_cast<std::size_t>(map)];
    part.is_known =
        atlas.map(map).tsdf->block_count() == 0 ||
        (part.coverage.turns() >= part.turns_wanted &&
         (parts_.size() == 1 || part.coverage.turns_compared() >= part.turns_compared_wanted));
  }
}

SurfaceAreas ScanCoverage::areas() const {
  SurfaceAreas sum;
  ForEachThatCounts([&](int, const ModelCoverage& coverage) { sum += coverage.areas(); });
  return sum;
}

bool ScanCoverage::complete() const {
  return !parts_.empty() && std::ranges::all_of(parts_, [](const auto& part) {
    return part.second.is_known || !part.second.counts;
  });
}

const ModelCoverage* ScanCoverage::Find(int map) const {
  const auto part = parts_.find(map);
  return part == parts_.end() ? nullptr : &part->second.coverage;
}

}  // namespace isotherm
