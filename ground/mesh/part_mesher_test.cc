#include "ground/mesh/part_mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

constexpr double kPartVoxel_m = 0.004;
const Eigen::Vector3d kMiddle(0.0807, 0.0793, 0.0811);

/// The numbers of a point that parts must not change.
using PointKey = std::array<float, 9>;
using TriangleKey = std::array<PointKey, 3>;

PointKey KeyOf(const CloudPoint& p) {
  return {p.position_m.x(), p.position_m.y(), p.position_m.z(), p.normal.x(), p.normal.y(),
          p.normal.z(),
          // NaN is not equal to itself.
          std::isnan(p.celsius) ? -1000.0F : p.celsius, static_cast<float>(p.distance_class),
          static_cast<float>(p.angle_class)};
}

/// All triangles in an order of their own, each with its corners as they are.
std::vector<TriangleKey> TrianglesOf(const Surface& surface) {
  std::vector<TriangleKey> keys;
  for (const Eigen::Vector3i& t : surface.triangles) {
    const auto corner = [&](int i) {
      return KeyOf(surface.points[static_cast<std::size_t>(t[i])]);
    };
    keys.push_back({corner(0), corner(1), corner(2)});
  }
  std::ranges::sort(keys);
  return keys;
}

class PartMesherTest : public ::testing::TestWithParam<int> {
 protected:
  PartMesherTest() : tsdf_(Grid(), 4.0 * kPartVoxel_m, 125), thermal_(125) {
    testing::FillSphere(tsdf_, kMiddle, 0.06);
    testing::FillThermal(tsdf_, thermal_, [](const Eigen::Vector3d& p) {
      if (p.z() < kMiddle.z()) return ThermalVoxel{};
      return ThermalVoxel::Make(static_cast<float>(20.0 + 500.0 * p.x()), ConditionClass::kGood,
                                ConditionClass::kAcceptable);
    });
  }
  static VoxelGrid Grid() {
    VoxelGrid grid;
    grid.voxel_size_m = kPartVoxel_m;
    grid.blocks = GridIndex::Constant(5);
    return grid;
  }
  /// The blocks of the volume by the cube of `side`^3 blocks they are in.
  std::vector<std::vector<std::int32_t>> Parts(int side) const {
    std::map<std::tuple<int, int, int>, std::vector<std::int32_t>> parts;
    for (std::int32_t block = 0; block < tsdf_.block_count(); ++block) {
      const GridIndex part = tsdf_.block_coordinates(block) / side;
      parts[{part.x(), part.y(), part.z()}].push_back(block);
    }
    std::vector<std::vector<std::int32_t>> lists;
    for (auto& [part, blocks] : parts) lists.push_back(std::move(blocks));
    return lists;
  }
  TsdfVolume tsdf_;
  ThermalVolume thermal_;
};

TEST_P(PartMesherTest, PartsTogetherAreTheWholeMesh) {
  ThreadPool pool(1);
  const std::vector<TriangleKey> whole =
      TrianglesOf(ExtractSurface(tsdf_, thermal_, {}, pool).MeshOnly());
  ASSERT_GT(whole.size(), 5000U);
  PartMesher mesher{SurfaceOptions{}};
  std::vector<TriangleKey> sum;
  for (const std::vector<std::int32_t>& blocks : Parts(GetParam())) {
    const std::vector<TriangleKey> part = TrianglesOf(mesher.Extract(tsdf_, thermal_, blocks));
    sum.insert(sum.end(), part.begin(), part.end());
  }
  std::ranges::sort(sum);
  EXPECT_EQ(sum, whole);
}

INSTANTIATE_TEST_SUITE_P(Sides, PartMesherTest, ::testing::Values(1, 2, 4));

TEST_F(PartMesherTest, APartHasOnlyThePointsThatItsTrianglesUse) {
  PartMesher mesher{SurfaceOptions{}};
  const Surface part = mesher.Extract(tsdf_, thermal_, Parts(2).front());
  std::vector<bool> used(part.points.size(), false);
  for (const Eigen::Vector3i& t : part.triangles) {
    for (const int point : t) used[static_cast<std::size_t>(point)] = true;
  }
  ASSERT_FALSE(used.empty());
  EXPECT_TRUE(std::ranges::all_of(used, [](bool u) { return u; }));
}

TEST_F(PartMesherTest, NoBlocksAreNoSurface) {
  PartMesher mesher{SurfaceOptions{}};
  const Surface part = mesher.Extract(tsdf_, thermal_, {});
  EXPECT_TRUE(part.points.empty());
  EXPECT_TRUE(part.triangles.empty());
}

}  // namespace
}  // namespace isotherm
