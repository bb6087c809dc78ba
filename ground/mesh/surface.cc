#include "ground/mesh/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "common/base/check.h"
#include "common/concurrency/thread_pool.h"
#include "ground/mesh/marching_cubes.h"
#include "ground/thermal/condition_record.h"
#include "ground/thermal/temperature_review.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
// A block's voxels and the first layer of its upper neighbours.
constexpr int kSide = kBlockSide + 1;
// Crossings keep this fraction of an edge's length from its ends, so that no triangle has zero
// area. At 2 mm voxels it moves a point by at most 10 um.
constexpr float kEndMargin = 0.005F;

/// Distances of a block and one more layer, x fastest; NaN where the weight is too small.
using Samples = std::array<float, kSide * kSide * kSide>;

std::size_t SampleIndex(const GridIndex& local) {
  return static_cast<std::size_t>(local.x() + kSide * (local.y() + kSide * local.z()));
}

GridIndex LocalVoxel(int i) {
  return {i % kBlockSide, i / kBlockSide % kBlockSide, i / (kBlockSide * kBlockSide)};
}

/// Number of an edge within its block: it belongs to the block and voxel where it starts.
std::uint16_t EdgeKey(const GridIndex& local, int axis) {
  return static_cast<std::uint16_t>(
      3 * (local.x() + kBlockSide * (local.y() + kBlockSide * local.z())) + axis);
}

/// The crossings that start in one block. `keys` is ascending and parallel to `points`.
struct BlockCrossings {
  std::vector<std::uint16_t> keys;
  std::vector<CloudPoint> points;
  std::uint32_t first = 0;  ///< Index of points[0] among all points.
};

/// The passes of one extraction: crossings per block, then points, then triangles between them.
class Extractor {
 public:
  Extractor(const TsdfVolume& tsdf, const ThermalVolume& thermal, const SurfaceOptions& options,
            ThreadPool& threads)
      : tsdf_(tsdf),
        thermal_(thermal),
        options_(options),
        threads_(threads),
        voxels_per_unit_(
            static_cast<float>(tsdf.truncation_distance_m() / tsdf.grid().voxel_size_m)) {}

  Surface Run() {
    SortBlocks();
    crossings_.resize(order_.size());
    threads_.ParallelFor(static_cast<int>(order_.size()), [this](int i) {
      FindCrossings(order_[static_cast<std::size_t>(i)], crossings_[static_cast<std::size_t>(i)]);
    });
    Surface surface;
    CollectPoints(surface);
    if (options_.triangles) CollectTriangles(surface);
    return surface;
  }

