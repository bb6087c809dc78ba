#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
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

/// Says what eight neighbouring voxels along x are, a byte each, the first lowest: most places are
/// not cut by the surface, and are passed over eight at a time.
using SignRow = std::uint64_t;
inline constexpr SignRow kInsideBits = 0x0101010101010101;  ///< Distance < 0.
inline constexpr int kUnobservedBit = 1;                    ///< Weight too small; not inside.

/// Says what the voxels of a block and the first layer of its upper neighbours are, x fastest.
struct BlockSigns {
  static constexpr int kSide = kBlockSide + 1;

  static std::size_t Index(const GridIndex& local) {
    return static_cast<std::size_t>(local.x() + kSide * (local.y() + kSide * local.z()));
  }
  /// Returns the eight that begin at `local`.
  SignRow Row(const GridIndex& local) const {
    SignRow row = 0;
    std::memcpy(&row, bytes.data() + Index(local), sizeof(row));
    return row;
  }

  std::array<std::uint8_t, kSide * kSide * kSide> bytes;
};
static_assert(kBlockSide == sizeof(SignRow) && std::endian::native == std::endian::little);

/// Calls `visit(x)` for each byte whose lowest bit is set, in ascending order.
template <typename Visit>
void VisitBytes(SignRow lowest_bits, const Visit& visit) {
  constexpr int kBitsPerByte = 8;
  for (; lowest_bits != 0; lowest_bits &= lowest_bits - 1)
    visit(std::countr_zero(lowest_bits) / kBitsPerByte);
}

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
        min_weight_code_(
            std::max(1, static_cast<int>(std::ceil(options.min_weight * TsdfVoxel::kWeightScale)))),
        voxels_per_unit_(
            static_cast<float>(tsdf.truncation_distance_m() / tsdf.grid().voxel_size_m)) {}

  /// Returns false if no surface can pass through the block.
  bool Gather(std::int32_t block, BlockSigns& signs) const;
  /// Appends the crossings on edges that start at the voxels asked for.
  void FindCrossings(std::int32_t block, VoxelLayers layers, BlockCrossings& result) const;

  /// Number of an edge within its block: it belongs to the block and voxel where it starts.
  static std::uint16_t EdgeKey(const GridIndex& local, int axis) {
    return static_cast<std::uint16_t>(
        3 * (local.x() + kBlockSide * (local.y() + kBlockSide * local.z())) + axis);
  }

 private:
  /// Notes what kCount voxels along x are, from `index` on. Returns that, joined by or.
  template <int kCount>
  std::uint8_t GatherRow(const TsdfVoxel* voxels, std::size_t index, BlockSigns& signs) const;
  float Sample(const TsdfVoxel& voxel) const {
    return voxel.observed() && voxel.weight() >= options_.min_weight ? voxel.tsdf() : NAN;
  }
  float SampleAt(const GridIndex& voxel) const { return Sample(tsdf_.VoxelAt(voxel)); }
  /// Distances in voxel sizes, from distances in truncation distances.
  float InVoxels(float tsdf) const { return tsdf * voxels_per_unit_; }
  /// Appends the crossing on the edge from `local` along `axis`, on which the sign changes, if it
  /// is a surface.
  void AddCrossing(std::int32_t block, const GridIndex& local, int axis,
                   BlockCrossings& result) const;
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
  const int min_weight_code_;    // The least of a voxel that is observed well enough.
  const float voxels_per_unit_;  // Truncation distance in voxels.
};

/// Joins crossings to triangles. `find(block, step, key)` returns the index of a crossing of the
/// block `step` beyond `block`, or kNoPoint.
inline constexpr std::uint32_t kNoPoint = ~std::uint32_t{0};

class CubeTriangles {
 public:
  /// Appends the triangles of the cubes that start in a block.
  template <typename FindPoint>
  void Add(const BlockSigns& signs, const FindPoint& find,
           std::vector<Eigen::Vector3i>& triangles) const {
    constexpr int kRows = kBlockSide * kBlockSide;
    for (int row = 0; row < kRows; ++row) {
      const GridIndex first(0, row % kBlockSide, row / kBlockSide);
      std::array<SignRow, kCubeCorners> corners;
      SignRow any = 0, all = ~SignRow{0};
      for (int corner = 0; corner < kCubeCorners; ++corner) {
        const SignRow row_of_corner =
            signs.Row(first + GridIndex(corner & 1, corner >> 1 & 1, corner >> 2 & 1));
        corners[static_cast<std::size_t>(corner)] = row_of_corner;
        any |= row_of_corner;
        all &= row_of_corner;
      }
      VisitBytes(any & ~all & ~(any >> kUnobservedBit) & kInsideBits, [&](int x) {
        int inside = 0;
        for (std::size_t corner = 0; corner < kCubeCorners; ++corner)
          inside |= static_cast<int>(corners[corner] >> (8 * x) & 1) << corner;
        AddCube({x, first.y(), first.z()}, inside, find, triangles);
      });
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
