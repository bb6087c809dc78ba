// Tracking that knows when it is lost, and comes back: rows F52 to F55 of the failure catalogue on
// simulated scans with truth.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <numbers>
#include <random>
#include <utility>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/testing/temporary_directory.h"
#include "ground/model/saved_model.h"
#include "tests/integration/recovery_scan.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr double kFrame = 1.0 / 30.0;
constexpr double kWrongPose = 0.005;  // Metres: more than a voxel off.

using testing::RecoveryScan;

RigidTransform Rotated(double angle_deg, const Eigen::Vector3d& axis) {
  return MakeTransform(Eigen::Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(
                                                    angle_deg * kRadPerDeg, axis.normalized())));
}

class RecoveryTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 150;

  RecoveryTest() : staged_(MakeScene(SceneOptions())), scan_(staged_.scene, kSeed) {
    std::cout << "seed " << kSeed << '\n';
  }
  RigidTransform PoseAt(int frame) const { return staged_.path.PoseAt(kFrame * frame); }
  std::vector<RigidTransform> CheckPoses() const {
    std::vector<RigidTransform> poses;
    for (int i = 0; i < kFrames; i += 15) poses.push_back(PoseAt(i));
    return poses;
  }
  static void Print(const char* what, const RecoveryScan::ModelError& error) {
    std::cout << what << ": model median " << 1e3 * error.median_m << " mm, 95 % "
              << 1e3 * error.p95_m << " mm, covered " << 100.0 * error.covered << " %\n";
  }
  /// The path with `disturb` in the place of frame kDisturbed; it shows frames and returns the next
  /// frame to go on with.
  static constexpr int kDisturbed = 75;
  struct Outcome {
    int until_lost = -1;   ///< Wrong frames that passed for tracked before the loss was noticed.
    int fused_wrong = 0;   ///< Frames integrated at a wrong pose.
    int until_found = -1;  ///< Frames from the return to the path until fusion goes on.
    RecoveryScan::ModelError error;
  };
  using Disturbance = std::function<int(const std::function<DepthReport(const RigidTransform&)>&)>;
  Outcome Run(const Disturbance& disturb) {
    Outcome outcome;
    scan_.Start(PoseAt(0));
    bool disturbed = false;
    int frames_disturbed = 0;
    const auto show = [&](const RigidTransform& pose) {
      const DepthReport report = scan_.Show(pose);
      if (report.integrated && scan_.PositionError(pose) > kWrongPose) ++outcome.fused_wrong;
      if (disturbed) {
        if (!report.tracked && outcome.until_lost < 0) outcome.until_lost = frames_disturbed;
        ++frames_disturbed;
      }
      return report;
    };
    int next = 0;
    for (; next < kDisturbed; ++next) show(PoseAt(next));
    disturbed = true;
    next = disturb(show);
    disturbed = false;
    for (int i = next; i < kFrames; ++i) {
      const DepthReport report = show(PoseAt(i));
      if (report.tracked && outcome.until_found < 0) outcome.until_found = i - next;
    }
    outcome.error = scan_.CompareModel(CheckPoses());
    return outcome;
  }

  const StagedScene staged_;
  RecoveryScan scan_;
};

TEST_F(RecoveryTest, F52ACoveredCameraIsLostAndFindsItsWayBack) {
  const Outcome calm = Run([](const auto&) { return kDisturbed; });
  Print("undisturbed", calm.error);
  const Outcome outcome = Run([&](const auto&) {
    for (int i = 0; i < 30; ++i) EXPECT_FALSE(scan_.ShowCovered().tracked);
    return kDisturbed;
  });
  Print("covered for 1 s", outcome.error);
  EXPECT_EQ(outcome.fused_wrong, 0);
  EXPECT_LE(outcome.until_found, 30);
  EXPECT_GE(outcome.until_found, 0);
  EXPECT_LT(outcome.error.median_m, 1.1 * calm.error.median_m);
  EXPECT_LT(outcome.error.p95_m, 1.1 * calm.error.p95_m);
}

