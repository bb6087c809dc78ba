#include "common/simulation/thermal_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "common/base/noise.h"
#include "common/frame/frame.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 4;
constexpr double kHalfUnit_k = 0.0051;  // Rounding to centi-kelvin.

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
    options_.mutable_expert()->set_rays_per_pixel_side(1);
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
  SimulatedThermalOptions options_ = IdealThermalCamera({});
};

TEST_F(ThermalSensorTest, ReadingsAreWrongByOffsetAndGain) {
  options_.mutable_expert()->set_offset_error_k(1.5);
  options_.mutable_expert()->set_gain_error(-0.02);
  const RigidTransform at_origin = RigidTransform::Identity();
  EXPECT_NEAR(Measure(Render(BlackWall(30.0), at_origin)).mean, 30.9, 0.001);
  EXPECT_NEAR(Measure(Render(BlackWall(200.0), at_origin)).mean, 197.5, 0.001);
}

TEST_F(ThermalSensorTest, ItsRangeDecidesWhatIsHotterThanItsScale) {
  options_.mutable_expert()->set_netd_kelvin(0.0);
  const Scene wall = BlackWall(850.0);
  EXPECT_EQ(Render(wall, RigidTransform::Identity()).At(100, 100), 0) << "hotter than 382 °C";
  for (const double max_celsius : {900.0, 1500.0}) {
    options_.set_max_celsius(max_celsius);
    const RadiometricScale scale = ScaleOf(options_);
    EXPECT_GE(scale.max_celsius(), max_celsius);
    const Image<std::uint16_t> image = Render(wall, RigidTransform::Identity());
    EXPECT_NEAR(scale.Celsius(image.At(100, 100)), 850.0, 0.5 * scale.kelvin_per_count + 0.001);
  }
}

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
  options_.mutable_expert()->set_netd_kelvin(0.0);
  options_.mutable_expert()->set_blur_px(0.0);
  SceneOptions scene_options;
  const StagedScene staged = MakeScene(scene_options);
  const RigidTransform T_world_thermal = staged.path.PoseAt(5.0);
  const Image<std::uint16_t> image = Render(staged.scene, T_world_thermal);
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
      different += std::abs(image.At(x, y) / 100.0 - 273.15 - expected) > 0.02;
    }
  }
  EXPECT_LE(different, 0.003 * compared);  // Pixels on an edge.
}

