#include "ground/calibration/find_delay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "common/base/noise.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

constexpr CaptureTime kStart{std::chrono::seconds(100)};
constexpr int kWidth = 160, kHeight = 120;
constexpr double kFocal_px = 150.0;

// The poses here do not lag; what is left is their noise and the pixels'.
constexpr double kTolerance_s = 0.0003;
constexpr double kWanderMemory_s = 4.0;

/// Holds what is simulated beside the delay.
struct Disturbances {
  std::uint64_t seed = 1;
  double pixel_noise_k = 0.05;
  double pose_noise_m = 0.0001;
  double pose_drift = 0.0;  ///< Poses fall short of the rig's way from its start by this fraction.
  double hurry = 1.0;       ///< The rig swings so many times as fast.
  double travel_m = 0.0;    ///< It goes so far to either side slowly, beside its swing.
  double wander_m = 0.0;    ///< Poses wander by this, one sigma along x and y, within seconds.
};

/// Where the rig is along the wall, beside its swing.
double AlongWall(double time_s, double travel_m) { return travel_m * std::sin(0.4 * time_s); }

/// A wall at z = 1 m with a wavy temperature; the rig swings in front of it, and goes along it.
RigidTransform PoseAt(double time_s, double travel_m = 0.0) {
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Eigen::Vector3d(0.08 * std::sin(2.4 * time_s), 0.05 * std::sin(3.1 * time_s),
                                       0.05 * std::sin(0.9 * time_s));
  pose.translation().x() += AlongWall(time_s, travel_m);
  pose.linear() =
      Eigen::AngleAxisd(0.1 * std::sin(1.3 * time_s), Eigen::Vector3d::UnitZ()).matrix();
  return pose;
}

double Celsius(double x_m, double y_m) {
  return 40.0 + 5.0 * std::sin(60.0 * x_m) * std::cos(45.0 * y_m);
}

/// The wall's temperature by the exact line of sight of each pixel.
Image<std::uint16_t> Render(double time_s, const Disturbances& disturbances) {
  const RigidTransform T_world_thermal = PoseAt(time_s, disturbances.travel_m);
  const std::uint64_t stream =
      NoiseStream(disturbances.seed, 1, std::bit_cast<std::uint64_t>(time_s));
  Image<std::uint16_t> image(kWidth, kHeight);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray =
          T_world_thermal.linear() *
          Eigen::Vector3d((u - 80.0) / kFocal_px, (v - 60.0) / kFocal_px, 1.0);
      const Eigen::Vector3d& from = T_world_thermal.translation();
      const Eigen::Vector3d p = from + ray * (1.0 - from.z()) / ray.z();
      const double noise_k = disturbances.pixel_noise_k *
                             NormalNoise(stream, static_cast<std::uint64_t>(v * kWidth + u));
      const double celsius = Celsius(p.x(), p.y()) + noise_k;
      image.At(u, v) = static_cast<std::uint16_t>(std::lround(100.0 * (celsius + 273.15)));
    }
  }
  return image;
}

/// All that a scan of 10 s offers whose thermal stamps need `delay_s` to be added.
ScanViews SwingInFrontOfAWall(double delay_s, const Disturbances& disturbances = {}) {
  ScanViews views;
  views.thermal_camera = {
      .width = kWidth, .height = kHeight, .fx = kFocal_px, .fy = kFocal_px, .cx = 80, .cy = 60};
  views.pose_drift_m = disturbances.wander_m;
  const double kept = std::exp(-1.0 / (30.0 * kWanderMemory_s));
  const std::uint64_t wandering = NoiseStream(disturbances.seed, 4, 0);
  Eigen::Vector2d wander_m = Eigen::Vector2d::Zero();
  for (int i = 0; i < 300; ++i) {
    RigidTransform pose = PoseAt(disturbances.hurry * i / 30.0, disturbances.travel_m);
    const auto counter = 2 * static_cast<std::uint64_t>(i);
    const Eigen::Vector2d drawn(NormalNoise(wandering, counter),
                                NormalNoise(wandering, counter + 1));
    wander_m = i == 0 ? Eigen::Vector2d(disturbances.wander_m * drawn)
                      : Eigen::Vector2d(kept * wander_m + disturbances.wander_m *
                                                              std::sqrt(1.0 - kept * kept) * drawn);
    pose.translation().head<2>() += wander_m;
    pose.translation() -= disturbances.pose_drift *
                          (pose.translation() - PoseAt(0.0, disturbances.travel_m).translation());
    const std::uint64_t stream = NoiseStream(disturbances.seed, 2, static_cast<std::uint64_t>(i));
    for (int axis = 0; axis < 3; ++axis)
      pose.translation()[axis] +=
          disturbances.pose_noise_m * NormalNoise(stream, static_cast<std::uint64_t>(axis));
    views.trajectory.push_back({kStart + FromSeconds(i / 30.0), pose});
  }
  for (std::uint64_t i = 0; i < 800; ++i) {
    const double x_m = (0.7 + 2.0 * disturbances.travel_m) * (UniformNoise(1, 2 * i) - 0.5);
    const double y_m = 0.5 * (UniformNoise(1, 2 * i + 1) - 0.5);
    views.points.push_back({{x_m, y_m, 1.0}, -Eigen::Vector3d::UnitZ()});
  }
  for (int i = 10; i < 390; i += 3) {
    const double time_s = i / 40.0, stamp_s = time_s - delay_s;
    views.frames.push_back({kStart + FromSeconds(stamp_s),
                            std::make_shared<const Image<std::uint16_t>>(
                                Render(disturbances.hurry * time_s, disturbances)),
                            kCentikelvin,
                            {}});
    // Poses are known for all delays that are tried, and points before the rig stay in the image.
    if (stamp_s < 0.2 || stamp_s > 9.75) continue;
    const double along_m = AlongWall(disturbances.hurry * time_s, disturbances.travel_m);
    for (std::uint32_t point = 0; point < views.points.size(); ++point) {
      if (std::abs(views.points[point].p_world.x() - along_m) <= 0.35)
        views.frames.back().visible.push_back(point);
    }
  }
  return views;
}

