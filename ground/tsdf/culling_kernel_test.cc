#include "ground/tsdf/culling_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "common/testing/volume_shapes.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/tsdf/reference/culling_reference.h"
#include "ground/tsdf/visible_blocks.h"

namespace isotherm {
namespace {

using testing::Tribool;
using Planes = float[kFrustumPlanes][4];

/// Blocks that CullBlocks keeps; fails where it differs from the scalar reference.
std::int32_t Compare(const Planes& planes, const std::vector<std::int32_t>& coordinates,
                     double precision) {
  const auto count = static_cast<std::int32_t>(coordinates.size() / 3);
  std::vector<std::int32_t> inside(static_cast<std::size_t>(count + kCullingPadding + 1),
                                   testing::kCanary);
  const std::int32_t found = CullBlocks(planes, coordinates.data(), count, inside.data());
  EXPECT_EQ(inside.back(), testing::kCanary) << "wrote beyond the padding";
  std::int32_t next = 0;
  for (std::int32_t block = 0; block < count; ++block) {
    const bool kept = next < found && inside[static_cast<std::size_t>(next)] == block;
    next += kept ? 1 : 0;
    const Tribool decision = reference::CullBlock(planes, &coordinates[3 * block], precision);
    if (decision != Tribool::kEither) {
      EXPECT_EQ(kept, decision == Tribool::kYes) << "block " << block << " of " << count;
    }
  }
  EXPECT_EQ(next, found) << "something that is no block, or not in order";
  return found;
}

TEST(CullBlocksTest, KeepsExactlyTheBlocksInsideWhereSumsAreExact) {
  testing::ForEachInstructionSet([] {
    testing::Random random;
    std::int64_t kept = 0;
    std::int64_t all = 0;
    for (int count = 0; count <= 5 * testing::kMaxLanes; ++count) {
      for (int round = 0; round < 20; ++round, all += count) {
        Planes planes;
        for (auto& plane : planes) {
          for (float& p : plane) p = static_cast<float>(random.Integer(-3, 4));
          plane[3] = static_cast<float>(random.Integer(-2, 30));
        }
        std::vector<std::int32_t> coordinates;
        for (int i = 0; i < 3 * count; ++i) coordinates.push_back(random.Integer(-4, 4));
        kept += Compare(planes, coordinates, /*precision=*/0.0);
      }
    }
    EXPECT_GT(kept, all / 10);
    EXPECT_LT(kept, all - all / 10);
  });
}

TEST(CullBlocksTest, KeepsTheBlocksOfRandomPyramids) {
  testing::ForEachInstructionSet([] {
    testing::Random random;
    for (int round = 0; round < 50; ++round) {
      Planes planes;
      for (auto& plane : planes) {
        for (float& p : plane) p = random.Uniform(-0.02F, 0.02F);
        plane[3] = random.Uniform(-0.2F, 1.0F);
      }
      std::vector<std::int32_t> coordinates;
      for (int i = 0; i < 3 * 500; ++i) coordinates.push_back(random.Integer(0, 60));
      Compare(planes, coordinates, testing::kSinglePrecision);
    }
  });
}

TEST(VisibleBlocksTest, FindsEachBlockOfWhichAVoxelIsInView) {
  VolumeOptions options;
  options.set_size_x_m(0.3);
  options.set_size_y_m(0.2);
  options.set_size_z_m(0.4);
  options.set_voxel_size_m(0.004);
  const VoxelGrid grid = MakeVoxelGrid(options).value();
  TsdfVolume volume(grid, 0.016, MaxBlocks(options, grid));
  testing::Random random;
  testing::ForEachBlockOfGrid(grid, [&](const GridIndex& b) {
    if (random.Chance(0.5)) volume.FindOrAllocate(b);
  });
  const CameraModel camera = testing::SmallDepthCamera();
  VisibleBlocks visible;
  int in_view = 0;
  int found_in_all = 0;
  for (int round = 0; round < 12; ++round) {
    const auto uniform = [&] { return random.Uniform(-1.0F, 1.0F); };
    const Eigen::Quaterniond rotation(1.0, uniform(), uniform(), uniform());
    const Eigen::Vector3d ahead =
        rotation.normalized() * Eigen::Vector3d(0.0, 0.0, 0.15 + 0.15 * uniform());
    const RigidTransform pose = MakeTransform(grid.min_m + 0.5 * grid.size_m() - ahead, rotation);
    const std::span<const std::int32_t> found = visible.Find(volume, camera, pose);
    found_in_all += static_cast<int>(found.size());
    for (std::int32_t block = 0; block < volume.block_count(); ++block) {
      bool seen = false;
      testing::ForEachVoxel(
          volume.voxels(block), grid, volume.block_coordinates(block),
          [&](const TsdfVoxel&, const Eigen::Vector3d& p) {
            const auto pixel = Project(camera, pose.inverse() * p);
            seen = seen || (pixel && pixel->x() >= -0.5 && pixel->x() < camera.width - 0.5 &&
                            pixel->y() >= -0.5 && pixel->y() < camera.height - 0.5);
          });
      if (!seen) continue;
      ++in_view;
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), block)) << "block " << block;
    }
  }
  EXPECT_GT(in_view, 500);
  EXPECT_LT(found_in_all, 2 * in_view) << "keeps what is far from the view";
}

}  // namespace
}  // namespace isotherm
