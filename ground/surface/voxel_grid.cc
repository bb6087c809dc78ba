#include "ground/surface/voxel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

/// The block table may take this fraction of the memory limit; the rest is for voxels.
constexpr double kTableFraction = 0.25;

/// Entries of the table are numbered with 31 bits.
constexpr double kMaxTableBytes =
    sizeof(std::int32_t) * static_cast<double>(std::numeric_limits<std::int32_t>::max());

Eigen::Vector3d BlocksAlongAxes(const VolumeOptions& o, double voxel_size_m) {
  // A tiny tolerance keeps 0.96 / 0.016 from rounding up to 61 blocks.
  return (Eigen::Vector3d(o.size_x_m(), o.size_y_m(), o.size_z_m()) / (voxel_size_m * kBlockSide) -
          Eigen::Vector3d::Constant(1e-6))
      .array()
      .ceil()
      .max(1.0);
}

/// With the border of TsdfVolume's table.
double TableBytes(const Eigen::Vector3d& blocks) {
  return sizeof(std::int32_t) * (blocks.array() + 2.0).prod();
}

/// About the smallest voxels with which the table fits.
double FittingVoxel(const VolumeOptions& o, double allowed_bytes) {
  constexpr double kRounding = 1.001;  // When printed with four digits.
  // Keeps the next guess finite where a table is absurdly large.
  constexpr double kMaxGrowth = 1e6;
  double voxel_m = o.voxel_size_m();
  while (std::isfinite(voxel_m)) {
    const double table_bytes = TableBytes(BlocksAlongAxes(o, voxel_m));
    if (table_bytes <= allowed_bytes) break;
    voxel_m *= std::clamp(std::cbrt(table_bytes / allowed_bytes), kRounding, kMaxGrowth);
  }
  return voxel_m * kRounding;
}

std::string DescribeBytes(double bytes) {
  // Binary units: the limits that are told are those of memory.
  constexpr double kStep = 1024.0;
  std::string_view unit = "KiB";
  bytes /= kStep;
  for (const std::string_view larger : {"MiB", "GiB"}) {
    if (bytes < kStep) break;
    bytes /= kStep;
    unit = larger;
  }
  return fmt::format("{:.1f} {}", bytes, unit);
}

std::string DescribeSize(const VolumeOptions& o) {
  return fmt::format("{} x {} x {} m with {} m voxels", o.size_x_m(), o.size_y_m(), o.size_z_m(),
                     o.voxel_size_m());
}

}  // namespace

Status Validate(const VolumeOptions& o) {
  for (const double size : {o.size_x_m(), o.size_y_m(), o.size_z_m()}) {
    if (!(std::isfinite(size) && size > 0.0)) {
      return InvalidArgument(fmt::format(
          "volume: size_x_m, size_y_m and size_z_m must be positive, got {}", DescribeSize(o)));
    }
  }
  if (!(std::isfinite(o.voxel_size_m()) && o.voxel_size_m() >= 1e-4)) {
    return InvalidArgument(
        fmt::format("volume.voxel_size_m must be at least 0.0001 m, got {} m", o.voxel_size_m()));
  }
  for (const double corner : {o.expert().min_x_m(), o.expert().min_y_m(), o.expert().min_z_m()}) {
    if (!std::isfinite(corner))
      return InvalidArgument("volume.expert: min_x_m, min_y_m and min_z_m must be finite");
  }
  const Result<VoxelGrid> grid = MakeVoxelGrid(o);
  return grid ? OkStatus() : grid.error();
}

Result<VoxelGrid> MakeVoxelGrid(const VolumeOptions& o) {
  const Eigen::Vector3d blocks = BlocksAlongAxes(o, o.voxel_size_m());
  const double table_bytes = TableBytes(blocks);
  const double allowed_bytes =
      std::min(static_cast<double>(o.expert().max_memory_bytes()) * kTableFraction, kMaxTableBytes);
  if (!(table_bytes <= allowed_bytes)) {
    return Err(ResourceExhausted(
        fmt::format("a volume of {} needs {} for its block table alone, {} are allowed "
                    "(a quarter of volume.expert.max_memory_bytes, 8 GiB at most): use voxels of "
                    "{:.4g} m or more, or "
                    "a smaller volume",
                    DescribeSize(o), DescribeBytes(table_bytes), DescribeBytes(allowed_bytes),
                    FittingVoxel(o, allowed_bytes))));
  }
  VoxelGrid grid;
  grid.min_m = {o.expert().min_x_m(), o.expert().min_y_m(), o.expert().min_z_m()};
  grid.voxel_size_m = o.voxel_size_m();
  grid.blocks = blocks.cast<int>();
  return grid;
}

std::int32_t MaxResidentBlocks(const VolumeOptions& options, const VoxelGrid& grid) {
  const double table_bytes = static_cast<double>(grid.block_count()) * sizeof(std::int32_t);
  const double block_bytes = kBlockVoxels * kBytesPerVoxel;
  const double fitting =
      (static_cast<double>(options.expert().max_memory_bytes()) - table_bytes) / block_bytes;
  const double limit = std::min(static_cast<double>(grid.block_count()), fitting);
  return static_cast<std::int32_t>(
      std::clamp(limit, 1.0, static_cast<double>(kMaxAddressableBlocks)));
}

std::int32_t MaxBlocks(const VolumeOptions& options, const VoxelGrid& grid) {
  if (options.spill_dir().empty()) return MaxResidentBlocks(options, grid);
  return static_cast<std::int32_t>(
      std::min<std::int64_t>(grid.block_count(), kMaxAddressableBlocks));
}

}  // namespace isotherm
