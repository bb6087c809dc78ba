#include "ground/mesh/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

constexpr double kVoxel = 0.004;
constexpr double kTruncation = 4.0 * kVoxel;
constexpr double kRadius = 0.06;
const Eigen::Vector3d kCentre(0.0807, 0.0793, 0.0811);  // Off the lattice; blocks are 0.032 m.

VoxelGrid Grid(int blocks) {
  VoxelGrid grid;
  grid.voxel_size_m = kVoxel;
  grid.blocks = GridIndex::Constant(blocks);
  return grid;
}

/// Takes every change of sign for a surface.
constexpr SurfaceOptions kAnything{.max_slope = 100.0F, .min_gradient_cosine = -1.0F};

/// How often each directed side occurs. Closed and oriented: each once, and its opposite once.
std::map<std::pair<int, int>, int> DirectedSides(const Surface& surface) {
  std::map<std::pair<int, int>, int> sides;
  for (const Eigen::Vector3i& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  }
  return sides;
}

void ExpectClosedManifold(const Surface& surface) {
  const auto sides = DirectedSides(surface);
  std::size_t wrong = 0;
  for (const auto& [side, count] : sides) {
    if (count != 1 || !sides.contains({side.second, side.first})) ++wrong;
  }
  EXPECT_EQ(wrong, 0U) << "of " << sides.size();
}

class SphereTest : public ::testing::Test {
 protected:
  SphereTest() : tsdf_(Grid(5), kTruncation, 125), thermal_(125) {
    testing::FillSphere(tsdf_, kCentre, kRadius);
    testing::FillThermal(tsdf_, thermal_, [](const Eigen::Vector3d& p) {
      if (p.z() < kCentre.z()) return ThermalVoxel{};
      return ThermalVoxel::Make(p.x() < kCentre.x() ? 25.0F : 75.0F, ConditionClass::kGood,
                                ConditionClass::kAcceptable);
    });
  }
  Surface Extract(int threads = 2) const {
    ThreadPool pool(threads);
    return ExtractSurface(tsdf_, thermal_, {}, pool);
  }
  TsdfVolume tsdf_;
  ThermalVolume thermal_;
};

TEST_F(SphereTest, PointsLieOnTheSphere) {
  // A distance field bends by at most h^2 / (8 R) within one edge h = 4 mm at R = 60 mm (33 um),
  // and points keep 0.5 % of an edge from its ends (20 um).
  constexpr double kTolerance_m = 60e-6;
  const Surface surface = Extract();
  ASSERT_GT(surface.points.size(), 3000U);
  for (const CloudPoint& point : surface.points) {
    ASSERT_NEAR((point.position_m.cast<double>() - kCentre).norm(), kRadius, kTolerance_m);
  }
}

TEST_F(SphereTest, NormalsPointOutwardAlongTheRadius) {
  constexpr double kCosTolerance = 0.9998;  // 1.1 deg: central differences over 2 h at R = 15 h.
  for (const CloudPoint& point : Extract().points) {
    const Eigen::Vector3d radial = (point.position_m.cast<double>() - kCentre).normalized();
    ASSERT_NEAR(point.normal.norm(), 1.0F, 1e-5F);
    ASSERT_GT(point.normal.cast<double>().dot(radial), kCosTolerance);
  }
}

TEST_F(SphereTest, MeshIsAClosedSphere) {
  const Surface surface = Extract();
  ExpectClosedManifold(surface);
  const auto vertices = static_cast<long>(surface.points.size());
  const auto faces = static_cast<long>(surface.triangles.size());
  EXPECT_EQ(vertices - faces * 3 / 2 + faces, 2);  // Euler characteristic.
}

TEST_F(SphereTest, AreaAndVolumeAreThoseOfTheSphere) {
  double area = 0.0;
  double volume = 0.0;
  const Surface surface = Extract();
  for (const Eigen::Vector3i& t : surface.triangles) {
    const auto corner = [&](int i) {
      return Eigen::Vector3d(
          surface.points[static_cast<std::size_t>(t[i])].position_m.cast<double>() - kCentre);
    };
    const Eigen::Vector3d a = corner(0), b = corner(1), c = corner(2);
    area += (b - a).cross(c - a).norm() / 2.0;
    volume += a.dot(b.cross(c)) / 6.0;  // Positive if the triangle faces outward.
  }
  constexpr double kRelative = 0.004;  // Chords of length <= sqrt(3) h inside R = 15 h.
  const double true_area = 4.0 * std::numbers::pi * kRadius * kRadius;
  EXPECT_NEAR(area / true_area, 1.0, kRelative);
  EXPECT_NEAR(volume / (true_area * kRadius / 3.0), 1.0, kRelative);
}

