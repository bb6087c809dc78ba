// Odometry poses while the depth camera scans simulated scenes with truth: what they are worth
// in front of a bare plane, that they change nothing where geometry is rich, and that bad ones do
// no harm.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"
#include "tests/integration/recovery_scan.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 17;
constexpr double kFrame = 1.0 / 30.0;

using testing::RecoveryScan;
using Path = std::function<RigidTransform(double seconds)>;
using Spoil = std::function<void(ExternalOdometry&)>;

/// Odometry at 100 Hz with a scale error and jitter, in a reference frame of its own.
class Odometry {
 public:
  static constexpr double kScale = 1.01;
  static constexpr double kPositionSigma = 0.0005;  // Metres.
  static constexpr double kRotationSigma = 0.02 * kRadPerDeg;
  static constexpr double kPeriod = 0.01;

  explicit Odometry(Path path) : path_(std::move(path)) {}

  /// Samples up to `until` seconds of the path, whose start is at `start`; `spoil` may change them.
  void FeedUntil(double until, CaptureTime start, GroundPipeline& pipeline, const Spoil& spoil) {
    for (; kPeriod * next_ <= until; ++next_) {
      ExternalOdometry sample = Sample(kPeriod * next_);
      sample.time = start + FromSeconds(kPeriod * next_);
      if (spoil) spoil(sample);
      pipeline.ProcessExternalOdometry(sample);
    }
  }
  /// The motion since the start is too long by the scale error.
  RigidTransform Seen(double seconds) const {
    RigidTransform motion = path_(0.0).inverse() * path_(seconds);
    motion.translation() *= kScale;
    return path_(0.0) * motion;
  }

 private:
  ExternalOdometry Sample(double seconds) {
    const RigidTransform T_reference_world = MakeTransform(
        {4.0, -7.0, 1.0},
        Eigen::Quaterniond(Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 2, -1).normalized())));
    const auto jitter = [this](double sigma) {
      return Eigen::Vector3d::NullaryExpr([&] { return sigma * normal_(random_); }).eval();
    };
    const RigidTransform pose = T_reference_world * Seen(seconds);
    const Eigen::Vector3d rotation = jitter(kRotationSigma);
    ExternalOdometry sample;
    sample.source = "odometry";
    sample.translation_m = pose.translation() + jitter(kPositionSigma);
    sample.rotation = Eigen::Quaterniond(pose.linear()) *
                      Eigen::Quaterniond(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()));
    sample.position_sigma_m = kPositionSigma;
    sample.rotation_sigma_rad = kRotationSigma;
    return sample;
  }

  const Path path_;
  std::mt19937 random_{kSeed};
  std::normal_distribution<double> normal_;
  int next_ = 0;
};

class ExternalOdometryTest : public ::testing::Test {
 protected:
  ExternalOdometryTest() { std::cout << "seed " << kSeed << '\n'; }

  struct Outcome {
    double largest_error_m = 0.0;
    double end_error_m = 0.0;
    double end_rotation_rad = 0.0;
    double across_m = 0.0;      ///< Error of the end, along z.
    double end_sigma_m = 0.0;   ///< The tracker's own sigma at the end.
    double off_source_m = 0.0;  ///< Largest distance from where the source says.
    int lost = 0;
    OdometryPriorCounts used;
    OdometryStreamCounts samples;
  };
  /// Scans along `path`; with `odometry`, what that says reaches the pipeline just in time.
  static Outcome Scan(RecoveryScan& scan, const Path& path, int frames, bool with_odometry,
                      const Spoil& spoil = {}) {
    Outcome outcome;
    Odometry odometry(path);
    scan.Start(path(0.0));
    const CaptureTime start = scan.next_time();
    for (int i = 0; i < frames; ++i) {
      const RigidTransform truth = path(kFrame * i);
      if (with_odometry) odometry.FeedUntil(kFrame * i, start, scan.pipeline(), spoil);
      if (!scan.Show(truth).tracked) {
        ++outcome.lost;
        continue;
      }
      outcome.end_error_m = scan.PositionError(truth);
      outcome.largest_error_m = std::max(outcome.largest_error_m, outcome.end_error_m);
      outcome.off_source_m =
          std::max(outcome.off_source_m, scan.PositionError(odometry.Seen(kFrame * i)));
    }
    const RigidTransform& end = scan.pipeline().model().trajectory.poses().back().T_world_depth;
    const RigidTransform truth = path(kFrame * (frames - 1));
    outcome.end_rotation_rad = RotationAngle(end, truth);
    outcome.across_m = std::abs(end.translation().z() - truth.translation().z());
    outcome.end_sigma_m = scan.pipeline().model().trajectory.sigmas().back().translation_m;
    outcome.used = scan.pipeline().model().external_odometry.counts();
    outcome.samples = scan.pipeline().model().external_odometry.stream().counts();
    return outcome;
  }
  static void Print(const char* what, const Outcome& outcome) {
    std::cout << what << ": off by " << 1e3 * outcome.largest_error_m << " mm at worst, "
              << 1e3 * outcome.end_error_m << " mm in the end (sigma " << 1e3 * outcome.end_sigma_m
              << " mm), across " << 1e3 * outcome.across_m << " mm, turned "
              << outcome.end_rotation_rad / kRadPerDeg << " degrees, lost " << outcome.lost
              << "; poses used by " << outcome.used.used << " frames, missing "
              << outcome.used.missing << ", contradicted " << outcome.used.contradicted << '\n';
  }
};

