#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/testing/kernel_checks.h"
#include "common/testing/opencv_camera.h"
#include "ground/thermal/thermal_rectifier.h"

namespace isotherm {
namespace {

/// OpenCV's map is in single precision, and neighbouring pixels differ by up to 20 K.
constexpr double kTolerance_k = 2e-3;
/// Nearer than this to the border of the image, rounding decides whether there is a value.
constexpr double kNearBorder_px = 1e-3;

CameraModel DistortedCamera(double k1, double k2, double k3) {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = 371.4;
  camera.fy = 372.1;
  camera.cx = 205.5;
  camera.cy = 150.5;
  camera.k1 = k1;
  camera.k2 = k2;
  camera.p1 = 0.0031;
  camera.p2 = -0.0022;
  camera.k3 = k3;
  return camera;
}

/// Bilinear between the four pixels around, °C; NaN outside the image.
double Look(const Image<std::uint16_t>& centikelvin, double x, double y) {
  if (!(x >= 0.0 && y >= 0.0 && x <= centikelvin.width() - 1 && y <= centikelvin.height() - 1))
    return std::numeric_limits<double>::quiet_NaN();
  const int left = std::min(static_cast<int>(x), centikelvin.width() - 2);
  const int top = std::min(static_cast<int>(y), centikelvin.height() - 2);
  double sum = 0.0;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const double weight = (1.0 - std::abs(x - left - column)) * (1.0 - std::abs(y - top - row));
      sum += weight * centikelvin.At(left + column, top + row);
    }
  }
  return 0.01 * sum - 273.15;
}

struct Difference {
  int compared = 0;
  int outside = 0;  ///< Pixels of the ideal camera that the lens never saw.
};

Difference CompareWithOpencv(const CameraModel& camera) {
  testing::Random random;
  Image<std::uint16_t> centikelvin(camera.width, camera.height);
  for (std::uint16_t& value : centikelvin.pixels())
    value = static_cast<std::uint16_t>(random.Integer(29'000, 31'000));
  ThreadPool pool(1);
  Image<float> celsius;
  constexpr int kApron = 1;
  ThermalRectifier rectifier(camera, {});
  rectifier.Rectify(centikelvin, kCentikelvin, kApron, pool, celsius);
  const CameraModel& ideal = rectifier.ideal_camera();
  const testing::OpencvRectification truth(camera, ideal);
  Difference result;
  for (int v = 0; v < ideal.height; ++v) {
    for (int u = 0; u < ideal.width; ++u) {
      const double x = truth.x(v, u);
      const double y = truth.y(v, u);
      const auto near_border = [](double c, int size) {
        return std::abs(c) < kNearBorder_px || std::abs(c - (size - 1)) < kNearBorder_px;
      };
      if (near_border(x, camera.width) || near_border(y, camera.height)) continue;
      const double expected = Look(centikelvin, x, y);
      const float found = celsius.At(u + kApron, v + kApron);
      EXPECT_EQ(std::isnan(found), std::isnan(expected)) << "pixel " << u << ", " << v;
      if (std::isnan(expected)) {
        ++result.outside;
        continue;
      }
      EXPECT_NEAR(found, expected, kTolerance_k) << "pixel " << u << ", " << v;
      ++result.compared;
    }
  }
  return result;
}

constexpr int kRawPixels = 382 * 288;

