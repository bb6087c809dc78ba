#include "ground/camera_calibration/depth_bias_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "common/base/noise.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

CameraModel Camera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 285.0;
  camera.cx = 160.5;
  camera.cy = 118.0;
  camera.k1 = 0.05;
  return camera;
}

/// The truth: by what a measured distance has to be multiplied, from the image's place and the
/// distance.
using TrueMultiplier = std::function<double(double across, double down, double measured_m)>;

double SwellingTowardsCorners(double across, double down, double) {
  const double radius2 = (std::pow(across - 0.5, 2) + std::pow(down - 0.5, 2)) / 0.5;
  return 1.0 / (1.0 + 0.015 * radius2);
}

/// Closed form: a plane seen by a pinhole, with disparity noise. Optional: something stands before
/// a part of it.
class Wall {
 public:
  explicit Wall(TrueMultiplier multiplier) : multiplier_(std::move(multiplier)) {}

  Image<float> See(double time_s, bool with_table = false) const {
    const CameraModel camera = Camera();
    const double distance_m = 0.8 - 0.35 * std::cos(0.4 * time_s);
    const Eigen::Vector3d normal =
        Eigen::Vector3d(0.35 * std::sin(1.3 * time_s), 0.3 * std::sin(0.9 * time_s + 1.0), 1.0)
            .normalized();
    Image<float> depth_m(camera.width, camera.height);
    const auto stream = NoiseStream(5, 0, static_cast<std::uint64_t>(1e3 * time_s));
    std::uint64_t counter = 0;
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector2d ray = Unproject(camera, {u, v});
        double true_m = distance_m * normal.z() / normal.dot(ray.homogeneous());
        if (with_table && v > 190) true_m *= 0.7;
        depth_m.At(u, v) = static_cast<float>(
            Measured(u, v, true_m) + 0.002 * true_m * true_m * NormalNoise(stream, counter++));
      }
    return depth_m;
  }

 private:
  /// The measured distance that the truth's multiplier makes right, by iteration.
  double Measured(int u, int v, double true_m) const {
    const CameraModel camera = Camera();
    const double across = u / (camera.width - 1.0), down = v / (camera.height - 1.0);
    double measured_m = true_m;
    for (int i = 0; i < 5; ++i) measured_m = true_m / multiplier_(across, down, measured_m);
    return measured_m;
  }

  TrueMultiplier multiplier_;
};

Result<DepthBiasReport> Fit(const TrueMultiplier& truth, bool with_table = false,
                            const DepthBias& before = {}) {
  DepthBiasFit fit(Camera(), before);
  const Wall wall(truth);
  for (int i = 0; i < 90; ++i) fit.Add(0.2 * i, wall.See(0.2 * i, with_table));
  return fit.Solve({});
}

/// Root mean square of what is left of the error over the image at a distance, as a fraction.
double Left(const DepthBias& found, const TrueMultiplier& truth, double distance_m) {
  double squares = 0.0, count = 0.0;
  for (int column = 0; column < 10; ++column)
    for (int row = 0; row < 10; ++row, count += 1.0) {
      const double x = 0.05 + 0.1 * column, y = 0.05 + 0.1 * row;
      squares += std::pow(found.At(x, y, distance_m) / truth(x, y, distance_m) - 1.0, 2);
    }
  return std::sqrt(squares / count);
}

TEST(DepthBiasFitTest, SwellingTowardsTheCornersIsFound) {
  const auto report = Fit(SwellingTowardsCorners);
  ASSERT_TRUE(report) << report.error().message();
  for (const double distance_m : {0.5, 0.8, 1.1}) {
    const double before = Left({}, SwellingTowardsCorners, distance_m);
    EXPECT_GT(before, 0.005);
    EXPECT_LT(Left(report->bias, SwellingTowardsCorners, distance_m), 0.1 * before) << distance_m;
  }
  EXPECT_NEAR(report->bias.At(0.0, 0.0, 0.8), 1.0 / 1.015, 0.001);
  EXPECT_GT(report->before_rms, 0.001);
  EXPECT_LT(report->after_rms, 0.1 * report->before_rms);
  EXPECT_LT(report->halves_rms, 0.001);
  EXPECT_TRUE(report->Improves());
}

/// The other way round farther away.
TEST(DepthBiasFitTest, WhatChangesWithTheDistanceIsFound) {
  const TrueMultiplier truth = [](double across, double down, double measured_m) {
    return 1.0 + 0.04 * (0.8 - measured_m) * std::pow(across - 0.5, 2) / 0.25 +
           0.01 * std::pow(down - 0.5, 2);
  };
  const auto report = Fit(truth);
  ASSERT_TRUE(report) << report.error().message();
  for (const double distance_m : {0.5, 0.8, 1.1})
    EXPECT_LT(Left(report->bias, truth, distance_m), 0.001) << distance_m;
}

TEST(DepthBiasFitTest, WhatStandsBeforeTheWallIsLeftOut) {
  const auto report = Fit(SwellingTowardsCorners, true);
  ASSERT_TRUE(report) << report.error().message();
  EXPECT_EQ(report->walls, report->frames);
  EXPECT_NEAR(report->bias.At(0.0, 0.0, 0.8), 1.0 / 1.015, 0.002);
}

TEST(DepthBiasFitTest, ARightCameraStaysAsItIs) {
  const auto right = [](double, double, double) { return 1.0; };
  const auto report = Fit(right);
  ASSERT_TRUE(report) << report.error().message();
  for (const float multiplier : report->bias.multipliers) EXPECT_NEAR(multiplier, 1.0F, 0.001F);
}

TEST(DepthBiasFitTest, ACalibrationThatIsRightIsNotImproved) {
  const auto first = Fit(SwellingTowardsCorners);
  ASSERT_TRUE(first) << first.error().message();
  const auto again = Fit(SwellingTowardsCorners, false, first->bias);
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_FALSE(again->Improves());
}

TEST(DepthBiasFitTest, AnythingElseIsNoWall) {
  DepthBiasFit fit(Camera(), {});
  Image<float> room(Camera().width, Camera().height);
  for (int v = 0; v < room.height(); ++v)
    for (int u = 0; u < room.width(); ++u) room.At(u, v) = u < 110 ? 0.6F : u < 220 ? 1.0F : 0.8F;
  for (int i = 0; i < 90; ++i) fit.Add(0.2 * i, room);
  const auto report = fit.Solve({});
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error().message(), HasSubstr("a flat wall fills the image in 0 of 90"));
  DepthBiasFit nothing(Camera(), {});
  nothing.Add(0.0, Image<float>(Camera().width, Camera().height, NAN));
  EXPECT_FALSE(nothing.Solve({}));
}

}  // namespace
}  // namespace isotherm