TEST_F(RecoveryTest, F52AJumpIsNoticedAndTheScanGoesOnWhenItIsBack) {
  const Outcome calm = Run([](const auto&) { return kDisturbed; });
  const RigidTransform jump = MakeTransform({0.2, 0.0, 0.0}, Eigen::Quaterniond::Identity()) *
                              Rotated(20.0, Eigen::Vector3d(0.2, 1.0, 0.1));
  const Outcome outcome = Run([&](const auto& show) {
    for (int i = 0; i < 15; ++i) show(PoseAt(kDisturbed + i) * jump);
    return kDisturbed + 15;
  });
  Print("jump of 20 cm and 20 degrees", outcome.error);
  std::cout << "lost after " << outcome.until_lost << " frames, found after " << outcome.until_found
            << '\n';
  EXPECT_GE(outcome.until_lost, 0);
  EXPECT_LE(outcome.until_lost, 3);
  EXPECT_EQ(outcome.fused_wrong, 0);
  EXPECT_GE(outcome.until_found, 0);
  EXPECT_LE(outcome.until_found, 30);
  EXPECT_LT(outcome.error.median_m, 1.1 * calm.error.median_m);
}

TEST_F(RecoveryTest, F52TwoSecondsMissingAreNoticedAndFoundAgain) {
  const Outcome outcome = Run([&](const auto&) { return kDisturbed + 60; });
  Print("2 s missing", outcome.error);
  std::cout << "found after " << outcome.until_found << " frames\n";
  EXPECT_EQ(outcome.fused_wrong, 0);
  EXPECT_GE(outcome.until_found, 0) << "the scan never comes back";
  EXPECT_LE(outcome.until_found, 30) << "a second";
}

TEST_F(RecoveryTest, F53AWhipPanIsNotFusedAtAWrongPose) {
  const Outcome calm = Run([](const auto&) { return kDisturbed; });
  const Outcome outcome = Run([&](const auto& show) {
    constexpr double kPerFrame = 90.0 * kFrame;
    for (int i = 1; i <= 30; ++i) {
      const double angle = kPerFrame * (i <= 15 ? i : 30 - i);
      show(PoseAt(kDisturbed) * Rotated(angle, Eigen::Vector3d::UnitY()));
    }
    return kDisturbed;
  });
  Print("whip pan of 90 degrees/s", outcome.error);
  std::cout << "lost after " << outcome.until_lost << " frames, found after " << outcome.until_found
            << '\n';
  EXPECT_EQ(outcome.fused_wrong, 0);
  EXPECT_GE(outcome.until_found, 0);
  EXPECT_LE(outcome.until_found, 30);
  EXPECT_LT(outcome.error.median_m, 1.1 * calm.error.median_m);
}

TEST_F(RecoveryTest, F55RandomStartsInAFinishedModelAreFoundAndNeverElsewhere) {
  scan_.Start(PoseAt(0));
  for (int i = 0; i < kFrames; ++i) scan_.Show(PoseAt(i));
  std::mt19937 random(kSeed);
  const auto uniform = [&](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(random);
  };
  constexpr int kStarts = 100;
  int found = 0;
  int wrong = 0;
  for (int start = 0; start < kStarts; ++start) {
    for (int i = 0; i < 3; ++i) scan_.ShowCovered();
    const int frame = std::uniform_int_distribution<int>(0, kFrames - 1)(random);
    Eigen::Vector3d shift;
    do shift = {uniform(0.15), uniform(0.15), uniform(0.15)};
    while (shift.norm() > 0.15);
    const Eigen::Vector3d axis(uniform(1.0), uniform(1.0), uniform(1.0));
    const RigidTransform pose =
        PoseAt(frame) * MakeTransform(shift, Eigen::Quaterniond(Eigen::AngleAxisd(
                                                 uniform(20.0 * kRadPerDeg), axis.normalized())));
    bool tracked = false;
    for (int i = 0; i < 30 && !tracked; ++i) tracked = scan_.Show(pose).tracked;
    if (!tracked) continue;
    if (scan_.PositionError(pose) > kWrongPose) {
      ++wrong;
    } else {
      ++found;
    }
  }
  std::cout << found << " of " << kStarts << " found, " << wrong << " found elsewhere\n";
  const StageStats& cost = *scan_.pipeline().model().stages[Stage::kRelocalise];
  std::cout << "a lost frame takes " << cost.Percentile(50) << " ms, 95 % " << cost.Percentile(95)
            << " ms\n";
  // 95 to 97 with several seeds; rounding differs between instruction sets.
  EXPECT_GE(found, 93);
  EXPECT_EQ(wrong, 0);
}

