// Drift that is measured and spread when the rig comes back, and sub-maps that are joined, on
// simulated scans with truth.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"
#include "tests/integration/recovery_scan.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 5;
constexpr double kOrbitRadius_m = 0.8;
constexpr double kDegPerFrame = 0.6;  // At most, to be integrated (thesis 6.1.3).
const Eigen::Vector3d kCentre(0.48, 0.48, 0.48);

using testing::RecoveryScan;

/// A pump on its base, all around different.
Scene MachineScene() {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("base", {0.20, 0.66, 0.22}, {0.76, 0.72, 0.72});
  builder.Cylinder("housing", {0.30, 0.50, 0.46}, {0.62, 0.50, 0.46}, 0.13);
  builder.Sphere("end", {0.62, 0.50, 0.46}, 0.12);
  builder.RotatedBox("motor", {0.30, 0.44, 0.50}, {0.18, 0.26, 0.22}, {10, 25, 5});
  builder.Cylinder("pipe", {0.52, 0.50, 0.40}, {0.56, 0.22, 0.34}, 0.04);
  builder.RotatedBox("valve", {0.56, 0.24, 0.36}, {0.12, 0.10, 0.09}, {0, 35, 0});
  builder.Box("panel", {0.34, 0.30, 0.62}, {0.54, 0.66, 0.66});
  return builder.Build("machine");
}

/// Around the centre, a little from above, looking at it.
RigidTransform OrbitPose(double angle_deg) {
  const double a = angle_deg * kRadPerDeg;
  const Eigen::Vector3d position =
      kCentre + kOrbitRadius_m * Eigen::Vector3d(std::sin(a), -0.35, -std::cos(a)).normalized();
  const Eigen::Vector3d forward = (kCentre - position).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(0, 1, 0).cross(forward).normalized();
  Eigen::Matrix3d R;
  R << right, forward.cross(right), forward;
  return MakeTransform(position, Eigen::Quaterniond(R));
}

class DriftTest : public ::testing::Test {
 protected:
  DriftTest() : scan_(MachineScene(), kSeed) { std::cout << "seed " << kSeed << '\n'; }

  /// The finished model against truth, from all around.
  RecoveryScan::ModelError FinishAndCompare(const char* what) {
    scan_.pipeline().Finish();
    std::vector<RigidTransform> views;
    for (int i = 0; i < 12; ++i) views.push_back(OrbitPose(30.0 * i));
    const auto error = scan_.CompareModel(views);
    std::cout << what << ": model median " << 1e3 * error.median_m << " mm, 95 % "
              << 1e3 * error.p95_m << " mm, covered " << 100.0 * error.covered << " %\n";
    return error;
  }

  RecoveryScan scan_;
};

TEST_F(DriftTest, AnOrbitIsClosedAndTheGapIsSpread) {
  constexpr int kFrames = 640;  // 384 degrees: the closure needs two looks.
  scan_.Start(OrbitPose(0.0));
  GroundPipeline& pipeline = scan_.pipeline();
  double error_before_m = 0.0;  // Of the pose in world, just before the closure, ...
  double error_after_m = 0.0;   // ... and at the end.
  for (int i = 0; i < kFrames; ++i) {
    const RigidTransform pose = OrbitPose(kDegPerFrame * i);
    ASSERT_TRUE(scan_.Show(pose).tracked) << i;
    error_after_m = scan_.PositionError(pose);
    if (pipeline.model().atlas.drift().closures == 0) error_before_m = error_after_m;
  }
  const DriftReport& drift = pipeline.model().atlas.drift();
  std::cout << pipeline.model().atlas.size() << " sub-maps, " << drift.closures
            << " closures, missed by " << 1e3 * drift.largest_gap_m << " mm; position off by "
            << 1e3 * error_before_m << " mm before, " << 1e3 * error_after_m << " mm after\n";
  ASSERT_GE(drift.closures, 1U);
  constexpr double kGapLeft = 0.3;
  EXPECT_LE(error_after_m, kGapLeft * error_before_m);
  const auto closed = FinishAndCompare("closed");
  EXPECT_EQ(pipeline.model().atlas.size(), 1);
  // What the trajectory says about the past has moved too.
  double worst_m = 0.0;
  for (const StampedPose& pose : pipeline.model().trajectory.poses()) {
    const double i =
        std::round(30.0 * (1e-9 * static_cast<double>(ToNanoseconds(pose.time)) - 100.0));
    worst_m =
        std::max(worst_m, TranslationDistance(pose.T_world_depth, OrbitPose(kDegPerFrame * i)));
  }
  std::cout << "worst pose " << 1e3 * worst_m << " mm\n";
  EXPECT_LT(worst_m, error_before_m);

  constexpr double kQuarterVoxel_m = 0.001;
  EXPECT_LT(closed.median_m, kQuarterVoxel_m);
  EXPECT_GT(closed.covered, 0.9);
}

/// The rig comes out of the dark somewhere else, goes on there, and later sees both.
TEST_F(DriftTest, AScanThatGoesOnElsewhereIsJoinedWhenBothAreSeen) {
  scan_.options().mutable_submaps()->mutable_expert()->set_start_after_lost_s(1.0);
  scan_.Start(OrbitPose(0.0));
  GroundPipeline& pipeline = scan_.pipeline();
  int i = 0;
  for (; kDegPerFrame * i < 40.0; ++i) ASSERT_TRUE(scan_.Show(OrbitPose(kDegPerFrame * i)).tracked);
  for (int covered = 0; covered < 10; ++covered) scan_.ShowCovered();
  // The far side: nothing of it was seen yet.
  double angle_deg = 170.0;
  int lost = 0;
  while (pipeline.model().atlas.size() == 1 && lost++ < 60) scan_.Show(OrbitPose(angle_deg));
  ASSERT_EQ(pipeline.model().atlas.size(), 2);
  EXPECT_FALSE(pipeline.model().atlas.map(1).joined);
  const std::size_t before = pipeline.model().trajectory.poses().size();
  int elsewhere = 0;
  for (; angle_deg > 0.0 && !pipeline.model().atlas.map(1).joined; angle_deg -= kDegPerFrame) {
    ASSERT_TRUE(scan_.Show(OrbitPose(angle_deg)).tracked) << angle_deg;
    ++elsewhere;
  }
  ASSERT_TRUE(pipeline.model().atlas.map(1).joined);
  std::cout << "joined at " << angle_deg << " degrees, position off by "
            << 1e3 * scan_.PositionError(OrbitPose(angle_deg + kDegPerFrame)) << " mm\n";
  // All that was tracked meanwhile has its place now.
  EXPECT_GE(pipeline.model().trajectory.poses().size(),
            before + static_cast<std::size_t>(elsewhere));
  EXPECT_LT(scan_.PositionError(OrbitPose(angle_deg + kDegPerFrame)), 0.005);
  const auto error = FinishAndCompare("joined");
  EXPECT_EQ(pipeline.model().atlas.size(), 1);
  EXPECT_LT(error.median_m, 0.002);
}

}  // namespace
}  // namespace isotherm