Result<DelayEstimate> Find(const ScanViews& views, const FindDelayOptions& options = {}) {
  ThreadPool pool(2);
  return FindDelay(views, options, pool, {});
}

TEST(FindDelayTest, SeveralDelaysAreFoundWithinTheirUncertainty) {
  Disturbances disturbances;
  for (const double delay_s : {-0.0427, -0.1, 0.0, 0.0073, 0.08}) {
    ++disturbances.seed;
    const Result<DelayEstimate> found = Find(SwingInFrontOfAWall(delay_s, disturbances));
    ASSERT_TRUE(found.has_value()) << found.error().message();
    std::printf("seed %d: %+.2f ms found as %+.2f +- %.2f ms\n",
                static_cast<int>(disturbances.seed), 1e3 * delay_s, 1e3 * found->delay_s,
                1e3 * found->sigma_s);
    EXPECT_NEAR(found->delay_s, delay_s, kTolerance_s) << "seed " << disturbances.seed;
    EXPECT_LT(found->sigma_s, 0.0011);
  }
}

/// Tracked poses do not lag in scans, they fall short of the rig's path. That looks like a delay as
/// long as the rig goes one way, and averages out over its reversals.
TEST(FindDelayTest, DriftOfThePosesAveragesOutIfTheRigGoesBackAndForth) {
  constexpr int kSeeds = 10;
  constexpr double kMaxBias_s = 0.0003;
  constexpr double kDrift = 0.01;
  FindDelayOptions options;
  options.search.range_s = 0.04;
  options.search.resamplings = 20;
  double sum_s = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Result<DelayEstimate> found =
        Find(SwingInFrontOfAWall(0.0, {.seed = seed, .pose_drift = kDrift}), options);
    ASSERT_TRUE(found.has_value()) << found.error().message();
    sum_s += found->delay_s;
  }
  EXPECT_NEAR(sum_s / kSeeds, 0.0, kMaxBias_s);
  // A tenth as fast, there is time for less than half a swing, whatever the seed.
  options.search.max_sigma_s = 1.0;
  options.search.min_contrast = 0.0;
  const Result<DelayEstimate> one_way =
      Find(SwingInFrontOfAWall(0.0, {.pose_drift = kDrift, .hurry = 0.1}), options);
  ASSERT_TRUE(one_way.has_value()) << one_way.error().message();
  std::printf("back and forth %+.2f ms, one way %+.2f ms\n", 1e3 * sum_s / kSeeds,
              1e3 * one_way->delay_s);
  EXPECT_GT(std::abs(one_way->delay_s), 10.0 * kMaxBias_s);
}

/// Poses that wander make delays that are wrong by milliseconds where the rig hardly reverses: the
/// uncertainty must say so, or a right delay is called moved.
TEST(FindDelayTest, WhatWanderingPosesMakeIsInTheUncertainty) {
  constexpr int kSeeds = 10;
  FindDelayOptions options;
  options.search.range_s = 0.06;
  options.search.resamplings = 40;
  options.search.max_sigma_s = 0.02;
  double squares = 0.0, largest_s = 0.0, squares_without = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Disturbances slow{.seed = seed, .hurry = 0.3, .wander_m = 0.0005};
    const Result<DelayEstimate> found = Find(SwingInFrontOfAWall(0.0, slow), options);
    ASSERT_TRUE(found.has_value()) << found.error().message();
    const double without_s =
        std::sqrt(found->sigma_s * found->sigma_s - found->drift_sigma_s * found->drift_sigma_s);
    std::printf("seed %d: %+.2f ms, sigma %.2f, without drift %.2f ms\n", static_cast<int>(seed),
                1e3 * found->delay_s, 1e3 * found->sigma_s, 1e3 * without_s);
    EXPECT_LT(std::abs(found->delay_s), 3.0 * found->sigma_s) << "seed " << seed;
    squares += std::pow(found->delay_s / found->sigma_s, 2) / kSeeds;
    squares_without += std::pow(found->delay_s / without_s, 2) / kSeeds;
    largest_s = std::max(largest_s, std::abs(found->delay_s));
  }
  // Neither too small nor an excuse; and the poses do matter here.
  EXPECT_LT(std::sqrt(squares), 1.5);
  EXPECT_GT(std::sqrt(squares), 0.4);
  EXPECT_GT(std::sqrt(squares_without), 1.5);
  EXPECT_GT(largest_s, 0.003);
  // Ten times as fast, back and forth, the same wandering is nothing.
  const Result<DelayEstimate> fast =
      Find(SwingInFrontOfAWall(0.0, {.hurry = 3.0, .wander_m = 0.0005}), options);
  ASSERT_TRUE(fast.has_value()) << fast.error().message();
  EXPECT_LT(fast->drift_sigma_s, 0.0003);
  EXPECT_LT(std::abs(fast->delay_s), 0.001);
}