/// Nothing but a wall; with `boxes` before its first part.
Scene Wall(bool boxes) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("wall", {-5.0, -5.0, 0.9}, {5.0, 5.0, 1.0});
  if (boxes) {
    builder.Box("upper box", {-0.25, 0.2, 0.8}, {0.0, 0.45, 0.95});
    builder.Box("lower box", {-0.15, 0.6, 0.75}, {0.1, 0.8, 0.95});
  }
  return builder.Build("wall");
}

void MakeRoom(RecoveryScan& scan) {
  VolumeOptions& volume = *scan.options().mutable_volume();
  volume.set_size_x_m(2.4);
  volume.mutable_expert()->set_min_x_m(-0.6);
  volume.set_size_y_m(1.4);
  volume.mutable_expert()->set_min_y_m(-0.2);
}

/// Along the wall at 0.2 m/s on average, with a velocity that never stays.
RigidTransform Swaying(double t) {
  return MakeTransform(
      {0.2 * t + 0.03 * std::sin(4.0 * t), 0.5 + 0.05 * (1.0 - std::cos(3.0 * t)), 0.3},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.05 * std::sin(2.0 * t), Eigen::Vector3d::UnitZ())));
}

TEST_F(ExternalOdometryTest, InFrontOfABarePlaneTheDriftIsThatOfTheSource) {
  RecoveryScan scan(Wall(false), kSeed);
  MakeRoom(scan);
  constexpr int kFrames = 150;
  const Outcome without = Scan(scan, Swaying, kFrames, false);
  Print("without", without);
  const Outcome with = Scan(scan, Swaying, kFrames, true);
  Print("with", with);
  const double way =
      (Swaying(kFrame * (kFrames - 1)).translation() - Swaying(0).translation()).norm();
  EXPECT_GT(without.end_error_m, 0.9 * way) << "constant velocity starts at rest and stays";
  EXPECT_EQ(with.lost, 0);
  // Where the source says, but for its jitter: three sigmas in each direction, of both ends.
  EXPECT_LT(with.off_source_m, 3.0 * std::sqrt(6.0) * Odometry::kPositionSigma);
  EXPECT_LT(with.end_error_m, 1.2 * (Odometry::kScale - 1.0) * way + 0.003);
  EXPECT_LT(with.across_m, 0.002) << "what is observed is measured";
  EXPECT_LT(with.end_rotation_rad, 0.3 * kRadPerDeg);
  EXPECT_GE(with.used.used, static_cast<std::uint64_t>(kFrames - 3));
  // Its uncertainty is honest: 2 % drift is assumed, 1 % is there.
  EXPECT_GT(with.end_sigma_m, with.end_error_m / 3.0);
  EXPECT_LT(with.end_sigma_m, 0.1 * without.end_sigma_m);
}

/// Constant velocity is known from the boxes, and wrong soon after.
TEST_F(ExternalOdometryTest, BehindTheLastStructureConstantVelocityIsWrongAndTheSourceIsNot) {
  RecoveryScan scan(Wall(true), kSeed);
  MakeRoom(scan);
  constexpr int kFrames = 120;
  const Outcome without = Scan(scan, Swaying, kFrames, false);
  Print("without", without);
  const Outcome with = Scan(scan, Swaying, kFrames, true);
  Print("with", with);
  EXPECT_EQ(with.lost, 0);
  EXPECT_GT(without.largest_error_m, 0.03);
  EXPECT_LT(with.largest_error_m, 0.015);
  EXPECT_EQ(with.used.contradicted, 0U);
}

