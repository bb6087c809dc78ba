#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/time/time_types.h"
#include "ground/surface/voxel_grid.h"
#include "ground/thermal/thermal_records.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A block of a batch; its voxels stand in the batch's arrays, in the order of the blocks.
struct CopiedBlock {
  GridIndex coordinates = GridIndex::Zero();
  std::int32_t rows = 0;  ///< How many of the batch's rows are of this block.
  bool may_end_rays = true;
};

/// A row of records of a block.
struct CopiedRow {
  int row = 0;
  RecordRow record;
  std::uint8_t sigmas[RecordRow::kVoxels] = {};
};

/// Where a sub-map is.
struct CopiedMap {
  RigidTransform T_world_map = RigidTransform::Identity();
  bool joined = false;
};

/// Blocks of one sub-map as they were between two frames, on their way from the thread that
/// changes the model to one that reads it. Memory is kept for the next use.
struct BlockBatch {
  std::uint64_t scan = 0;  ///< Counts the scans of this process, from 1.
  VoxelGrid grid;
  double truncation_distance_m = 0.0;
  std::int32_t max_blocks = 0;  ///< The volume may come to have so many.
  CaptureTime capture_time{};   ///< The depth frame's after which they were copied.
  int map = 0;                  ///< The sub-map of the blocks.
  int active_map = 0;
  std::vector<CopiedMap> maps;  ///< All sub-maps.
  std::vector<CopiedBlock> blocks;
  std::vector<TsdfVoxel> tsdf;        ///< kBlockVoxels per block.
  std::vector<ThermalVoxel> thermal;  ///< kBlockVoxels per block.
  std::vector<CopiedRow> rows;

  void Clear() {
    maps.clear();
    blocks.clear();
    tsdf.clear();
    thermal.clear();
    rows.clear();
  }
};

}  // namespace isotherm
