#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ground/snapshot/block_batch.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A sub-map as a reader has it. The volumes of a scan that has ended may be the scan's own.
struct ReadableMap {
  std::shared_ptr<const TsdfVolume> tsdf;  ///< nullptr: nothing of it is here yet.
  std::shared_ptr<const ThermalVolume> thermal;
  CopiedMap place;
};

/// A model that follows another one by batches. Thread-bound to the reader.
class ModelCopy {
 public:
  /// Takes a batch in. A batch of another scan begins anew. Returns false if there is no room.
  bool Apply(const BlockBatch& batch);
  /// Shows these sub-maps from now on, which no longer change.
  void Adopt(std::uint64_t scan, std::vector<ReadableMap> maps);

  std::uint64_t scan() const { return scan_; }
  int size() const { return static_cast<int>(maps_.size()); }
  const ReadableMap& map(int index) const { return maps_[static_cast<std::size_t>(index)]; }
  int active_map() const { return active_map_; }

 private:
  struct OwnVolumes {
    std::shared_ptr<TsdfVolume> tsdf;
    std::shared_ptr<ThermalVolume> thermal;
  };
  OwnVolumes& VolumesOf(const BlockBatch& batch);

  std::uint64_t scan_ = 0;
  int active_map_ = 0;
  std::vector<ReadableMap> maps_;
  std::vector<OwnVolumes> own_;  ///< Parallel to maps_; empty where they are somebody else's.
};

}  // namespace isotherm