/// A source that goes through the wall while the camera measures its distance to it.
TEST_F(ExternalOdometryTest, ASourceThatContradictsTheCameraIsNotUsed) {
  RecoveryScan scan(Wall(false), kSeed);
  MakeRoom(scan);
  constexpr int kFrames = 30;
  const Outcome without = Scan(scan, Swaying, kFrames, false);
  Print("without", without);
  // In its own reference frame the source runs away at 0.3 m/s along one of its axes.
  CaptureTime first{};
  const Outcome with = Scan(scan, Swaying, kFrames, true, [&](ExternalOdometry& sample) {
    if (first == CaptureTime{}) first = sample.time;
    const double seconds = ToSeconds(sample.time - first);
    // World's z in the reference frame.
    const Eigen::Vector3d z =
        Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 2, -1).normalized()) * Eigen::Vector3d::UnitZ();
    sample.translation_m += 0.3 * seconds * z;
  });
  Print("with", with);
  EXPECT_EQ(with.lost, 0);
  EXPECT_GT(with.used.contradicted, 10U);
  EXPECT_EQ(with.used.used, 0U) << "the first motion shows it";
  // Other noise in the second run's images; otherwise tracked as without the source.
  EXPECT_NEAR(with.end_error_m, without.end_error_m, 0.001);
}

class FurnaceDoorTest : public ExternalOdometryTest {
 protected:
  static constexpr int kFrames = 60;
  FurnaceDoorTest() : staged_(MakeScene(SceneOptions())), scan_(staged_.scene, kSeed) {}
  Path path() const {
    return [this](double seconds) { return staged_.path.PoseAt(seconds); };
  }
  const StagedScene staged_;
  RecoveryScan scan_;
};

/// Tolerance: the tracker's own repeatability with another start of its iterations.
constexpr double kRepeatability = 0.0005;

TEST_F(FurnaceDoorTest, WhereGeometryIsRichNothingChanges) {
  const Outcome without = Scan(scan_, path(), kFrames, false);
  Print("without", without);
  const Outcome with = Scan(scan_, path(), kFrames, true);
  Print("with", with);
  EXPECT_EQ(with.lost, 0);
  EXPECT_LT(with.largest_error_m, without.largest_error_m + kRepeatability);
  EXPECT_EQ(with.used.contradicted, 0U);
  EXPECT_GE(with.used.used, static_cast<std::uint64_t>(kFrames - 3));
}

TEST_F(FurnaceDoorTest, F54BadPosesAreRefusedByReasonAndTheScanGoesOn) {
  const Outcome without = Scan(scan_, path(), kFrames, false);
  Print("without", without);
  int index = 0;
  const Outcome with = Scan(scan_, path(), kFrames, true, [&](ExternalOdometry& sample) {
    const int i = index++;
    if (i % 20 == 3) sample.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
    if (i % 20 == 7) sample.rotation.coeffs() *= 0.5;
    if (i % 20 == 11) sample.translation_m.y() += 0.7;
    if (i % 20 == 15) sample.time -= std::chrono::milliseconds(30);
    if (i >= 120 && i < 150) sample.source = "another";  // And so a gap of 0.3 s.
  });
  Print("with", with);
  std::uint64_t refused = 0;
  for (const OdometryFault fault : AllValues<OdometryFault>()) {
    std::cout << ToString(fault) << ' ' << with.samples.refused[fault] << '\n';
    refused += with.samples.refused[fault];
  }
  EXPECT_EQ(with.lost, 0);
  EXPECT_LT(with.largest_error_m, without.largest_error_m + kRepeatability);
  for (const OdometryFault fault : {OdometryFault::kNotFinite, OdometryFault::kQuaternion,
                                    OdometryFault::kJump, OdometryFault::kTime})
    EXPECT_GE(with.samples.refused[fault], 1U) << ToString(fault);
  EXPECT_EQ(with.samples.refused[OdometryFault::kOtherSource], 30U);
  EXPECT_EQ(with.samples.gaps, 1U);
  EXPECT_GE(with.used.missing, 5U);
  EXPECT_EQ(with.samples.restarts, 0U);
  EXPECT_EQ(with.samples.in, with.samples.accepted + refused);
}

/// 15 cm within a frame, in a stream that has no other flaw, and faster than any start of the
/// tracker can bridge.
TEST_F(FurnaceDoorTest, F52AStreamThatLeapsDoesNotTakeTheScanAlong) {
  scan_.options()
      .mutable_tracker()
      ->mutable_external_odometry()
      ->mutable_expert()
      ->set_max_speed_m_s(50.0);
  int index = 0;
  const Outcome with = Scan(scan_, path(), kFrames, true, [&](ExternalOdometry& sample) {
    if (index++ >= 100) sample.translation_m.x() += 0.15;
  });
  Print("with", with);
  EXPECT_EQ(with.lost, 0);
  EXPECT_EQ(with.used.contradicted, 1U);
  EXPECT_LT(with.largest_error_m, 0.003);
}

}  // namespace
}  // namespace isotherm