TEST_F(ThermalSensorTest, PolishedPlatesShowTheHotDisc) {
  options_.mutable_expert()->set_netd_kelvin(0.0);
  SceneBuilder builder(23.0);
  builder.UseMaterial({0.1, 12.0, 40.0, true});
  builder.RotatedBox("mirror", {0, 0, 0.5}, {2.0, 2.0, 0.01}, {0, 45, 0}).temperature =
      Uniform(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Sphere("left", {-1.5, 0.0, 0.5}, 0.3).temperature = Uniform(250.0);
  builder.Sphere("right", {1.5, 0.0, 0.5}, 0.3).temperature = Uniform(250.0);
  const Image<std::uint16_t> image = Render(builder.Build("mirror"), RigidTransform::Identity());
  const double centre = image.At(205, 150) / 100.0 - 273.15;
  EXPECT_GT(centre, 200.0);
  EXPECT_LT(image.At(205, 20) / 100.0 - 273.15, 30.0);
}

TEST_F(ThermalSensorTest, BlurKeepsTheMeanRadianceAndSoftensEdges) {
  options_.mutable_expert()->set_netd_kelvin(0.0);
  SceneBuilder builder(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Box("half", {0.0, -3, 0.5}, {3, 3, 0.6}).temperature = Uniform(100.0);
  const Scene scene = builder.Build("half");
  options_.mutable_expert()->set_blur_px(0.0);
  const Image<std::uint16_t> sharp = Render(scene, RigidTransform::Identity());
  options_.mutable_expert()->set_blur_px(1.0);
  const Image<std::uint16_t> soft = Render(scene, RigidTransform::Identity());
  const BandRadiance band;
  double sharp_sum = 0.0, soft_sum = 0.0;
  int between = 0;
  for (int x = 0; x < camera_.width; ++x) {
    const double a = sharp.At(x, 150) / 100.0 - 273.15, b = soft.At(x, 150) / 100.0 - 273.15;
    EXPECT_TRUE(std::abs(a - 23.0) < kHalfUnit_k || std::abs(a - 100.0) < kHalfUnit_k);
    between += b > 24.0 && b < 99.0;
    sharp_sum += band.RadianceFromCelsius(a);
    soft_sum += band.RadianceFromCelsius(b);
  }
  EXPECT_GE(between, 3);
  EXPECT_LE(between, 8);
  EXPECT_NEAR(soft_sum / sharp_sum, 1.0, 2e-4);
}

TEST_F(ThermalSensorTest, BlurHasTheVarianceThatTheOptionsSay) {
  options_.mutable_expert()->set_netd_kelvin(0.0);
  camera_ = camera_.WithoutDistortion();
  SceneBuilder builder(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Box("half", {0.0, -3, 0.5}, {3, 3, 0.6}).temperature = Uniform(300.0);
  const Scene scene = builder.Build("half");
  const BandRadiance band;
  // What a step becomes rises from pixel to pixel by the weights of the blur.
  for (const double blur_px : {0.25, 0.4, 1.0, 2.5}) {
    options_.mutable_expert()->set_blur_px(blur_px);
    const Image<std::uint16_t> image = Render(scene, RigidTransform::Identity());
    double total = 0.0, mean = 0.0, square = 0.0;
    for (int x = 0; x + 1 < camera_.width; ++x) {
      const double rise = band.RadianceFromCelsius(image.At(x + 1, 150) / 100.0 - 273.15) -
                          band.RadianceFromCelsius(image.At(x, 150) / 100.0 - 273.15);
      const double from_edge = x + 0.5 - camera_.cx;
      total += rise;
      mean += rise * from_edge;
      square += rise * from_edge * from_edge;
    }
    mean /= total;
    EXPECT_NEAR((square / total - mean * mean) / (blur_px * blur_px), 1.0, 0.01) << blur_px;
  }
}

/// A camera that passes the edge of a hot half of a wall, without noise and distortion: at the
/// capture time the edge is in the middle.
class MovingThermalCameraTest : public ThermalSensorTest {
 protected:
  static constexpr double kSpeed_m_s = 0.5;
  static constexpr double kWall_m = 0.5;

  MovingThermalCameraTest() : scene_(HalfWall()) {
    camera_ = camera_.WithoutDistortion();
    options_.mutable_expert()->set_netd_kelvin(0.0);
    options_.mutable_expert()->set_blur_px(0.0);
  }
  static Scene HalfWall() {
    SceneBuilder builder(23.0);
    builder.UseMaterial({1.0, 1.0, 0.0, false});
    builder.Box("half", {0.0, -3, kWall_m}, {3, 3, kWall_m + 1e-4}).temperature = Uniform(100.0);
    return builder.Build("half");
  }
  Image<std::uint16_t> RenderMoving(double speed_m_s) {
    const ThermalSensor sensor(camera_, options_);
    ThermalSensor::Scratch scratch;
    return sensor.RenderMoving(
        scene_,
        [&](double seconds) {
          return MakeTransform({speed_m_s * seconds, 0, 0}, Eigen::Quaterniond::Identity());
        },
        NoiseStream(kSeed, 1, 0), scratch);
  }
  /// Fraction of the hot side's radiance in a pixel.
  double HotFraction(const Image<std::uint16_t>& image, int x, int y) const {
    const double radiance = band_.RadianceFromCelsius(image.At(x, y) / 100.0 - 273.15);
    const double cold = band_.RadianceFromCelsius(23.0), hot = band_.RadianceFromCelsius(100.0);
    return (radiance - cold) / (hot - cold);
  }
  /// Column at which a row turns hot, to a fraction of a pixel.
  double EdgeColumn(const Image<std::uint16_t>& image, int y) const {
    double cold_pixels = 0.0;
    for (int x = 0; x < camera_.width; ++x) cold_pixels += 1.0 - HotFraction(image, x, y);
    return cold_pixels - 0.5;
  }

  const Scene scene_;
  const BandRadiance band_;
};

TEST_F(MovingThermalCameraTest, SmearsAsAnExponentialAnswerDoes) {
  constexpr double kTimeConstant_s = 0.010;
  constexpr double kDiscrete = 0.06;  // 64 rays, and the pixel's area, which is left out here.
  options_.mutable_expert()->set_time_constant_s(kTimeConstant_s);
  options_.mutable_expert()->set_rays_per_pixel_side(8);
  const Image<std::uint16_t> image = RenderMoving(kSpeed_m_s);
  constexpr int kRow = 100;
  double sum = 0.0;
  for (int x = 0; x < camera_.width; ++x) {
    // The pixel sees the hot half from this time on, and is read one time constant after the
    // capture time, which is the mean time of its radiation.
    const double hot_from_s = -kWall_m * (x - camera_.cx) / camera_.fx / kSpeed_m_s;
    const double since_s = kTimeConstant_s - hot_from_s;
    const double fraction = since_s > 0.0 ? 1.0 - std::exp(-since_s / kTimeConstant_s) : 0.0;
    EXPECT_NEAR(HotFraction(image, x, kRow), fraction, kDiscrete) << "column " << x;
    sum += HotFraction(image, x, kRow) - fraction;
  }
  EXPECT_NEAR(sum, 0.0, 0.1)
      << "the edge as a whole is where it was at the capture time, in pixels";
}

TEST_F(MovingThermalCameraTest, NineRaysPutASmearedEdgeWhereItIs) {
  constexpr double kTwoRays_px = 2.0 / 9.0 + 0.01;
  options_.mutable_expert()->set_time_constant_s(0.010);
  options_.mutable_expert()->set_rays_per_pixel_side(3);
  for (const double speed_m_s : {-0.5, -0.1, 0.05, 0.2, 0.5}) {
    const Image<std::uint16_t> image = RenderMoving(speed_m_s);
    EXPECT_NEAR(EdgeColumn(image, 100), camera_.cx, kTwoRays_px) << speed_m_s;
  }
}

TEST_F(MovingThermalCameraTest, RowsThatAreReadLaterSeeTheEdgeLater) {
  constexpr double kReadout_s = 0.020;
  constexpr double kWithinAPixel = 1.0;
  options_.mutable_expert()->set_readout_s(kReadout_s);
  const Image<std::uint16_t> image = RenderMoving(kSpeed_m_s);
  const double shift_px = kSpeed_m_s * kReadout_s * camera_.fx / kWall_m;
  EXPECT_GT(shift_px, 5.0);
  const int last = camera_.height - 1;
  EXPECT_NEAR(EdgeColumn(image, 0) - EdgeColumn(image, last), shift_px, kWithinAPixel);
  EXPECT_NEAR(EdgeColumn(image, last / 2), camera_.cx, kWithinAPixel);
}

TEST_F(MovingThermalCameraTest, ACameraAtRestSmearsNothing) {
  options_.mutable_expert()->set_rays_per_pixel_side(3);
  const Image<std::uint16_t> sharp = Render(scene_, RigidTransform::Identity());
  options_.mutable_expert()->set_time_constant_s(0.01);
  options_.mutable_expert()->set_readout_s(0.02);
  EXPECT_TRUE(std::ranges::equal(RenderMoving(0.0).pixels(), sharp.pixels()));
  EXPECT_FALSE(std::ranges::equal(RenderMoving(kSpeed_m_s).pixels(), sharp.pixels()));
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
