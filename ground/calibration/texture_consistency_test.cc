#include "ground/calibration/texture_consistency.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/simulation/noise.h"

namespace isotherm {
namespace {

constexpr double kDelay_s = -0.037;
constexpr double kTolerance_s = 0.0005;
constexpr CaptureTime kStart{std::chrono::seconds(100)};

/// A wall at z = 1 m with a wavy temperature; the rig swings in front of it.
RigidTransform PoseAt(double time_s) {
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() =
      Eigen::Vector3d(0.08 * std::sin(2.4 * time_s), 0.05 * std::sin(3.1 * time_s), 0.0);
  return pose;
}

double Celsius(double x_m, double y_m) {
  return 40.0 + 5.0 * std::sin(60.0 * x_m) * std::cos(45.0 * y_m);
}

ScanViews SwingInFrontOfAWall() {
  ScanViews views;
  views.thermal_camera = {.width = 160, .height = 120, .fx = 150, .fy = 150, .cx = 80, .cy = 60};
  for (int i = 0; i < 300; ++i) {
    const double time_s = i / 30.0;
    views.trajectory.push_back({kStart + FromSeconds(time_s), PoseAt(time_s)});
  }
  for (std::uint64_t i = 0; i < 1500; ++i) {
    const double x_m = 0.8 * (UniformNoise(1, 2 * i) - 0.5);
    const double y_m = 0.6 * (UniformNoise(1, 2 * i + 1) - 0.5);
    views.points.push_back({{x_m, y_m, 1.0}, -Eigen::Vector3d::UnitZ()});
  }
  for (int i = 4; i < 380; i += 2) {
    const double time_s = i / 40.0;
    const RigidTransform pose = PoseAt(time_s);
    Image<std::uint16_t> picture(160, 120);
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 160; ++u) {
        const double celsius = Celsius((u - 80) / 150.0 + pose.translation().x(),
                                       (v - 60) / 150.0 + pose.translation().y());
        picture.At(u, v) = static_cast<std::uint16_t>(std::lround(100.0 * (celsius + 273.15)));
      }
    }
    // Stamped late: the delay to add is negative.
    views.frames.push_back({kStart + FromSeconds(time_s - kDelay_s), std::move(picture), {}});
    // All points stay in the picture, and their poses are known for all delays.
    const double stamp_s = time_s - kDelay_s;
    if (stamp_s < 0.16 || stamp_s > 9.8) continue;
    for (std::uint32_t point = 0; point < views.points.size(); ++point)
      views.frames.back().visible.push_back(point);
  }
  return views;
}

Result<DelayEstimate> FindDelay(const ScanViews& views) {
  ThreadPool pool(2);
  const TextureConsistency consistency(views, 1.0, pool);
  return SearchDelay(
      [&](double delay_s, bool fine, const std::vector<PartWeights>& resamplings) {
        return consistency.Measure(delay_s, fine ? 1500 : 500, resamplings);
      },
      consistency.parts(), {}, {});
}

TEST(TextureConsistencyTest, PicturesAgreeAtTheTrueDelay) {
  const Result<DelayEstimate> found = FindDelay(SwingInFrontOfAWall());
  ASSERT_TRUE(found.has_value()) << found.error().message();
  EXPECT_NEAR(found->delay_s, kDelay_s, kTolerance_s);
  EXPECT_LT(found->sigma_s, kTolerance_s);
}

TEST(TextureConsistencyTest, WithoutThermalContrastNothingIsFound) {
  ScanViews views = SwingInFrontOfAWall();
  std::uint64_t counter = 0;
  for (StampedThermal& frame : views.frames) {
    for (std::uint16_t& pixel : frame.centikelvin.pixels())
      pixel = static_cast<std::uint16_t>(31'300.0F + 4.0F * NormalNoise(9, counter++));
  }
  EXPECT_FALSE(FindDelay(views).has_value());
}

TEST(TextureConsistencyTest, WithoutMotionNothingIsFound) {
  ScanViews views = SwingInFrontOfAWall();
  for (StampedPose& pose : views.trajectory) pose.T_world_depth = RigidTransform::Identity();
  for (StampedThermal& frame : views.frames) frame.centikelvin = views.frames.front().centikelvin;
  EXPECT_FALSE(FindDelay(views).has_value());
}

}  // namespace
}  // namespace isotherm
