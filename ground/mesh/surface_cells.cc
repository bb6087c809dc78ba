#include "ground/mesh/surface_cells.h"

#include <algorithm>
#include <limits>

#include "ground/mesh/face_measurement.h"
#include "ground/thermal/condition_record.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
// Crossings keep this fraction of an edge's length from its ends, so that no triangle has zero
// area. At 2 mm voxels it moves a point by at most 10 um.
constexpr float kEndMargin = 0.005F;

bool IsAskedFor(VoxelLayers layers, const GridIndex& local) {
  if ((layers & kWholeBlock) != 0) return true;
  const int zeros = (local.x() == 0 ? 1 : 0) | (local.y() == 0 ? 2 : 0) | (local.z() == 0 ? 4 : 0);
  for (int offset = 1; offset < 8; ++offset) {
    if ((layers >> offset & 1) != 0 && (offset & ~zeros) == 0) return true;
  }
  return false;
}

}  // namespace

bool SurfaceCells::Gather(std::int32_t block, BlockSamples& samples) const {
  samples.values.fill(kUnknown);
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
          samples.values[BlockSamples::Index(offset * kBlockSide + GridIndex(x, y, z))] = value;
          inside = inside || value < 0.0F;
          outside = outside || value >= 0.0F;
        }
      }
    }
  }
  return inside && outside;
}

bool SurfaceCells::Crosses(float a, float b) const {
  if (std::isnan(a) || std::isnan(b) || (a < 0.0F) == (b < 0.0F)) return false;
  return InVoxels(std::abs(a - b)) <= options_.max_slope;
}

void SurfaceCells::FindCrossings(std::int32_t block, VoxelLayers layers,
                                 BlockCrossings& result) const {
  BlockSamples samples;
  if (!Gather(block, samples)) return;
  const GridIndex base = tsdf_.block_coordinates(block) * kBlockSide;
  for (int i = 0; i < kBlockVoxels; ++i) {
    const GridIndex local = LocalVoxel(i);
    if (!IsAskedFor(layers, local)) continue;
    const float from = samples.At(local);
    if (std::isnan(from)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const float to = samples.At(local + GridIndex::Unit(axis));
      if (!Crosses(from, to)) continue;
      const float along = std::clamp(from / (from - to), kEndMargin, 1.0F - kEndMargin);
      const std::optional<CloudPoint> point = MakePoint(base + local, axis, along);
      if (!point) continue;
      result.keys.push_back(EdgeKey(local, axis));
      result.points.push_back(*point);
    }
  }
}

Eigen::Vector3f SurfaceCells::Gradient(const GridIndex& voxel) const {
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

bool SurfaceCells::IsGradual(const Eigen::Vector3f& p_voxel, const Eigen::Vector3f& normal) const {
  for (const float side : {-1.0F, 1.0F}) {
    const std::optional<float> tsdf =
        InterpolateTsdf(tsdf_, p_voxel + side * normal, options_.min_weight);
    if (tsdf && InVoxels(std::abs(*tsdf)) > options_.max_slope) return false;
  }
  return true;
}

std::optional<CloudPoint> SurfaceCells::MakePoint(const GridIndex& voxel, int axis,
                                                  float along) const {
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
  return MeasuredPoint(
      tsdf_, thermal_,
      tsdf_.grid().min_m + (p_voxel + Eigen::Vector3d::Constant(0.5)) * tsdf_.grid().voxel_size_m,
      normal);
}

std::optional<int> SurfaceCells::CornersInside(const BlockSamples& samples,
                                               const GridIndex& local) {
  int inside = 0;
  for (int corner = 0; corner < kCubeCorners; ++corner) {
    const GridIndex offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const float value = samples.At(local + offset);
    if (std::isnan(value)) return std::nullopt;
    if (value < 0.0F) inside |= 1 << corner;
  }
  return inside;
}

std::uint32_t FindCrossing(const BlockCrossings& crossings, std::uint16_t key) {
  const auto found = std::ranges::lower_bound(crossings.keys, key);
  if (found == crossings.keys.end() || *found != key) return kNoPoint;
  return crossings.first + static_cast<std::uint32_t>(found - crossings.keys.begin());
}

}  // namespace isotherm