/// A rig that swings in front of the surface while it goes along it slowly, with poses that wander.
/// The swings tell the delay; what is slow must not.
TEST(FindDelayTest, WhereTheRigSwingsSlowDriftDoesNotCount) {
  constexpr int kSeeds = 10;
  FindDelayOptions options;
  options.search.range_s = 0.04;
  options.search.resamplings = 40;
  double mean_s = 0.0, squares = 0.0, squares_of_ratio = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Result<DelayEstimate> found = Find(
        SwingInFrontOfAWall(0.0, {.seed = seed, .travel_m = 0.3, .wander_m = 0.0005}), options);
    ASSERT_TRUE(found.has_value()) << found.error().message();
    std::printf("seed %d: %+.2f ms, sigma %.2f, by drift %.2f ms\n", static_cast<int>(seed),
                1e3 * found->delay_s, 1e3 * found->sigma_s, 1e3 * found->drift_sigma_s);
    EXPECT_LT(found->drift_sigma_s, 0.0004) << "over the whole scan it would be 0.6 ms";
    mean_s += found->delay_s / kSeeds;
    squares += found->delay_s * found->delay_s / kSeeds;
    squares_of_ratio += std::pow(found->delay_s / found->sigma_s, 2) / kSeeds;
  }
  std::printf("mean %+.2f, rms %.2f ms, rms of error/sigma %.2f\n", 1e3 * mean_s,
              1e3 * std::sqrt(squares), std::sqrt(squares_of_ratio));
  EXPECT_NEAR(mean_s, 0.0, 0.0003);
  EXPECT_LT(std::sqrt(squares), 0.0005);
  EXPECT_LT(std::sqrt(squares_of_ratio), 1.5);
  EXPECT_GT(std::sqrt(squares_of_ratio), 0.4);
}

TEST(FindDelayTest, TheHintComesWhereDriftIsMostOfTheUncertainty) {
  EXPECT_EQ(HintOfDrift({.sigma_s = 0.002, .drift_sigma_s = 0.001}), "");
  EXPECT_THAT(HintOfDrift({.sigma_s = 0.003, .drift_sigma_s = 0.0028}),
              HasSubstr("back and forth"));
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  EXPECT_THAT(HintOfDrift({.sigma_s = kUnknown, .drift_sigma_s = kUnknown}),
              HasSubstr("back and forth"));
}

TEST(FindDelayTest, WithoutThermalContrastNothingIsFound) {
  ScanViews views = SwingInFrontOfAWall(0.01);
  std::uint64_t counter = 0;
  for (StampedThermal& frame : views.frames) {
    Image<std::uint16_t> image = *frame.temperature_raw;
    for (std::uint16_t& pixel : image.pixels())
      pixel = static_cast<std::uint16_t>(31'300.0F + 4.0F * NormalNoise(9, counter++));
    frame.temperature_raw = std::make_shared<const Image<std::uint16_t>>(std::move(image));
  }
  const Result<DelayEstimate> found = Find(views);
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("thermal contrast"));
}

TEST(FindDelayTest, WithoutMotionNothingIsFound) {
  ScanViews views = SwingInFrontOfAWall(0.01);
  for (StampedPose& pose : views.trajectory) pose.T_world_depth = RigidTransform::Identity();
  for (StampedThermal& frame : views.frames)
    frame.temperature_raw = views.frames.front().temperature_raw;
  EXPECT_FALSE(Find(views).has_value());
}

TEST(FindDelayTest, TooUncertainIsRefused) {
  FindDelayOptions options;
  options.search.max_sigma_s = 0.00001;
  const Result<DelayEstimate> found = Find(SwingInFrontOfAWall(0.01), options);
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("uncertain by"));
}

TEST(FindDelayTest, ThreadsDoNotChangeTheResult) {
  const ScanViews views = SwingInFrontOfAWall(-0.02);
  ThreadPool one(1), three(3);
  const Result<DelayEstimate> a = FindDelay(views, {}, one, {});
  const Result<DelayEstimate> b = FindDelay(views, {}, three, {});
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->delay_s, b->delay_s);
  EXPECT_EQ(a->sigma_s, b->sigma_s);
}

}  // namespace
}  // namespace isotherm
