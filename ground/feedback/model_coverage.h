#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Holds areas of surface by MeasurementQuality, square metres.
struct SurfaceAreas {
  double good_m2 = 0.0;
  double acceptable_m2 = 0.0;
  double bad_m2 = 0.0;
  double never_m2 = 0.0;

  double total_m2() const { return good_m2 + acceptable_m2 + bad_m2 + never_m2; }
  void Add(MeasurementQuality quality, double area_m2);
  SurfaceAreas& operator+=(const SurfaceAreas& other);
  SurfaceAreas& operator-=(const SurfaceAreas& other);
};

/// Describes the surface within one block. It is where the distance changes sign between
/// neighbouring voxels of which at least the first is the block's. All of it, and what is not
/// measured well, are summed up with their areas as weights, to know where they are and which way
/// they face.
struct BlockSurface {
  SurfaceAreas areas;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< m2 times `map`.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();            ///< m2 times the outward normal.
  Eigen::Vector3d lacking_position = Eigen::Vector3d::Zero();  ///< m2 times `map`.
  Eigen::Vector3d lacking_normal = Eigen::Vector3d::Zero();    ///< m2 times the outward normal.

  double lacking_m2() const { return areas.total_m2() - areas.good_m2; }
};

/// Measures the surface within `block`. Voxels lighter than `min_weight` do not count as observed.
/// By the slope of the distances, the border between free space and what lies unseen behind an edge
/// is told from a surface, as in the exported cloud.
BlockSurface MeasureBlock(const TsdfVolume& tsdf, const ThermalVolume& thermal, std::int32_t block,
                          float min_weight);

/// Says what other sub-maps have of a block's surface.
struct SharedSurface {
  bool counts_elsewhere = false;  ///< One of them counts it, so that here it is not surface.
  double good_fraction = 0.0;     ///< Measured well in the one that measured most of it well.
};

/// Describes a piece of surface, about a hand in size, that is not yet measured well and faces one
/// way.
struct LackingSurface {
  std::uint64_t cell = 0;  ///< Names the piece of the model; the same as the scan goes on.
  Eigen::Vector3d position_map;
  Eigen::Vector3d normal_map;  ///< Unit, towards the free side.
  double area_m2 = 0.0;
};

/// Returns which piece of the model (LackingSurface::cell) a surface point belongs to that faces
/// `normal_map`.
std::uint64_t PieceOf(const VoxelGrid& grid, const Eigen::Vector3d& p_map,
                      const Eigen::Vector3d& normal_map);

/// Knows how well the whole model is measured. It is brought up to date a part at a time, so that
/// it costs the same whatever the model's size. Thread-compatible.
class ModelCoverage {
 public:
  explicit ModelCoverage(float min_weight) : min_weight_(min_weight) {}

  /// Measures the next `max_blocks` blocks with a surface, in turns. Blocks for which `is_spilled`
  /// keep what they had: looking at them would bring them back from the disk.
  void Update(const TsdfVolume& tsdf, const ThermalVolume& thermal,
              const std::function<bool(std::int32_t block)>& is_spilled, int max_blocks,
              ThreadPool& pool);

  /// Asks of the next `max_blocks` blocks, in turns, what other sub-maps have of their surface.
  /// What those measured well counts as measured well here, too.
  void Compare(const TsdfVolume& tsdf, int max_blocks,
               const std::function<SharedSurface(const BlockSurface& surface)>& elsewhere);
  /// Returns the surface of the block at a point, whoever counts it; nullptr if none is known.
  const BlockSurface* SurfaceAt(const TsdfVolume& tsdf, const Eigen::Vector3d& p_map) const;

  const SurfaceAreas& areas() const { return areas_; }
  /// Returns how often Update() came to the end of all blocks, and Compare().
  std::uint64_t turns() const { return turns_; }
  std::uint64_t turns_compared() const { return turns_compared_; }
  /// Returns where most is lacking, largest first, of the cells that are `wanted` (all by default).
  std::vector<LackingSurface> Lacking(
      std::size_t max_count,
      const std::function<bool(std::uint64_t cell, double area_m2)>& wanted = {}) const;
  /// Calls `visit(cell, area_m2)` for each piece with what is lacking there, square metres.
  template <typename Visit>
  void ForEachPiece(const Visit& visit) const {
    for (const auto& [key, cell] : cells_) visit(key, cell.area_m2);
  }
  /// Returns what is lacking in a cell, square metres.
  double LackingArea(std::uint64_t cell) const;

 private:
  /// Sums the surface of one cell.
  struct Cell {
    double area_m2 = 0.0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< As in BlockSurface.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  struct Block {
    BlockSurface surface;
    SharedSurface elsewhere;
  };

  void Replace(std::int32_t block, const GridIndex& at, const Block& now);
  void AddToCell(const GridIndex& block, const BlockSurface& surface, double sign);

  const float min_weight_;
  std::vector<Block> blocks_;
  SurfaceAreas areas_;
  std::unordered_map<std::uint64_t, Cell> cells_;
  std::int32_t next_ = 0;
  std::int32_t next_to_compare_ = 0;
  std::uint64_t turns_ = 0;
  std::uint64_t turns_compared_ = 0;
  std::vector<std::int32_t> chosen_;
  std::vector<BlockSurface> measured_;
};

}  // namespace isotherm
