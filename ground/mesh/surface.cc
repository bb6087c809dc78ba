#include "ground/mesh/surface.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "common/base/check.h"
#include "common/concurrency/thread_pool.h"
#include "ground/mesh/surface_cells.h"

namespace isotherm {
namespace {

/// The passes of one extraction: crossings per block, then points, then triangles between them.
class Extractor {
 public:
  Extractor(const TsdfVolume& tsdf, const ThermalVolume& thermal, const SurfaceOptions& options,
            ThreadPool& threads)
      : tsdf_(tsdf), cells_(tsdf, thermal, options), threads_(threads) {}

  Surface Run(bool with_triangles) {
    SortBlocks();
    crossings_.resize(order_.size());
    threads_.ParallelFor(static_cast<int>(order_.size()), [this](int i) {
      const auto index = static_cast<std::size_t>(i);
      cells_.FindCrossings(order_[index], kWholeBlock, crossings_[index]);
    });
    Surface surface;
    CollectPoints(surface);
    if (with_triangles) CollectTriangles(surface);
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
    BlockSigns signs;
    if (!cells_.Gather(block, signs)) return;
    const GridIndex& coordinates = tsdf_.block_coordinates(block);
    const auto find = [&](const GridIndex& step, std::uint16_t key) {
      const std::int32_t owner = tsdf_.Find(coordinates + step);
      if (owner == TsdfVolume::kNoBlock) return kNoPoint;
      const std::int32_t position = position_[static_cast<std::size_t>(owner)];
      return FindCrossing(crossings_[static_cast<std::size_t>(position)], key);
    };
    cubes_.Add(signs, find, triangles);
  }

  const TsdfVolume& tsdf_;
  const SurfaceCells cells_;
  ThreadPool& threads_;
  const CubeTriangles cubes_;
  std::vector<std::int32_t> order_;        // Blocks in the order of output.
  std::vector<std::int32_t> position_;     // Of each block in order_.
  std::vector<BlockCrossings> crossings_;  // In the order of output.
};

}  // namespace

Surface ExtractSurface(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                       const SurfaceOptions& options, ThreadPool& threads) {
  return Extractor(tsdf, thermal, options, threads).Run(options.triangles);
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
