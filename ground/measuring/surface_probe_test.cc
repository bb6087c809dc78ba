#include "ground/measuring/surface_probe.h"

#include <gtest/gtest.h>

#include <random>

#include "ground/measuring/testing/plate.h"

namespace isotherm {
namespace {

using testing::kPlate_m;
using testing::kPlateVoxel_m;
using testing::PlateModel;

/// A plane's zero crossings lie on it but for the quantised distances and the margin at the ends of
/// edges (0.5 % of 4 mm).
constexpr double kOnPlane_m = 30e-6;
constexpr double kFar_m = 10.0;

class SurfaceProbeTest : public ::testing::Test {
 protected:
  SurfaceProbeTest() { model_.AddPlane({0, 0, kPlate_m}, -Eigen::Vector3d::UnitZ()); }
  SurfaceProbe Probe() { return {model_.tsdf, model_.thermal, SurfaceOptions{}}; }
  PlateModel model_;
};

TEST_F(SurfaceProbeTest, ARayMeetsThePlaneWhereItMust) {
  SurfaceProbe probe = Probe();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.02, 0.17);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d target(place(random), place(random), kPlate_m);
    const Eigen::Vector3d origin(place(random), place(random), -0.3);
    const auto hit = probe.Cast({origin, target - origin}, kFar_m);
    ASSERT_TRUE(hit) << target.transpose();
    EXPECT_NEAR(hit->point.z(), kPlate_m, kOnPlane_m);
    EXPECT_NEAR((hit->point - target).head<2>().norm(), 0.0, 2.0 * kOnPlane_m);
    EXPECT_NEAR(hit->distance_m, (target - origin).norm(), 2.0 * kOnPlane_m);
    EXPECT_LT(hit->normal.z(), -0.999F);
  }
}

TEST_F(SurfaceProbeTest, ARayAlongTheBordersOfVoxelsAndBlocksFallsThroughNoCrack) {
  SurfaceProbe probe = Probe();
  constexpr double kHalf_m = kPlateVoxel_m / 2.0;
  for (int y = 8; y <= 80; ++y) {
    for (int x = 8; x <= 80; ++x) {
      const Eigen::Vector3d origin(kHalf_m * x, kHalf_m * y, -0.3);
      const auto hit = probe.Cast({origin, Eigen::Vector3d::UnitZ()}, kFar_m);
      ASSERT_TRUE(hit) << origin.transpose();
      EXPECT_NEAR(hit->point.z(), kPlate_m, kOnPlane_m);
    }
  }
}

TEST_F(SurfaceProbeTest, TheBackIsMetAsWell) {
  SurfaceProbe probe = Probe();
  const auto hit = probe.Cast({{0.1, 0.1, 0.18}, -Eigen::Vector3d::UnitZ()}, kFar_m);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->point.z(), kPlate_m, kOnPlane_m);
}

TEST_F(SurfaceProbeTest, ARayThatEndsBeforeOrPassesByMeetsNothing) {
  SurfaceProbe probe = Probe();
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, Eigen::Vector3d::UnitZ()}, kPlate_m - 0.001));
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, -Eigen::Vector3d::UnitZ()}, kFar_m));
  EXPECT_FALSE(probe.Cast({{0.5, 0.1, 0.0}, Eigen::Vector3d::UnitZ()}, kFar_m));
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, Eigen::Vector3d::UnitX()}, kFar_m));
}

TEST_F(SurfaceProbeTest, ARayWithoutDirectionOrNumbersMeetsNothing) {
  SurfaceProbe probe = Probe();
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, Eigen::Vector3d::Zero()}, kFar_m));
  EXPECT_FALSE(probe.Cast({{NAN, 0.1, 0.0}, Eigen::Vector3d::UnitZ()}, kFar_m));
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, {0.0, INFINITY, 1.0}}, kFar_m));
}

TEST_F(SurfaceProbeTest, ARayFromAnywhereIsCast) {
  SurfaceProbe probe = Probe();
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 1e300}, -Eigen::Vector3d::UnitZ()}, kFar_m));
  EXPECT_FALSE(probe.Cast({{-0.1, 0.1, 0.0}, {1e-310, 0.0, 1.0}}, kFar_m));
  EXPECT_FALSE(probe.Cast({{0.1, 0.1, 0.0}, Eigen::Vector3d::Constant(1e300)}, kFar_m));
}

TEST_F(SurfaceProbeTest, TheNearerOfTwoSurfacesIsMet) {
  // In front of a part of the wall, out of its truncation distance.
  testing::FillVolume(model_.tsdf, [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(0.1, 0.1, 0.04)).norm() - 0.02;
  });
  SurfaceProbe probe = Probe();
  const auto in_front = probe.Cast({{0.1, 0.1, -0.3}, Eigen::Vector3d::UnitZ()}, kFar_m);
  ASSERT_TRUE(in_front);
  // The sagitta of a sphere of 20 mm over the diagonal of a voxel's cube.
  constexpr double kBend_m = 3.0 * testing::kPlateVoxel_m * testing::kPlateVoxel_m / (8.0 * 0.02);
  EXPECT_NEAR(in_front->point.z(), 0.02, kBend_m);
}

}  // namespace
}  // namespace isotherm
