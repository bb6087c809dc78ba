#include "common/simulation/thermal_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "common/frame/frame.h"
#include "common/simulation/noise.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 4;
constexpr double kHalfUnitKelvin = 0.0051;  // Rounding to centi-kelvin.

struct Statistics {
  double mean, sigma;
};

Statistics Measure(const Image<std::uint16_t>& centikelvin) {
  double sum = 0.0, squares = 0.0;
  for (const std::uint16_t value : centikelvin.pixels()) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const double count = static_cast<double>(centikelvin.size());
  const double mean = sum / count;
  return {mean / 100.0 - 273.15, std::sqrt(squares / count - mean * mean) / 100.0};
}

class ThermalSensorTest : public ::testing::Test {
 protected:
  ThermalSensorTest() : camera_(*DefaultSimulatedRig().thermal) {
    std::cout << "seed " << kSeed << '\n';
  }

  Image<std::uint16_t> Render(const Scene& scene, const RigidTransform& T_world_thermal) {
    const ThermalSensor sensor(camera_, options_);
    ThermalSensor::Scratch scratch;
    return sensor.Render(scene, T_world_thermal, NoiseStream(kSeed, 1, 0), scratch);
  }
  static Scene BlackWall(double celsius) {
    SceneBuilder builder(23.0);
    builder.UseMaterial({1.0, 1.0, 0.0, false});
    builder.Box("wall", {-3, -3, 0.5}, {3, 3, 0.6}).temperature = Uniform(celsius);
    return builder.Build("wall");
  }

  CameraModel camera_;
  ThermalCameraOptions options_;
};

TEST_F(ThermalSensorTest, NoiseIsTheNetdAt30CelsiusAndLessWhereItIsHot) {
  const Statistics at_30 = Measure(Render(BlackWall(30.0), RigidTransform::Identity()));
  EXPECT_NEAR(at_30.mean, 30.0, 0.001);
  EXPECT_NEAR(at_30.sigma, 0.040, 0.001);
  const Statistics at_300 = Measure(Render(BlackWall(300.0), RigidTransform::Identity()));
  const double expected =
      0.040 * PlanckBandRadianceSlope(30.0, {}) / PlanckBandRadianceSlope(300.0, {});
  EXPECT_NEAR(at_300.mean, 300.0, 0.001);
  EXPECT_NEAR(at_300.sigma, expected, 0.002);
}

TEST_F(ThermalSensorTest, EachPixelShowsTheApparentTemperatureOfWhatItSees) {
  options_.set_netd_kelvin(0.0);
  options_.set_blur_px(0.0);
  SceneOptions scene_options;
  const StagedScene staged = MakeScene(scene_options);
  const RigidTransform T_world_thermal = staged.path.PoseAt(5.0);
  const Image<std::uint16_t> picture = Render(staged.scene, T_world_thermal);
  const BandRadiance band;
  int compared = 0, different = 0;
  for (int y = 0; y < camera_.height; y += 4) {
    for (int x = 0; x < camera_.width; x += 4) {
      const Eigen::Vector3d direction =
          T_world_thermal.linear() * Unproject(camera_, Eigen::Vector2d(x, y)).homogeneous();
      const auto hit = staged.scene.Intersect(T_world_thermal.translation(), direction);
      const double expected =
          hit ? TrueApparentCelsius(staged.scene, band, hit->point, T_world_thermal.translation())
              : scene_options.surround_celsius();
      ++compared;
      different += std::abs(picture.At(x, y) / 100.0 - 273.15 - expected) > 0.02;
    }
  }
  EXPECT_LE(different, 0.003 * compared);  // Pixels on an edge.
}

TEST_F(ThermalSensorTest, PolishedPlatesShowTheHotDisc) {
  options_.set_netd_kelvin(0.0);
  SceneBuilder builder(23.0);
  builder.UseMaterial({0.1, 12.0, 40.0, true});
  builder.RotatedBox("mirror", {0, 0, 0.5}, {2.0, 2.0, 0.01}, {0, 45, 0}).temperature =
      Uniform(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Sphere("left", {-1.5, 0.0, 0.5}, 0.3).temperature = Uniform(250.0);
  builder.Sphere("right", {1.5, 0.0, 0.5}, 0.3).temperature = Uniform(250.0);
  const Image<std::uint16_t> picture = Render(builder.Build("mirror"), RigidTransform::Identity());
  const double centre = picture.At(205, 150) / 100.0 - 273.15;
  EXPECT_GT(centre, 200.0);
  EXPECT_LT(picture.At(205, 20) / 100.0 - 273.15, 30.0);
}

TEST_F(ThermalSensorTest, BlurKeepsTheMeanRadianceAndSoftensEdges) {
  options_.set_netd_kelvin(0.0);
  SceneBuilder builder(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Box("half", {0.0, -3, 0.5}, {3, 3, 0.6}).temperature = Uniform(100.0);
  const Scene scene = builder.Build("half");
  options_.set_blur_px(0.0);
  const Image<std::uint16_t> sharp = Render(scene, RigidTransform::Identity());
  options_.set_blur_px(1.0);
  const Image<std::uint16_t> soft = Render(scene, RigidTransform::Identity());
  const BandRadiance band;
  double sharp_sum = 0.0, soft_sum = 0.0;
  int between = 0;
  for (int x = 0; x < camera_.width; ++x) {
    const double a = sharp.At(x, 150) / 100.0 - 273.15, b = soft.At(x, 150) / 100.0 - 273.15;
    EXPECT_TRUE(std::abs(a - 23.0) < kHalfUnitKelvin || std::abs(a - 100.0) < kHalfUnitKelvin);
    between += b > 24.0 && b < 99.0;
    sharp_sum += band.RadianceFromCelsius(a);
    soft_sum += band.RadianceFromCelsius(b);
  }
  EXPECT_GE(between, 3);
  EXPECT_LE(between, 8);
  EXPECT_NEAR(soft_sum / sharp_sum, 1.0, 2e-4);
}

TEST_F(ThermalSensorTest, TheShutterIsUniform) {
  const ThermalSensor sensor(camera_, options_);
  ThermalSensor::Scratch scratch;
  const Statistics shutter = Measure(sensor.RenderShutter(31.0, NoiseStream(kSeed, 1, 1), scratch));
  EXPECT_NEAR(shutter.mean, 31.0, 0.001);
  EXPECT_NEAR(shutter.sigma, 0.04, 0.002);
}

}  // namespace
}  // namespace isotherm
