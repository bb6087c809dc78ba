#include "ground/evaluation/thermal_coverage.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

namespace isotherm {
namespace {

/// A wall 0.6 m before the camera, 0.3 m x 0.2 m, and a plate 0.1 m wide 0.1 m before its middle.
class ThermalCoverageTest : public ::testing::Test {
 protected:
  static constexpr float kSpacing_m = 0.002F;

  ThermalCoverageTest() : camera_{160, 120, 150.0, 150.0, 79.5, 59.5} {
    TruePoints points;
    AddPlate(0.15F, 0.6F, points);
    AddPlate(0.05F, 0.5F, points);
    truth_.emplace(std::move(points));
  }
  static void AddPlate(float half_width_m, float z, TruePoints& points) {
    for (float x = -half_width_m; x <= half_width_m; x += kSpacing_m) {
      for (float y = -0.1F; y <= 0.1F; y += kSpacing_m) {
        points.positions_m.emplace_back(x, y, z);
        points.normals.emplace_back(0.0F, 0.0F, -1.0F);
        points.primitive.push_back(0);
      }
    }
  }
  ThermalCoverage Evaluate(const WellSeenLimits& limits = {}) {
    return EvaluateThermalCoverage(*truth_, {camera_, poses_}, {&limits, 1}, {assigned_, 0.003F},
                                   pool_)
        .front();
  }
  std::size_t EvaluateFrom(std::size_t pose) {
    const WellSeenLimits limits;
    return EvaluateThermalCoverage(*truth_, {camera_, {&poses_[pose], 1}}, {&limits, 1},
                                   {assigned_, 0.003F}, pool_)
        .front()
        .well_seen;
  }
  double Fraction(std::size_t count) const {
    return static_cast<double>(count) / static_cast<double>(truth_->points().positions_m.size());
  }

  CameraModel camera_;
  std::vector<RigidTransform> poses_{RigidTransform::Identity()};
  AssignedPoints assigned_;
  ThreadPool pool_{2};
  std::optional<TrueSurface> truth_;
};

constexpr double kEdges = 0.02;  // Half a pixel along silhouettes, of 0.3 m.

TEST_F(ThermalCoverageTest, WhatAForegroundHidesDoesNotCount) {
  // The plate hides 0.12 m of the wall's 0.3 m; both together are 0.4 m wide.
  EXPECT_NEAR(Fraction(Evaluate().well_seen), 0.28 / 0.4, kEdges);
  EXPECT_EQ(Evaluate().covered, 0U);
  poses_.push_back(MakeTransform(
      {0.5, 0.0, 0.2}, Eigen::Quaterniond(Eigen::AngleAxisd(-0.9, Eigen::Vector3d::UnitY()))));
  EXPECT_GT(Fraction(Evaluate().well_seen), 0.85) << "another pose sees behind it";
}

TEST_F(ThermalCoverageTest, ALensDecidesWhatIsInTheImage) {
  // The wall ends at x = 0.15 m / 0.6 m = 0.25, the image without a lens at 79.5 / 360 = 0.22.
  camera_.fx = 360.0;
  camera_.fy = 280.0;
  const auto seen = [&](double k1) {
    camera_.k1 = k1;
    return Fraction(Evaluate().well_seen);
  };
  const double without = seen(0.0);
  EXPECT_NEAR(without, (0.28 - 2.0 * (0.15 - 0.6 * 0.221)) / 0.4, kEdges);
  // 0.25 (1 - 2.2 * 0.25^2) = 0.216: all of the wall's width.
  EXPECT_NEAR(seen(-2.2), 0.28 / 0.4, kEdges) << "a barrel lens sees more";
  EXPECT_LT(seen(2.2), without - 2.0 * kEdges) << "and a pincushion lens less";
}

TEST_F(ThermalCoverageTest, WhatThePolynomialFoldsBackIsNotSeen) {
  TruePoints wall;
  AddPlate(0.15F, 0.6F, wall);
  truth_.emplace(std::move(wall));
  // x (1 - 20 x^2) is 79.5 / 1500 first at x = 0.057, and is 0 again at x = 0.22. In height it is
  // 59.5 / 1500 at 0.041.
  camera_.k1 = -20.0;
  camera_.fx = camera_.fy = 1500.0;
  EXPECT_NEAR(Fraction(Evaluate().well_seen), 4.0 * 0.034 * 0.025 / 0.06, kEdges);
}

TEST_F(ThermalCoverageTest, DistanceAndAngleLimitWhatCounts) {
  EXPECT_NEAR(Fraction(Evaluate({.max_distance_m = 0.55}).well_seen), 0.1 / 0.4, kEdges);
  EXPECT_NEAR(Fraction(Evaluate({.min_distance_m = 0.55}).well_seen), 0.18 / 0.4, kEdges);
  const std::size_t frontal = Evaluate({.max_angle_deg = 5.0}).well_seen;
  EXPECT_LT(frontal, Evaluate().well_seen / 2);
  EXPECT_EQ(Evaluate({.min_angle_deg = 5.0}).well_seen, Evaluate().well_seen - frontal);
}

TEST_F(ThermalCoverageTest, CoveredIsWhatHasAnAssignedPointNearBy) {
  for (const Eigen::Vector3f& p : truth_->points().positions_m) {
    if (p.z() > 0.55F) continue;
    assigned_.positions_m.push_back(p + Eigen::Vector3f(0.001F, 0.0F, 0.001F));
    assigned_.good.push_back(p.x() < 0.0F);
  }
  const ThermalCoverage coverage = Evaluate();
  EXPECT_NEAR(Fraction(coverage.covered), 0.1 / 0.4, kEdges);
  EXPECT_NEAR(Fraction(coverage.measured_well), 0.05 / 0.4, kEdges) << "half of them was good";
}

TEST_F(ThermalCoverageTest, WhatOnePoseSawDoesNotCountAsSeenTwice) {
  const std::size_t once = Evaluate().well_seen;
  EXPECT_EQ(Evaluate({.min_poses = 2}).well_seen, 0U);
  poses_.push_back(RigidTransform::Identity());
  EXPECT_EQ(Evaluate({.min_poses = 2}).well_seen, once);
  // Seen by one or the other and seen by both are together what each one sees.
  poses_.back() = MakeTransform({0.25, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  const std::size_t twice = Evaluate({.min_poses = 2}).well_seen;
  EXPECT_LT(twice, Evaluate().well_seen);
  EXPECT_EQ(Evaluate().well_seen + twice, once + EvaluateFrom(1));
}

}  // namespace
}  // namespace isotherm
