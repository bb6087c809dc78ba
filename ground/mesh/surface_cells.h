#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "ground/mesh/marching_cubes.h"
#include "ground/mesh/surface.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// The crossings that start in one block. `keys` is ascending and parallel to `points`.
struct BlockCrossings {
  std::vector<std::uint16_t> keys;
  std::vector<CloudPoint> points;
  std::uint32_t first = 0;  ///< Index of points[0] among all points.
};

/// Distances of a block and the first layer of its upper neighbours, x fastest; NaN where the
/// weight is too small.
struct BlockSamples {
  static constexpr int kSide = kBlockSide + 1;

  static std::size_t Index(const GridIndex& local) {
    return static_cast<std::size_t>(local.x() + kSide * (local.y() + kSide * local.z()));
  }
  float At(const GridIndex& local) const { return values[Index(local)]; }

  std::array<float, kSide * kSide * kSide> values;
};

/// Says which voxels of a block are asked for, by their place: bit `o` stands for those whose
/// coordinates are 0 along each axis whose bit is set in `o` (1 x, 2 y, 4 z). Bit 0: all of them.
using VoxelLayers = std::uint8_t;
inline constexpr VoxelLayers kWholeBlock = 1;

/// Holds what a block contributes to the surface of a model: where edges between neighbouring
/// voxels are crossed, and which cubes are cut. Refers to the volumes. Thread-compatible; const
/// calls may run on several threads.
class SurfaceCells {
 public:
  SurfaceCells(const TsdfVolume& tsdf, const ThermalVolume& thermal, const SurfaceOptions& options)
      : tsdf_(tsdf),
        thermal_(thermal),
        options_(options),
        voxels_per_unit_(
            static_cast<float>(tsdf.truncation_distance_m() / tsdf.grid().voxel_size_m)) {}

  /// Returns false if no surface can pass through the block.
  bool Gather(std::int32_t block, BlockSamples& samples) const;
  /// Appends the crossings on edges that start at the voxels asked for.
  void FindCrossings(std::int32_t block, VoxelLayers layers, BlockCrossings& result) const;

  /// Number of an edge within its block: it belongs to the block and voxel where it starts.
  static std::uint16_t EdgeKey(const GridIndex& local, int axis) {
    return static_cast<std::uint16_t>(
        3 * (local.x() + kBlockSide * (local.y() + kBlockSide * local.z())) + axis);
  }
  /// Returns which corners of the cube at `local` are inside; nullopt if one is not observed well
  /// enough.
  static std::optional<int> CornersInside(const BlockSamples& samples, const GridIndex& local);

 private:
  float Sample(const TsdfVoxel& voxel) const {
    return voxel.observed() && voxel.weight() >= options_.min_weight ? voxel.tsdf() : NAN;
  }
  float SampleAt(const GridIndex& voxel) const { return Sample(tsdf_.VoxelAt(voxel)); }
  /// Distances in voxel sizes, from distances in truncation distances.
  float InVoxels(float tsdf) const { return tsdf * voxels_per_unit_; }
  bool Crosses(float a, float b) const;
  /// Gradient by central differences, one-sided beside unobserved voxels, 0 between two of them.
  Eigen::Vector3f Gradient(const GridIndex& voxel) const;
  /// Returns whether the distance grows along `normal` no faster than a distance to a surface can,
  /// one voxel to either side. Unobserved sides pass.
  bool IsGradual(const Eigen::Vector3f& p_voxel, const Eigen::Vector3f& normal) const;
  /// The point `along` (0..1) the edge from `voxel` along `axis`; nullopt if it is not a surface.
  std::optional<CloudPoint> MakePoint(const GridIndex& voxel, int axis, float along) const;

  const TsdfVolume& tsdf_;
  const ThermalVolume& thermal_;
  const SurfaceOptions options_;
  const float voxels_per_unit_;  // Truncation distance in voxels.
};

/// Voxel `i` of a block, 0..511 in the order of the block.
inline GridIndex LocalVoxel(int i) {
  return {i % kBlockSide, i / kBlockSide % kBlockSide, i / (kBlockSide * kBlockSide)};
}

/// Joins crossings to triangles. `find(block, step, key)` returns the index of a crossing of the
/// block `step` beyond `block`, or kNoPoint.
inline constexpr std::uint32_t kNoPoint = ~std::uint32_t{0};

class CubeTriangles {
 public:
  /// Appends the triangles of the cubes that start in a block.
  template <typename FindPoint>
  void Add(const BlockSamples& samples, const FindPoint& find,
           std::vector<Eigen::Vector3i>& triangles) const {
    for (int i = 0; i < kBlockVoxels; ++i) {
      const GridIndex local = LocalVoxel(i);
      if (const std::optional<int> inside = SurfaceCells::CornersInside(samples, local))
        AddCube(local, *inside, find, triangles);
    }
  }

 private:
  template <typename FindPoint>
  void AddCube(const GridIndex& local, int inside, const FindPoint& find,
               std::vector<Eigen::Vector3i>& triangles) const {
    const std::size_t before = triangles.size();
    for (const CubeTriangle& triangle : table_.triangles(inside)) {
      Eigen::Vector3i indices;
      for (int i = 0; i < 3; ++i) {
        const CubeEdge& edge = table_.edges()[triangle[static_cast<std::size_t>(i)]];
        const GridIndex at =
            local + GridIndex(edge.from & 1, edge.from >> 1 & 1, edge.from >> 2 & 1);
        const GridIndex step = at / kBlockSide;
        const std::uint32_t point =
            find(step, SurfaceCells::EdgeKey(at - step * kBlockSide, edge.axis));
        if (point == kNoPoint) {  // A jump, not a surface: leave the whole cube open.
          triangles.resize(before);
          return;
        }
        indices[i] = static_cast<std::int32_t>(point);
      }
      triangles.push_back(indices);
    }
  }

  const MarchingCubesTable table_;
};

/// Returns the index of a crossing among all points; kNoPoint if there is none.
std::uint32_t FindCrossing(const BlockCrossings& crossings, std::uint16_t key);

}  // namespace isotherm