/// Close to the nearly flat door, one direction is observed weakly. It is observed: held to the
/// motion before, the rig would drift off by centimetres.
TEST_F(RecoveryTest, AWeaklyObservedDirectionIsMeasuredNotHeld) {
  constexpr int kFirst = 26 * 30;
  constexpr int kLast = 32 * 30;
  scan_.Start(PoseAt(kFirst));
  double most = 0.0;
  double min_strength = 1.0;
  for (int i = kFirst; i <= kLast; ++i) {
    const DepthReport report = scan_.Show(PoseAt(i));
    ASSERT_TRUE(report.tracked) << i;
    min_strength = std::min(min_strength, report.tracking.motion.strength(0));
    most = std::max(most, scan_.PositionError(PoseAt(i)));
  }
  std::cout << "weakest direction " << min_strength << ", largest error " << 1e3 * most
            << " mm, degraded " << scan_.pipeline().model().counts.depth_degraded << '\n';
  EXPECT_LT(min_strength, 0.001);
  EXPECT_LT(most, kWrongPose);
}

TEST_F(RecoveryTest, ASavedModelIsFoundAgainAndGoneOnWith) {
  const testing::TemporaryDirectory folder;
  scan_.Start(PoseAt(0));
  for (int i = 0; i < kFrames / 2; ++i) scan_.Show(PoseAt(i));
  const ScanModel saved = scan_.pipeline().model();
  ASSERT_TRUE(SaveSubMap(folder.path() / "model.iso", saved.atlas.active(), saved.rig).ok());
  const auto before = scan_.CompareModel(CheckPoses());

  // Another scan of the same place, from somewhere else on the way, without any initial pose.
  const auto model = ModelFile::Open(folder.path() / "model.iso");
  ASSERT_TRUE(model.has_value());
  scan_.Start(RigidTransform::Identity());
  ASSERT_TRUE(scan_.pipeline().Continue(**model).ok());
  int until_found = -1;
  for (int i = 0; i < kFrames; ++i) {
    const int frame = kFrames / 3 + i < kFrames ? kFrames / 3 + i : kFrames - 1;
    const DepthReport report = scan_.Show(PoseAt(frame));
    if (!report.tracked) continue;
    if (until_found < 0) until_found = i;
    ASSERT_LT(scan_.PositionError(PoseAt(frame)), kWrongPose) << frame;
  }
  const auto after = scan_.CompareModel(CheckPoses());
  std::cout << "found after " << until_found << " frames\n";
  Print("saved", before);
  Print("gone on with", after);
  EXPECT_GE(until_found, 0);
  EXPECT_LE(until_found, 30);
  EXPECT_GT(after.covered, before.covered);
  EXPECT_LT(after.median_m, 1.2 * before.median_m);
}