 private:
  /// z, then y, then x, whatever the order of allocation was.
  void SortBlocks() {
    order_.resize(static_cast<std::size_t>(tsdf_.block_count()));
    std::iota(order_.begin(), order_.end(), 0);
    std::ranges::sort(order_, [this](std::int32_t a, std::int32_t b) {
      const GridIndex& p = tsdf_.block_coordinates(a);
      const GridIndex& q = tsdf_.block_coordinates(b);
      return std::tuple(p.z(), p.y(), p.x()) < std::tuple(q.z(), q.y(), q.x());
    });
    position_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      position_[static_cast<std::size_t>(order_[i])] = static_cast<std::int32_t>(i);
    }
  }

  float Sample(const TsdfVoxel& voxel) const {
    return voxel.observed() && voxel.weight() >= options_.min_weight ? voxel.tsdf() : kUnknown;
  }

  float SampleAt(const GridIndex& voxel) const { return Sample(tsdf_.VoxelAt(voxel)); }

  /// Returns false if no surface can pass through the block.
  bool Gather(std::int32_t block, Samples& samples) const {
    samples.fill(kUnknown);
    bool inside = false;
    bool outside = false;
    for (int neighbour = 0; neighbour < 8; ++neighbour) {
      const GridIndex offset(neighbour & 1, neighbour >> 1 & 1, neighbour >> 2 & 1);
      const std::int32_t source = tsdf_.Find(tsdf_.block_coordinates(block) + offset);
      if (source == TsdfVolume::kNoBlock) continue;
      const auto voxels = tsdf_.voxels(source);
      // Of an upper neighbour only its first layer is needed.
      const GridIndex count = GridIndex::Constant(kBlockSide) - offset * (kBlockSide - 1);
      for (int z = 0; z < count.z(); ++z) {
        for (int y = 0; y < count.y(); ++y) {
          for (int x = 0; x < count.x(); ++x) {
            const float value =
                Sample(voxels[static_cast<std::size_t>(x + kBlockSide * (y + kBlockSide * z))]);
            samples[SampleIndex(offset * kBlockSide + GridIndex(x, y, z))] = value;
            inside = inside || value < 0.0F;
            outside = outside || value >= 0.0F;
          }
        }
      }
    }
    return inside && outside;
  }

  /// Distances in voxel sizes, from distances in truncation distances.
  float InVoxels(float tsdf) const { return tsdf * voxels_per_unit_; }

  bool Crosses(float a, float b) const {
    if (std::isnan(a) || std::isnan(b) || (a < 0.0F) == (b < 0.0F)) return false;
    return InVoxels(std::abs(a - b)) <= options_.max_slope;
  }

  void FindCrossings(std::int32_t block, BlockCrossings& result) const {
    Samples samples;
    if (!Gather(block, samples)) return;
    const GridIndex base = tsdf_.block_coordinates(block) * kBlockSide;
    for (int i = 0; i < kBlockVoxels; ++i) {
      const GridIndex local = LocalVoxel(i);
      const float from = samples[SampleIndex(local)];
      if (std::isnan(from)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const float to = samples[SampleIndex(local + GridIndex::Unit(axis))];
        if (!Crosses(from, to)) continue;
        const float along = std::clamp(from / (from - to), kEndMargin, 1.0F - kEndMargin);
        const std::optional<CloudPoint> point = MakePoint(base + local, axis, along);
        if (!point) continue;
        result.keys.push_back(EdgeKey(local, axis));
        result.points.push_back(*point);
      }
    }
  }

  /// Gradient by central differences, one-sided beside unobserved voxels, 0 between two of them.
  Eigen::Vector3f Gradient(const GridIndex& voxel) const {
    const float centre = SampleAt(voxel);
    Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const float below = SampleAt(voxel - GridIndex::Unit(axis));
      const float above = SampleAt(voxel + GridIndex::Unit(axis));
      if (!std::isnan(below) && !std::isnan(above)) {
        gradient[axis] = 0.5F * (above - below);
      } else if (!std::isnan(above)) {
        gradient[axis] = above - centre;
      } else if (!std::isnan(below)) {
        gradient[axis] = centre - below;
      }
    }
    return gradient;
  }

  /// Returns whether the distance grows along `normal` no faster than a distance to a surface can,
  /// one voxel to either side. Unobserved sides pass.
  bool IsGradual(const Eigen::Vector3f& p_voxel, const Eigen::Vector3f& normal) const {
    for (const float side : {-1.0F, 1.0F}) {
      const std::optional<float> tsdf =
          InterpolateTsdf(tsdf_, p_voxel + side * normal, options_.min_weight);
      if (tsdf && InVoxels(std::abs(*tsdf)) > options_.max_slope) return false;
    }
    return true;
  }

  /// The point `along` (0..1) the edge from `voxel` along `axis`; nullopt if it is not a surface.
  std::optional<CloudPoint> MakePoint(const GridIndex& voxel, int axis, float along) const {
    const GridIndex next = voxel + GridIndex::Unit(axis);
    const Eigen::Vector3f here = Gradient(voxel);
    const Eigen::Vector3f there = Gradient(next);
    if (here.dot(there) < options_.min_gradient_cosine * here.norm() * there.norm()) {
      return std::nullopt;
    }
    // The gradient of the trilinear field's lattice values, interpolated along the edge.
    Eigen::Vector3f gradient = (1.0F - along) * here + along * there;
    if (gradient.squaredNorm() == 0.0F) gradient[axis] = SampleAt(next) - SampleAt(voxel);
    if (InVoxels(gradient.norm()) > options_.max_slope) return std::nullopt;
    const Eigen::Vector3f normal = gradient.normalized();
    Eigen::Vector3d p_voxel = voxel.cast<double>();
    p_voxel[axis] += static_cast<double>(along);
    if (!IsGradual(p_voxel.cast<float>(), normal)) return std::nullopt;
    return Measured(
        tsdf_.grid().min_m + (p_voxel + Eigen::Vector3d::Constant(0.5)) * tsdf_.grid().voxel_size_m,
        normal);
  }

  /// Algorithm 10, lines 4-9.
  CloudPoint Measured(const Eigen::Vector3d& p_world, const Eigen::Vector3f& normal) const {
    CloudPoint point;
    point.position_m = p_world.cast<float>();
    point.normal = normal;
    const auto [voxel, conditions, sigma_k] = MeasurementAt(tsdf_, thermal_, p_world);
    if (!voxel.assessed()) return point;
    // Beside edges, the nearest voxel may be another face's.
    if (!conditions.empty() && !BelongsToFace(conditions, normal, 0.0F)) return point;
    point.celsius = voxel.celsius();
    point.distance_class = static_cast<std::uint8_t>(voxel.distance_class());
    point.angle_class = static_cast<std::uint8_t>(voxel.angle_class());
    point.motion_class = static_cast<std::uint8_t>(voxel.motion_class());
    point.disagreement_class = static_cast<std::uint8_t>(voxel.disagreement_class());
    if (conditions.empty()) return point;
    point.sigma_k = sigma_k;
    point.nuc_epoch = conditions.epoch;
    point.nuc_age_s = conditions.age_s();
    point.measured_distance_m = conditions.distance_m();
    point.measured_angle_deg = AngleToNormalDeg(conditions.direction, normal);
    return point;
  }

  void CollectPoints(Surface& surface) {
    std::size_t count = 0;
    for (BlockCrossings& block : crossings_) {
      block.first = static_cast<std::uint32_t>(count);
      count += block.points.size();
    }
    CHECK(count < static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()));
    surface.points.reserve(count);
    for (BlockCrossings& block : crossings_) {
      surface.points.insert(surface.points.end(), block.points.begin(), block.points.end());
      block.points = {};
    }
  }

  void CollectTriangles(Surface& surface) const {
    std::vector<std::vector<Eigen::Vector3i>> parts(order_.size());
    threads_.ParallelFor(static_cast<int>(order_.size()), [&](int i) {
      FindTriangles(order_[static_cast<std::size_t>(i)], parts[static_cast<std::size_t>(i)]);
    });
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    surface.triangles.reserve(count);
    for (const auto& part : parts) {
      surface.triangles.insert(surface.triangles.end(), part.begin(), part.end());
    }
  }

  void FindTriangles(std::int32_t block, std::vector<Eigen::Vector3i>& triangles) const {
    Samples samples;
    if (!Gather(block, samples)) return;
    const GridIndex& b = tsdf_.block_coordinates(block);
    for (int i = 0; i < kBlockVoxels; ++i) {
      const GridIndex local = LocalVoxel(i);
      const std::optional<int> inside = CornersInside(samples, local);
      if (inside) AddCube(b, local, *inside, triangles);
    }
  }

  /// nullopt if a corner is not observed well enough.
  static std::optional<int> CornersInside(const Samples& samples, const GridIndex& local) {
    int inside = 0;
    for (int corner = 0; corner < kCubeCorners; ++corner) {
      const GridIndex offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const float value = samples[SampleIndex(local + offset)];
      if (std::isnan(value)) return std::nullopt;
      if (value < 0.0F) inside |= 1 << corner;
    }
    return inside;
  }

  void AddCube(const GridIndex& block, const GridIndex& local, int inside,
               std::vector<Eigen::Vector3i>& triangles) const {
    const std::size_t before = triangles.size();
    for (const CubeTriangle& triangle : table_.triangles(inside)) {
      Eigen::Vector3i indices;
      for (int i = 0; i < 3; ++i) {
        const CubeEdge& edge = table_.edges()[triangle[static_cast<std::size_t>(i)]];
        const GridIndex offset(edge.from & 1, edge.from >> 1 & 1, edge.from >> 2 & 1);
        const std::uint32_t point = PointOnEdge(block, local + offset, edge.axis);
        if (point == kUnused) {  // A jump, not a surface: leave the whole cube open.
          triangles.resize(before);
          return;
        }
        indices[i] = static_cast<std::int32_t>(point);
      }
      triangles.push_back(indices);
    }
  }

  /// Index of the crossing on the edge from `local` (0..8 per axis, seen from `block`); kUnused if
  /// none.
  std::uint32_t PointOnEdge(const GridIndex& block, const GridIndex& local, int axis) const {
    const GridIndex step = local / kBlockSide;
    const std::int32_t owner = tsdf_.Find(block + step);
    if (owner == TsdfVolume::kNoBlock) return kUnused;
    const BlockCrossings& crossings =
        crossings_[static_cast<std::size_t>(position_[static_cast<std::size_t>(owner)])];
    const std::uint16_t key = EdgeKey(local - step * kBlockSide, axis);
    const auto found = std::ranges::lower_bound(crossings.keys, key);
    if (found == crossings.keys.end() || *found != key) return kUnused;
    return crossings.first + static_cast<std::uint32_t>(found - crossings.keys.begin());
  }

  const TsdfVolume& tsdf_;
  const ThermalVolume& thermal_;
  const SurfaceOptions options_;
  ThreadPool& threads_;
  const float voxels_per_unit_;  // Truncation distance in voxels.
  const MarchingCubesTable table_;
  std::vector<std::int32_t> order_;        // Blocks in the order of output.
  std::vector<std::int32_t> position_;     // Of each block in order_.
  std::vector<BlockCrossings> crossings_;  // In the order of output.
};

}  // namespace

Surface ExtractSurface(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                       const SurfaceOptions& options, ThreadPool& threads) {
  return Extractor(tsdf, thermal, options, threads).Run();
}

Surface Surface::MeshOnly() const {
  std::vector<std::int32_t> new_index(points.size(), -1);
  for (const Eigen::Vector3i& triangle : triangles) {
    for (const int point : triangle) new_index[static_cast<std::size_t>(point)] = 0;
  }
  Surface mesh;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (new_index[i] < 0) continue;
    new_index[i] = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.push_back(points[i]);
  }
  mesh.triangles.reserve(triangles.size());
  for (const Eigen::Vector3i& triangle : triangles) {
    const auto index = [&](int i) { return new_index[static_cast<std::size_t>(triangle[i])]; };
    mesh.triangles.emplace_back(index(0), index(1), index(2));
  }
  return mesh;
}

}  // namespace isotherm