TEST_F(SphereTest, PointsCarryTemperatureAndClassesOfTheirVoxel) {
  int cold = 0, hot = 0, never = 0;
  for (const CloudPoint& point : Extract().points) {
    const Eigen::Vector3d p = point.position_m.cast<double>() - kCentre;
    if (p.z() < -2.0 * kVoxel) {
      EXPECT_TRUE(std::isnan(point.celsius));
      EXPECT_EQ(point.distance_class, kNeverMeasured);
      ++never;
    } else if (p.z() > 2.0 * kVoxel && std::abs(p.x()) > 2.0 * kVoxel) {
      EXPECT_NEAR(point.celsius, p.x() < 0.0 ? 25.0F : 75.0F, 0.0126F);
      EXPECT_EQ(point.distance_class, static_cast<std::uint8_t>(ConditionClass::kGood));
      EXPECT_EQ(point.angle_class, static_cast<std::uint8_t>(ConditionClass::kAcceptable));
      ++(p.x() < 0.0 ? cold : hot);
    }
  }
  EXPECT_GT(std::min({cold, hot, never}), 500);
}

TEST_F(SphereTest, ResultDoesNotDependOnThreads) {
  const Surface one = Extract(1);
  const Surface four = Extract(4);
  ASSERT_EQ(one.points.size(), four.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    ASSERT_EQ(one.points[i].position_m, four.points[i].position_m);
  }
  EXPECT_EQ(one.triangles, four.triangles);
}

TEST_F(SphereTest, ResultDoesNotDependOnTheOrderOfAllocation) {
  TsdfVolume reversed(Grid(5), kTruncation, 125);
  for (int i = tsdf_.block_count() - 1; i >= 0; --i) {
    const std::int32_t block = reversed.FindOrAllocate(tsdf_.block_coordinates(i));
    std::ranges::copy(tsdf_.voxels(i), reversed.voxels(block).begin());
  }
  ThreadPool pool(2);
  const ThermalVolume unmeasured(125);
  const Surface expected = Extract();
  const Surface actual = ExtractSurface(reversed, unmeasured, {}, pool);
  EXPECT_EQ(actual.triangles, expected.triangles);
  ASSERT_EQ(actual.points.size(), expected.points.size());
  EXPECT_EQ(actual.points.front().position_m, expected.points.front().position_m);
  EXPECT_EQ(actual.points.back().position_m, expected.points.back().position_m);
}

TEST_F(SphereTest, WeightDecidesWhatIsSurface) {
  ThreadPool pool(1);
  EXPECT_FALSE(ExtractSurface(tsdf_, thermal_, {.min_weight = 10.0F}, pool).points.empty());
  EXPECT_TRUE(ExtractSurface(tsdf_, thermal_, {.min_weight = 10.1F}, pool).points.empty());
}

TEST_F(SphereTest, CloudAloneHasTheSamePoints) {
  ThreadPool pool(1);
  const Surface cloud = ExtractSurface(tsdf_, thermal_, {.triangles = false}, pool);
  EXPECT_TRUE(cloud.triangles.empty());
  EXPECT_EQ(cloud.points.size(), Extract().points.size());
}

TEST(SurfaceTest, EmptyVolumeHasNoSurface) {
  const TsdfVolume tsdf(Grid(2), kTruncation, 8);
  const ThermalVolume thermal(8);
  ThreadPool pool(2);
  const Surface surface = ExtractSurface(tsdf, thermal, {}, pool);
  EXPECT_TRUE(surface.points.empty());
  EXPECT_TRUE(surface.triangles.empty());
}

