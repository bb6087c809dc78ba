#include "ground/snapshot/model_copy.h"

#include <algorithm>
#include <utility>

namespace isotherm {

ModelCopy::OwnVolumes& ModelCopy::VolumesOf(const BlockBatch& batch) {
  OwnVolumes& own = own_[static_cast<std::size_t>(batch.map)];
  if (own.tsdf) return own;
  own.tsdf = std::make_shared<TsdfVolume>(batch.grid, batch.truncation_distance_m,
                                          std::max(1, batch.max_blocks));
  own.thermal = std::make_shared<ThermalVolume>(std::max(1, batch.max_blocks));
  ReadableMap& map = maps_[static_cast<std::size_t>(batch.map)];
  map.tsdf = own.tsdf;
  map.thermal = own.thermal;
  return own;
}

bool ModelCopy::Apply(const BlockBatch& batch) {
  if (batch.scan != scan_) {
    maps_.clear();
    own_.clear();
    scan_ = batch.scan;
  }
  if (maps_.size() > batch.maps.size()) {  // Sub-maps became one model.
    maps_.clear();
    own_.clear();
  }
  maps_.resize(batch.maps.size());
  own_.resize(batch.maps.size());
  for (std::size_t i = 0; i < maps_.size(); ++i) maps_[i].place = batch.maps[i];
  active_map_ = batch.active_map;
  if (batch.blocks.empty()) return true;
  OwnVolumes& own = VolumesOf(batch);
  std::size_t voxel = 0;
  std::size_t row = 0;
  bool has_room = true;
  for (const CopiedBlock& copied : batch.blocks) {
    const std::int32_t block = own.tsdf->FindOrAllocate(copied.coordinates);
    const bool fits = block != TsdfVolume::kNoBlock && own.thermal->Commit(own.tsdf->block_count());
    if (fits) {
      std::copy_n(batch.tsdf.begin() + static_cast<std::ptrdiff_t>(voxel), kBlockVoxels,
                  own.tsdf->voxels(block).begin());
      std::copy_n(batch.thermal.begin() + static_cast<std::ptrdiff_t>(voxel), kBlockVoxels,
                  own.thermal->voxels(block).begin());
      own.tsdf->set_may_end_rays(block, copied.may_end_rays);
      for (std::int32_t i = 0; i < copied.rows; ++i) {
        const CopiedRow& from = batch.rows[row + static_cast<std::size_t>(i)];
        own.thermal->records()->Row(block, from.row) = from.record;
        std::copy_n(from.sigmas, RecordRow::kVoxels,
                    own.thermal->records()->Sigmas(block, from.row));
      }
    }
    has_room = has_room && fits;
    voxel += kBlockVoxels;
    row += static_cast<std::size_t>(copied.rows);
  }
  return has_room;
}

void ModelCopy::Adopt(std::uint64_t scan, std::vector<ReadableMap> maps) {
  scan_ = scan;
  maps_ = std::move(maps);
  own_.assign(maps_.size(), {});
  active_map_ = 0;
}

}  // namespace isotherm