TEST(ThermalRectificationTest, ABarrelLensIsStraightenedAsByOpencv) {
  const Difference found = CompareWithOpencv(DistortedCamera(-0.439, 0.29, -0.114));
  EXPECT_GT(found.compared, kRawPixels) << "what a barrel lens draws together is spread out";
  EXPECT_GT(found.outside, 1'000) << "its straightened image is no rectangle";
}

TEST(ThermalRectificationTest, APincushionLensIsStraightenedAsByOpencv) {
  const Difference found = CompareWithOpencv(DistortedCamera(0.12, -0.05, 0.02));
  EXPECT_GT(found.compared, 90'000);
}

TEST(ThermalRectificationTest, WideLensesAreStraightenedAsByOpencv) {
  CameraModel rational = DistortedCamera(0.778, 0.068, 0.002);
  rational.fx = rational.fy = 220.0;
  rational.lens = LensKind::kRational;
  rational.k4 = 1.11, rational.k5 = 0.238, rational.k6 = 0.004;
  EXPECT_GT(CompareWithOpencv(rational).compared, kRawPixels);
  CameraModel fisheye = DistortedCamera(-0.03, 0.01, -0.004);
  fisheye.fx = fisheye.fy = 220.0;
  fisheye.lens = LensKind::kFisheye;
  fisheye.p1 = fisheye.p2 = 0.0;
  fisheye.k4 = 0.001;
  EXPECT_GT(CompareWithOpencv(fisheye).compared, kRawPixels);
}

/// Each corner and the middle of each side shows something hot.
TEST(ThermalRectificationTest, NothingOfABarrelLenssImageIsLost) {
  const CameraModel camera = DistortedCamera(-0.439, 0.29, -0.114);
  ThermalRectifier rectifier(camera, {});
  ThreadPool pool(1);
  for (const int left : {0, 180, camera.width - 6}) {
    for (const int top : {0, 140, camera.height - 6}) {
      Image<std::uint16_t> centikelvin(camera.width, camera.height, 29'000);
      for (int y = top; y < top + 6; ++y) {
        for (int x = left; x < left + 6; ++x) centikelvin.At(x, y) = 33'000;
      }
      Image<float> celsius;
      rectifier.Rectify(centikelvin, kCentikelvin, 0, pool, celsius);
      const auto hot = std::ranges::count_if(celsius.pixels(), [](float c) { return c > 56.0F; });
      EXPECT_GE(hot, 25) << "at " << left << ", " << top;
    }
  }
}

TEST(ThermalRectifierTest, ReadingsAreCorrectedOnceTheSceneIsTakenOut) {
  CameraModel straight = DistortedCamera(0.0, 0.0, 0.0);
  straight.p1 = straight.p2 = 0.0;
  const SceneInfluence influence{.near_fraction = 0.05, .total_fraction = 0.05};
  const RadiometricCorrection correction{{20, 100}, {1.0F, -3.0F}, {0.1F, 0.1F}};
  Image<std::uint16_t> frame(straight.width, straight.height, 29'500);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) frame.At(x, y) = 36'000;
  ThreadPool pool(1);
  Image<float> own, corrected, celsius;
  ThermalRectifier(straight, {.scene_influence = influence})
      .Rectify(frame, kCentikelvin, 0, pool, own);
  ThermalRectifier(straight, {influence, correction})
      .Rectify(frame, kCentikelvin, 0, pool, corrected);
  ThermalRectifier(straight, {.radiometric_correction = correction})
      .Rectify(frame, kCentikelvin, 0, pool, celsius);
  EXPECT_NEAR(celsius.At(200, 200), 21.85 + 1.0 - 4.0 * 1.85 / 80.0, 1e-3);
  for (const auto& [x, y] : {std::pair(20, 30), std::pair(200, 200), std::pair(57, 3)}) {
    const auto reading = static_cast<double>(own.At(x, y));
    EXPECT_NEAR(corrected.At(x, y), reading + correction.At(reading), 1e-3);
    EXPECT_GT(std::abs(own.At(x, y) - kCentikelvin.Celsius(frame.At(x, y))), 0.1);
  }
}

TEST(ReadingCorrectionsTest, TheHousingsDriftIsTakenOutWhereItIsKnown) {
  const HousingDrift drift{4.0, 0.1};
  NucAge warmer;
  warmer.housing_change_k = 0.5;
  const NucAge silent;
  EXPECT_NEAR(WithoutDrift(kCentikelvin, drift, warmer).Celsius(30'000),
              kCentikelvin.Celsius(30'000) - 2.0F, 1e-4);
  EXPECT_EQ(WithoutDrift(kCentikelvin, std::nullopt, warmer), kCentikelvin);
  EXPECT_EQ(WithoutDrift(kCentikelvin, drift, silent), kCentikelvin);
}

TEST(ThermalRectifierTest, NoiseIsLessWhereFourPixelsAreAveraged) {
  CameraModel straight = DistortedCamera(0.0, 0.0, 0.0);
  straight.p1 = straight.p2 = 0.0;
  const ThermalRectifier none(straight, {});
  EXPECT_EQ(none.noise_gain().At(10, 20), 1.0F) << "a pixel is itself";
  const ThermalRectifier corrected(
      straight, {.scene_influence = {.near_fraction = 0.1, .total_fraction = 0.1}});
  EXPECT_NEAR(corrected.noise_gain().At(10, 20), 1.0 / (0.8 * 0.8), 1e-5)
      << "what takes the scene's influence out raises the noise";
  const CameraModel camera = DistortedCamera(-0.4, 0.2, 0.0);
  ThermalRectifier rectifier(camera, {});
  // The variance of what becomes of noise, against what is said of it.
  constexpr double kSigma_k = 1.0;
  constexpr int kFrames = 400;
  std::mt19937 engine(7);
  std::normal_distribution<double> normal(30'000.0, 100.0 * kSigma_k);
  ThreadPool pool(1);
  Image<std::uint16_t> frame(camera.width, camera.height);
  Image<float> celsius;
  Image<double> squares;
  for (int i = 0; i < kFrames; ++i) {
    for (std::uint16_t& value : frame.pixels())
      value = static_cast<std::uint16_t>(std::lround(normal(engine)));
    rectifier.Rectify(frame, kCentikelvin, 0, pool, celsius);
    if (i == 0) squares = Image<double>(celsius.width(), celsius.height(), 0.0);
    for (int y = 0; y < celsius.height(); ++y) {
      for (int x = 0; x < celsius.width(); ++x)
        squares.At(x, y) += std::pow(static_cast<double>(celsius.At(x, y)) - 26.85, 2);
    }
  }
  double sum = 0.0, said = 0.0;
  int compared = 0;
  for (int y = 0; y < celsius.height(); ++y) {
    for (int x = 0; x < celsius.width(); ++x) {
      if (std::isnan(celsius.At(x, y))) continue;
      const double variance = squares.At(x, y) / kFrames;
      const double gain = static_cast<double>(rectifier.noise_gain().At(x, y));
      ASSERT_NEAR(variance, gain, 0.5 * gain) << x << " " << y;  // Seven standard deviations.
      sum += variance;
      said += gain;
      ++compared;
    }
  }
  EXPECT_GT(compared, 50'000);
  EXPECT_NEAR(sum / said, 1.0, 0.005);
  EXPECT_LT(said / compared, 0.6) << "four ninths on average";
}

}  // namespace
}  // namespace isotherm
