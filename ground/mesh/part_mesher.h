#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ground/mesh/surface.h"
#include "ground/mesh/surface_cells.h"

namespace isotherm {

/// Meshes a few blocks of a model at a time, so that a surface can be followed while it grows.
/// Keeps scratch memory. Thread-compatible.
class PartMesher {
 public:
  /// `options.triangles` does not count: parts are triangles.
  explicit PartMesher(const SurfaceOptions& options) : options_(options) {}

  /// Returns the triangles of the cubes that start in `blocks`, with the points that they use: the
  /// very ones that ExtractSurface finds there. Points at the border to other blocks are in the
  /// parts of both sides.
  Surface Extract(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                  std::span<const std::int32_t> blocks);

 private:
  struct Part {
    std::int32_t block = TsdfVolume::kNoBlock;
    VoxelLayers layers = 0;
    BlockCrossings crossings;
  };
  /// The part that stands for a block, made if there is none yet.
  Part& PartOf(std::int32_t block);

  const SurfaceOptions options_;
  const CubeTriangles cubes_;
  std::vector<Part> parts_;  ///< This extraction's: part_count_ of them.
  std::size_t part_count_ = 0;
  std::vector<std::int32_t>
      position_;  ///< Where each block is in parts_; -1 = not in this extraction.
};

}  // namespace isotherm
