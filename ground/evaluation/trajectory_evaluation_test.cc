#include "ground/evaluation/trajectory_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr double kExact_m = 1e-9;
constexpr double kExact_rad = 1e-7;

RigidTransform SomeMotion() {
  return MakeTransform({0.3, -1.2, 2.0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                             1.1, Eigen::Vector3d(1, 2, -1).normalized())));
}

// A curve in space, 33 ms between poses.
std::vector<StampedPose> TruePath(int count) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i) {
    const double a = 0.05 * i;
    poses.push_back(
        {CaptureTime(milliseconds(1000 + 33 * i)),
         MakeTransform({0.3 * std::cos(a), 0.2 * std::sin(2 * a), 0.1 * a},
                       Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * a, Eigen::Vector3d::UnitY())))});
  }
  return poses;
}

std::vector<StampedPose> Moved(std::vector<StampedPose> poses, const RigidTransform& motion) {
  for (StampedPose& pose : poses) pose.T_world_depth = motion * pose.T_world_depth;
  return poses;
}

TEST(TrajectoryEvaluationTest, AnotherWorldIsNoError) {
  const std::vector<StampedPose> truth = TruePath(100);
  const auto errors = EvaluateTrajectory(Moved(truth, SomeMotion()), truth, {});
  ASSERT_TRUE(errors) << errors.error().message();
  EXPECT_EQ(errors->matched, 100U);
  EXPECT_NEAR(errors->aligned_m.max, 0.0, kExact_m);
  EXPECT_NEAR(errors->from_first_m.max, 0.0, kExact_m);
  EXPECT_NEAR(errors->aligned_rad.max, 0.0, kExact_rad);
  EXPECT_TRUE(errors->T_truth_world.isApprox(SomeMotion().inverse(), kExact_m));
}

TEST(TrajectoryEvaluationTest, ScaleIsAnError) {
  const std::vector<StampedPose> truth = TruePath(100);
  std::vector<StampedPose> scaled = truth;
  for (StampedPose& pose : scaled) pose.T_world_depth.translation() *= 1.1;
  EXPECT_GT(EvaluateTrajectory(scaled, truth, {})->aligned_m.rms, 0.01);
}

TEST(TrajectoryEvaluationTest, WhiteNoiseGivesItsOwnSize) {
  constexpr int kPoses = 3000;
  constexpr double kSigma_m = 0.002;
  constexpr double kStatistical = 0.05;  // Four standard deviations of the RMS of so many samples.
  const std::vector<StampedPose> truth = TruePath(kPoses);
  std::vector<StampedPose> noisy = Moved(truth, SomeMotion());
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, kSigma_m);
  for (StampedPose& pose : noisy) {
    pose.T_world_depth.translation() +=
        Eigen::Vector3d(noise(random), noise(random), noise(random));
  }
  const auto errors = EvaluateTrajectory(noisy, truth, {});
  const double expected = kSigma_m * std::sqrt(3.0);
  EXPECT_NEAR(errors->aligned_m.rms, expected, kStatistical * expected);
  // Median of a chi distribution with three degrees of freedom.
  EXPECT_NEAR(errors->aligned_m.median, 1.538 * kSigma_m, kStatistical * expected);
}

TEST(TrajectoryEvaluationTest, FromFirstPoseCountsWhatAlignmentHides) {
  const std::vector<StampedPose> truth = TruePath(100);
  std::vector<StampedPose> jumped = truth;
  for (std::size_t i = 1; i < jumped.size(); ++i) jumped[i].T_world_depth.translation().x() += 0.01;
  const auto errors = EvaluateTrajectory(jumped, truth, {});
  EXPECT_NEAR(errors->from_first_m.median, 0.01, kExact_m);
  EXPECT_LT(errors->aligned_m.median, 0.001);
}

TEST(TrajectoryEvaluationTest, StampsMatchWithinTheToleranceOnly) {
  const std::vector<StampedPose> truth = TruePath(10);
  std::vector<StampedPose> shifted = truth;
  for (StampedPose& pose : shifted) pose.time += std::chrono::microseconds(900);
  EXPECT_EQ(EvaluateTrajectory(shifted, truth, {})->matched, 10U);
  for (StampedPose& pose : shifted) pose.time += std::chrono::microseconds(200);
  const auto none = EvaluateTrajectory(shifted, truth, {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), testing::HasSubstr("same clock"));
  TrajectoryEvaluationOptions wide;
  wide.tolerance = milliseconds(5);
  EXPECT_EQ(EvaluateTrajectory(shifted, truth, wide)->matched, 10U);
  EXPECT_FALSE(EvaluateTrajectory({}, truth, {}));
}

TEST(TrajectoryEvaluationTest, LostFramesCountAsUnmatchedAndExtraOnesAsWithoutTruth) {
  const std::vector<StampedPose> truth = TruePath(20);
  std::vector<StampedPose> estimated = truth;
  estimated.erase(estimated.begin() + 3, estimated.begin() + 8);
  std::vector<StampedPose> sparse = truth;
  sparse.erase(sparse.begin() + 10);
  EXPECT_EQ(EvaluateTrajectory(estimated, truth, {})->matched, 15U);
  EXPECT_EQ(EvaluateTrajectory(truth, sparse, {})->without_truth, 1U);
}

TEST(TrajectoryEvaluationTest, OnlyTheFirstPosesAndNoRepeatsCount) {
  const std::vector<StampedPose> truth = TruePath(100);
  std::vector<StampedPose> estimated = truth;
  estimated[30].T_world_depth.translation().y() += 1.0;  // Left out as a repeat.
  estimated[70].T_world_depth.translation().y() += 1.0;  // Behind the first 50.
  TrajectoryEvaluationOptions options;
  options.first = 50;
  options.left_out = {truth[30].time};
  const auto errors = EvaluateTrajectory(estimated, truth, options);
  EXPECT_EQ(errors->truth_poses, 49U);
  EXPECT_EQ(errors->left_out, 1U);
  EXPECT_EQ(errors->matched, 49U);
  EXPECT_EQ(errors->without_truth, 0U);
  EXPECT_NEAR(errors->aligned_m.max, 0.0, kExact_m);
}

TEST(ErrorStatisticsTest, RanksAndRms) {
  std::vector<double> values;
  for (int i = 1; i <= 100; ++i) values.push_back(i);
  const ErrorStatistics s = Summarize(values);
  EXPECT_EQ(s.median, 50.0);
  EXPECT_EQ(s.p95, 95.0);
  EXPECT_EQ(s.max, 100.0);
  EXPECT_NEAR(s.rms, std::sqrt(338350.0 / 100.0), 1e-12);
  EXPECT_TRUE(std::isnan(Summarize({}).median));
}

}  // namespace
}  // namespace isotherm