TEST(SurfaceTest, PlaneOnTheLatticeHasNoTriangleWithoutArea) {
  TsdfVolume tsdf(Grid(2), kTruncation, 8);
  // Exactly through voxel centres, where a distance is 0 and three edges meet in one point.
  testing::FillPlane(tsdf, {0.0, 0.0, 7.5 * kVoxel}, Eigen::Vector3d::UnitZ());
  const ThermalVolume thermal(8);
  ThreadPool pool(1);
  const Surface surface = ExtractSurface(tsdf, thermal, {}, pool);
  ASSERT_EQ(surface.triangles.size(), 2U * 15U * 15U);
  for (const Eigen::Vector3i& t : surface.triangles) {
    const auto corner = [&](int i) {
      return surface.points[static_cast<std::size_t>(t[i])].position_m;
    };
    const Eigen::Vector3f area = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    ASSERT_GT(area.z(), 0.0F);  // Towards free space.
    ASSERT_NEAR(corner(0).z(), 7.5 * kVoxel, 0.006 * kVoxel);
  }
}

TEST(SurfaceTest, JumpFromFreeSpaceBehindAnEdgeIsNotSurface) {
  TsdfVolume tsdf(Grid(2), kTruncation, 8);
  // Left half: 3 voxels behind a surface; right half: free space. No surface was seen between them.
  testing::FillVolume(
      tsdf, [](const Eigen::Vector3d& p) { return p.x() < 0.032 ? -3.0 * kVoxel : 4.0 * kVoxel; });
  const ThermalVolume thermal(8);
  ThreadPool pool(1);
  EXPECT_TRUE(ExtractSurface(tsdf, thermal, {}, pool).points.empty());
  EXPECT_FALSE(ExtractSurface(tsdf, thermal, kAnything, pool).points.empty());
}

TEST(SurfaceTest, BendsWithinOneVoxelAreLeftOutAndFacesBesideThemStay) {
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.0641);
  constexpr double kHalf = 0.0402;
  TsdfVolume tsdf(Grid(4), kTruncation, 64);
  testing::FillVolume(tsdf, [&](const Eigen::Vector3d& p) {  // A cube.
    const Eigen::Vector3d d = (p - centre).cwiseAbs() - Eigen::Vector3d::Constant(kHalf);
    return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
  });
  const auto count = [&](const Surface& surface, bool near_edge) {
    return std::ranges::count_if(surface.points, [&](const CloudPoint& point) {
      Eigen::Vector3d d = (point.position_m.cast<double>() - centre).cwiseAbs();
      std::sort(d.data(), d.data() + 3);
      return (kHalf - d[1] < 2.5 * kVoxel) ==
             near_edge;  // The middle one: nearest edge of the face.
    });
  };
  const ThermalVolume thermal(64);
  ThreadPool pool(2);
  const Surface all = ExtractSurface(tsdf, thermal, kAnything, pool);
  const Surface smooth = ExtractSurface(tsdf, thermal, {}, pool);
  EXPECT_EQ(count(smooth, false), count(all, false));
  EXPECT_GT(count(all, false), 1000);
  EXPECT_LT(count(smooth, true), count(all, true));
}

TEST(SurfaceTest, MeshOfNoiseIsClosed) {
  constexpr unsigned kSeed = 7;  // All 256 cases and every ambiguous face occur in noise.
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> distance(-1.0, 1.0);
  TsdfVolume tsdf(Grid(3), kTruncation, 27);
  const double margin = 1.1 * kVoxel;
  const double end = 24.0 * kVoxel - margin;
  testing::FillVolume(tsdf, [&](const Eigen::Vector3d& p) {
    // Outside at the border, so that nothing is cut open there.
    const bool border = (p.array() < margin).any() || (p.array() > end).any();
    return border ? kTruncation : kTruncation * distance(random);
  });
  const ThermalVolume thermal(27);
  ThreadPool pool(2);
  const Surface surface = ExtractSurface(tsdf, thermal, kAnything, pool);
  ASSERT_GT(surface.triangles.size(), 10000U);
  ExpectClosedManifold(surface);
}

TEST(SurfaceTest, MeshOnlyDropsUnusedPointsAndKeepsTheShape) {
  Surface surface;
  for (int i = 0; i < 5; ++i) {
    CloudPoint point;
    point.position_m = Eigen::Vector3f(static_cast<float>(i), 0, 0);
    surface.points.push_back(point);
  }
  surface.triangles.emplace_back(4, 1, 3);
  const Surface mesh = surface.MeshOnly();
  ASSERT_EQ(mesh.points.size(), 3U);
  EXPECT_EQ(mesh.triangles.front(), Eigen::Vector3i(2, 0, 1));
  EXPECT_EQ(mesh.points[2].position_m.x(), 4.0F);
}

}  // namespace
}  // namespace isotherm
