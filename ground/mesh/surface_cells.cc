#include "ground/mesh/surface_cells.h"

#include <algorithm>

#include "ground/mesh/face_measurement.h"
#include "ground/thermal/condition_record.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

// Crossings keep this fraction of an edge's length from its ends, so that no triangle has zero
// area. At 2 mm voxels it moves a point by at most 10 um.
constexpr float kEndMargin = 0.005F;

// A byte of BlockSigns; kOutside only tells Gather what it has seen.
constexpr std::uint8_t kInside = 1, kUnobserved = 1 << kUnobservedBit, kOutside = 4;

bool IsAskedFor(VoxelLayers layers, const GridIndex& local) {
  if ((layers & kWholeBlock) != 0) return true;
  const int zeros = (local.x() == 0 ? 1 : 0) | (local.y() == 0 ? 2 : 0) | (local.z() == 0 ? 4 : 0);
  for (int offset = 1; offset < 8; ++offset) {
    if ((layers >> offset & 1) != 0 && (offset & ~zeros) == 0) return true;
  }
  return false;
}

}  // namespace

template <int kCount>
std::uint8_t SurfaceCells::GatherRow(const TsdfVoxel* voxels, std::size_t index,
                                     BlockSigns& signs) const {
  std::uint8_t seen = 0;
  // Without branches, so that the compiler can do all at once.
  for (std::size_t x = 0; x < kCount; ++x) {
    const std::uint32_t bits = voxels[x].bits;
    const int sign = TsdfLayout::TsdfCode(bits) < 0 ? kInside : kOutside;
    const bool is_known = static_cast<int>(TsdfLayout::WeightCode(bits)) >= min_weight_code_;
    const auto byte = static_cast<std::uint8_t>(is_known ? sign : kUnobserved);
    signs.bytes[index + x] = byte;
    seen |= byte;
  }
  return seen;
}

bool SurfaceCells::Gather(std::int32_t block, BlockSigns& signs) const {
  signs.bytes.fill(kUnobserved);
  std::uint8_t seen = 0;
  for (int neighbour = 0; neighbour < 8; ++neighbour) {
    const GridIndex offset(neighbour & 1, neighbour >> 1 & 1, neighbour >> 2 & 1);
    const std::int32_t source = tsdf_.Find(tsdf_.block_coordinates(block) + offset);
    if (source == TsdfVolume::kNoBlock) continue;
    const auto voxels = tsdf_.voxels(source);
    // Of an upper neighbour only its first layer is needed.
    const GridIndex count = GridIndex::Constant(kBlockSide) - offset * (kBlockSide - 1);
    for (int z = 0; z < count.z(); ++z) {
      for (int y = 0; y < count.y(); ++y) {
        const TsdfVoxel* row = &voxels[static_cast<std::size_t>(kBlockSide * (y + kBlockSide * z))];
        const std::size_t index = BlockSigns::Index(offset * kBlockSide + GridIndex(0, y, z));
        seen |= offset.x() == 0 ? GatherRow<kBlockSide>(row, index, signs)
                                : GatherRow<1>(row, index, signs);
      }
    }
  }
  return (seen & kInside) != 0 && (seen & kOutside) != 0;
}

void SurfaceCells::FindCrossings(std::int32_t block, VoxelLayers layers,
                                 BlockCrossings& result) const {
  BlockSigns signs;
  if (!Gather(block, signs)) return;
  constexpr int kRows = kBlockSide * kBlockSide;
  for (int row = 0; row < kRows; ++row) {
    const GridIndex first(0, row % kBlockSide, row / kBlockSide);
    const SignRow from = signs.Row(first);
    std::array<SignRow, 3> changes;
    SignRow any = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const SignRow to = signs.Row(first + GridIndex::Unit(axis));
      const SignRow change = (from ^ to) & ~((from | to) >> kUnobservedBit) & kInsideBits;
      changes[static_cast<std::size_t>(axis)] = change;
      any |= change;
    }
    VisitBytes(any, [&](int x) {
      const GridIndex local(x, first.y(), first.z());
      if (!IsAskedFor(layers, local)) return;
      for (int axis = 0; axis < 3; ++axis) {
        if ((changes[static_cast<std::size_t>(axis)] >> (8 * x) & 1) != 0)
          AddCrossing(block, local, axis, result);
      }
    });
  }
}

void SurfaceCells::AddCrossing(std::int32_t block, const GridIndex& local, int axis,
                               BlockCrossings& result) const {
  const GridIndex voxel = tsdf_.block_coordinates(block) * kBlockSide + local;
  const float from = SampleAt(voxel);
  const float to = SampleAt(voxel + GridIndex::Unit(axis));
  if (InVoxels(std::abs(from - to)) > options_.max_slope) return;
  const float along = std::clamp(from / (from - to), kEndMargin, 1.0F - kEndMargin);
  const std::optional<CloudPoint> point = MakePoint(voxel, axis, along);
  if (!point) return;
  result.keys.push_back(EdgeKey(local, axis));
  result.points.push_back(*point);
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

std::uint32_t FindCrossing(const BlockCrossings& crossings, std::uint16_t key) {
  const auto found = std::ranges::lower_bound(crossings.keys, key);
  if (found == crossings.keys.end() || *found != key) return kNoPoint;
  return crossings.first + static_cast<std::uint32_t>(found - crossings.keys.begin());
}

}  // namespace isotherm
