#include "ground/snapshot/model_copier.h"

#include <algorithm>

namespace isotherm {
namespace {

/// Between two looks at the clock.
constexpr std::int32_t kBlocksPerLook = 8;

void CopyRows(const ThermalRecords& records, std::int32_t block, CopiedBlock& copied,
              BlockBatch& batch) {
  for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
    const RecordRow* record = records.Find(block, row);
    if (record == nullptr) continue;
    CopiedRow& target = batch.rows.emplace_back();
    target.row = row;
    target.record = *record;
    std::copy_n(records.FindSigmas(block, row), RecordRow::kVoxels, target.sigmas);
    ++copied.rows;
  }
}

void CopyBlock(const SubMap& map, std::int32_t block, BlockBatch& batch) {
  const auto tsdf = map.tsdf->voxels(block);
  const auto thermal = std::as_const(*map.thermal).voxels(block);
  batch.tsdf.insert(batch.tsdf.end(), tsdf.begin(), tsdf.end());
  batch.thermal.insert(batch.thermal.end(), thermal.begin(), thermal.end());
  CopiedBlock& copied = batch.blocks.emplace_back();
  copied.coordinates = map.tsdf->block_coordinates(block);
  copied.may_end_rays = map.tsdf->may_end_rays(block);
  if (const ThermalRecords* records = std::as_const(*map.thermal).records())
    CopyRows(*records, block, copied, batch);
}

}  // namespace

/// One call of Copy: what is left of its budget.
class ModelCopier::Turn {
 public:
  Turn(const Clock& clock, const CopyBudget& budget, const RigidTransform& T_map_depth,
       BlockBatch& batch)
      : clock_(clock),
        budget_(budget),
        rig_m_(T_map_depth.translation()),
        end_(clock.SteadyNow() + budget.time),
        batch_(batch) {}

  bool is_over() {
    const auto count = static_cast<std::int32_t>(batch_.blocks.size());
    if (count >= budget_.max_blocks) return true;
    return count % kBlocksPerLook == 0 && count > 0 && clock_.SteadyNow() >= end_;
  }
  /// Copies a block if it has changed and is within reach.
  void Offer(const SubMap& map, std::int32_t block, std::uint32_t& copied) {
    const std::uint32_t version = map.versions.At(block);
    if (version == copied || !IsNear(*map.tsdf, block)) return;
    CopyBlock(map, block, batch_);
    copied = version;
  }
  bool has_any() const { return !batch_.blocks.empty(); }

 private:
  bool IsNear(const TsdfVolume& tsdf, std::int32_t block) const {
    if (budget_.reach_m == std::numeric_limits<double>::infinity()) return true;
    const GridIndex corner = tsdf.block_coordinates(block) * kBlockSide;
    return (tsdf.grid().VoxelCentre(corner) - rig_m_).norm() <= budget_.reach_m;
  }

  const Clock& clock_;
  const CopyBudget& budget_;
  const Eigen::Vector3d rig_m_;
  const SteadyTime end_;
  BlockBatch& batch_;
};

void ModelCopier::Begin(std::uint64_t scan) {
  scan_ = scan;
  maps_.clear();
}

bool ModelCopier::Copy(const Atlas& atlas, const RigidTransform& T_map_depth,
                       const CopyBudget& budget, BlockBatch& batch) {
  batch.Clear();
  batch.scan = scan_;
  batch.grid = atlas.active().tsdf->grid();
  batch.truncation_distance_m = atlas.active().tsdf->truncation_distance_m();
  batch.active_map = atlas.active_index();
  for (int i = 0; i < atlas.size(); ++i)
    batch.maps.push_back({atlas.map(i).T_world_map, atlas.map(i).joined});
  maps_.resize(static_cast<std::size_t>(atlas.size()));
  Turn turn(clock_, budget, T_map_depth, batch);
  for (int i = 0; i < atlas.size() && !turn.has_any(); ++i) {
    const int map = (atlas.active_index() + i) % atlas.size();
    batch.map = map;
    batch.max_blocks = atlas.map(map).tsdf->max_blocks();
    if (CopyMap(atlas.map(map), maps_[static_cast<std::size_t>(map)], turn)) return true;
  }
  return turn.has_any();
}

bool ModelCopier::CopyMap(const SubMap& map, MapState& state, Turn& turn) {
  const std::int32_t count = map.tsdf->block_count();
  state.copied.resize(static_cast<std::size_t>(count), 0);
  const auto copied = [&](std::int32_t block) -> std::uint32_t& {
    return state.copied[static_cast<std::size_t>(block)];
  };
  while (state.never_copied_above < count && copied(state.never_copied_above) != 0)
    ++state.never_copied_above;
  for (std::int32_t block = count - 1; block >= state.never_copied_above; --block) {
    if (copied(block) != 0) continue;
    turn.Offer(map, block, copied(block));
    if (turn.is_over()) return true;
  }
  for (std::int32_t i = 0; i < count; ++i) {
    if (state.cursor >= count) state.cursor = 0;
    const std::int32_t block = state.cursor++;
    if (copied(block) == 0) continue;
    turn.Offer(map, block, copied(block));
    if (turn.is_over()) return true;
  }
  return turn.has_any();
}

}  // namespace isotherm