TEST(DegenerateSceneTest, F54ABarePlaneNeitherSlidesNorExplodes) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("wall", {-5.0, -5.0, 0.9}, {5.0, 5.0, 1.0});
  RecoveryScan scan(builder.Build("bare wall"), kSeed);
  VolumeOptions& volume = *scan.options().mutable_volume();
  volume.set_size_x_m(2.4);
  volume.mutable_expert()->set_min_x_m(-0.6);
  const auto pose = [](int i) {
    return MakeTransform({0.2 * kFrame * i, 0.5, 0.3}, Eigen::Quaterniond::Identity());
  };
  scan.Start(pose(0));
  constexpr int kSeconds = 5;
  int degraded = 0;
  for (int i = 0; i < 30 * kSeconds; ++i) {
    const DepthReport report = scan.Show(pose(i));
    ASSERT_TRUE(report.tracked) << i << ' ' << ToString(report.tracking.lost);
    if (report.tracking.quality() == TrackingQuality::kDegraded) ++degraded;
    // Nothing has ever held the rig: there is nothing that what is added could contradict.
    ASSERT_FALSE(report.slides) << i;
  }
  // Without any structure the velocity is not known either: the prior is at rest.
  const RigidTransform truth = pose(30 * kSeconds - 1);
  const RigidTransform& end = scan.pipeline().model().trajectory.poses().back().T_world_depth;
  const double prior_drift = (truth.translation() - pose(0).translation()).norm();
  const double drift = TranslationDistance(end, truth);
  std::cout << "drift " << 1e3 * drift << " mm of " << 1e3 * prior_drift << " mm, across "
            << 1e3 * std::abs(end.translation().z() - truth.translation().z()) << " mm, turned "
            << RotationAngle(end, truth) / kRadPerDeg << " degrees, degraded " << degraded << '\n';
  EXPECT_LE(drift, 1.02 * prior_drift);
  EXPECT_LT(std::abs(end.translation().z() - truth.translation().z()), 0.002);
  EXPECT_LT(RotationAngle(end, truth), 1.0 * kRadPerDeg);
  EXPECT_GE(degraded, 30 * kSeconds - 10);
  EXPECT_GT(scan.pipeline().model().uncertainty.surface_sigma_m(), drift / 3.0);
}

/// Away from balls and cartons along a bare wall, and back: what is seen where the rig may have
/// slid is not added, and the scan goes on where it is held again.
TEST(DegenerateSceneTest, F54WhereTheViewSlidesNothingIsAddedToTheModel) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("wall", {-5.0, -5.0, 0.9}, {5.0, 5.0, 1.0});
  builder.Sphere("ball", {0.0, 0.4, 0.85}, 0.10);
  builder.Sphere("lower ball", {0.15, 0.65, 0.88}, 0.08);
  builder.RotatedBox("carton", {-0.15, 0.6, 0.85}, {0.2, 0.15, 0.15}, {20, 30, 10});
  RecoveryScan scan(builder.Build("balls before a wall"), kSeed);
  VolumeOptions& volume = *scan.options().mutable_volume();
  volume.set_size_x_m(2.4);
  volume.mutable_expert()->set_min_x_m(-0.6);
  // Five seconds each way, slow enough to be integrated, with a rest at the turning point.
  constexpr int kFrames = 300;
  const auto pose = [](int i) {
    const double x = 0.45 * (1.0 - std::cos(2.0 * std::numbers::pi * i / kFrames));
    return MakeTransform({x, 0.5, 0.3}, Eigen::Quaterniond::Identity());
  };
  scan.Start(pose(0));
  const auto sum_of_voxels = [&scan] {
    const TsdfVolume& tsdf = scan.pipeline().model().tsdf();
    std::uint64_t sum = 0;
    for (std::int32_t block = 0; block < tsdf.block_count(); ++block) {
      for (const TsdfVoxel voxel : tsdf.voxels(block)) sum = 31 * sum + voxel.bits;
    }
    return sum;
  };
  int slid = 0, last_slid = 0, compared = 0;
  std::uint64_t sum = 0;
  for (int i = 0; i <= kFrames; ++i) {
    const DepthReport report = scan.Show(pose(i));
    if (!report.slides) continue;
    EXPECT_FALSE(report.integrated) << i;
    const std::uint64_t sum_before = std::exchange(sum, sum_of_voxels());
    if (slid > 0 && last_slid == i - 1) {
      EXPECT_EQ(sum, sum_before) << i;
      ++compared;
    }
    ++slid;
    last_slid = i;
  }
  const ScanCounts& counts = scan.pipeline().model().counts;
  std::cout << "slid in " << slid << " frames, the last " << last_slid << "; integrated "
            << counts.depth_integrated << ", off by " << 1e3 * scan.PositionError(pose(kFrames))
            << " mm in the end\n";
  EXPECT_GT(slid, 10);
  EXPECT_GT(compared, 5);
  EXPECT_EQ(counts.depth_uncertain, static_cast<std::uint64_t>(slid));
  EXPECT_LT(last_slid, kFrames - 10) << "held again";
  EXPECT_LT(scan.PositionError(pose(kFrames)), kWrongPose);
}

}  // namespace
}  // namespace isotherm
