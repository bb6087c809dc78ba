#include "common/simulation/pixel_average.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "common/base/noise.h"
#include "common/geometry/depth_of_field.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_sensor.h"

namespace isotherm {
namespace {

constexpr double kCold_celsius = 23.0, kHot_celsius = 100.0;
constexpr double kWall_m = 0.5;

/// A camera without noise, optical blur and distortion.
class PixelAverageTest : public ::testing::Test {
 protected:
  PixelAverageTest() {
    camera_.width = 96;
    camera_.height = 64;
    camera_.fx = camera_.fy = 370.0;
    camera_.cx = 47.3;
    camera_.cy = 31.6;
    expert().set_netd_kelvin(0.0);
    expert().set_blur_px(0.0);
  }
  SimulatedThermalExpertOptions& expert() { return *options_.mutable_expert(); }
  void FocusAt(double focus_m) { expert().mutable_lens()->set_focus_m(focus_m); }

  /// Fraction of the hot radiance in each pixel, row by row.
  Image<double> HotFractions(const Scene& scene) const {
    const ThermalSensor sensor(camera_, options_);
    ThermalSensor::Scratch scratch;
    const Image<std::uint16_t> image =
        sensor.Render(scene, RigidTransform::Identity(), NoiseStream(1, 1, 0), scratch);
    const double cold = sensor.band().RadianceFromCelsius(kCold_celsius);
    const double hot = sensor.band().RadianceFromCelsius(kHot_celsius);
    Image<double> fractions(image.width(), image.height());
    for (std::size_t i = 0; i < image.size(); ++i) {
      const double celsius = ScaleOf(options_).Celsius(image.pixels()[i]);
      fractions.pixels()[i] = (sensor.band().RadianceFromCelsius(celsius) - cold) / (hot - cold);
    }
    return fractions;
  }
  /// A hot half of a black wall, so thin that no part of the lens sees its side, to the right of an
  /// edge through the middle of the image that is turned by this angle.
  static Scene HalfWall(double angle_deg) {
    SceneBuilder builder(kCold_celsius);
    builder.UseMaterial({1.0, 1.0, 0.0, false});
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    constexpr double kThick_m = 1e-4;
    builder
        .RotatedBox(
            "half",
            {2.0 * std::cos(angle_rad), 2.0 * std::sin(angle_rad), kWall_m + 0.5 * kThick_m},
            {4.0, 8.0, kThick_m}, {0, 0, angle_deg})
        .temperature = Uniform(kHot_celsius);
    return builder.Build("half");
  }

  CameraModel camera_;
  SimulatedThermalOptions options_ = IdealThermalCamera({});
};

/// Area of the unit square around the origin where x cos + y sin > -distance, by fine strips.
double AreaBeyond(double distance, double angle_rad) {
  constexpr int kStrips = 2000;
  double area = 0.0;
  for (int i = 0; i < kStrips; ++i) {
    const double y = (i + 0.5) / kStrips - 0.5;
    const double from = (-distance - y * std::sin(angle_rad)) / std::cos(angle_rad);
    area += std::clamp(0.5 - from, 0.0, 1.0) / kStrips;
  }
  return area;
}

TEST_F(PixelAverageTest, APixelAtAnEdgeShowsTheFractionOfItsAreaThatIsHot) {
  // No two rays share a row or a column: an edge along either is off by half a ray. Askew it is off
  // by more, as rays fall together.
  const auto tolerance = [](double angle_deg, unsigned rays) {
    return angle_deg == 0.0 ? 0.5 / (rays * rays) + 0.01 : 0.45 / rays;
  };
  for (const double angle_deg : {0.0, 7.0, 31.0}) {
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    for (const unsigned rays : {3U, 8U}) {
      expert().set_rays_per_pixel_side(rays);
      const Image<double> hot = HotFractions(HalfWall(angle_deg));
      int mixed = 0;
      for (int y = 0; y < camera_.height; ++y) {
        for (int x = 0; x < camera_.width; ++x) {
          const double distance =
              (x - camera_.cx) * std::cos(angle_rad) + (y - camera_.cy) * std::sin(angle_rad);
          const double area = AreaBeyond(distance, angle_rad);
          ASSERT_NEAR(hot.At(x, y), area, tolerance(angle_deg, rays))
              << rays << " rays, " << angle_deg << " deg, " << x << ", " << y;
          mixed += area > 0.1 && area < 0.9;
        }
      }
      EXPECT_GE(mixed, 40);
    }
  }
}

TEST_F(PixelAverageTest, WhatIsEvenTakesNoFurtherRaysAndStaysTheSame) {
  SceneBuilder builder(kCold_celsius);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  Primitive& wall = builder.Box("wall", {-3, -3, kWall_m}, {3, 3, 0.6});
  wall.temperature = Linear(wall, {-0.1, 0, kWall_m}, 30.0, {0.1, 0, kWall_m}, 60.0);
  const Scene scene = builder.Build("wall");
  expert().set_rays_per_pixel_side(1);
  const Image<double> single = HotFractions(scene);
  expert().set_rays_per_pixel_side(4);
  FocusAt(0.6);
  EXPECT_EQ(HotFractions(scene), single);
}

TEST_F(PixelAverageTest, BlurIsOnePixelWideWhereTheDepthOfFieldEnds) {
  constexpr double kFocus_m = 0.6;
  FocusAt(kFocus_m);
  const PixelAverage average(camera_, options_);
  // Eq. (2.20) with the pixel's pitch as the circle.
  constexpr double kFocalLength_m = 0.008, kFNumber = 0.8;
  const double image_m = kFocalLength_m * kFocus_m / (kFocus_m - kFocalLength_m);
  const DepthOfField field =
      ComputeDepthOfField(kFocalLength_m, kFNumber, image_m / camera_.fx, kFocus_m);
  EXPECT_NEAR(average.BlurDiameterPx(field.near_m), 1.0, 1e-9);
  EXPECT_NEAR(average.BlurDiameterPx(field.far_m), 1.0, 1e-9);
  EXPECT_EQ(average.BlurDiameterPx(kFocus_m), 0.0);
  EXPECT_NEAR(average.BlurDiameterPx(HUGE_VAL), camera_.fx * 0.010 / kFocus_m, 1e-9);
}

/// Fraction of a disc on one side of a line at `distance` from its middle.
double DiscBeyond(double distance, double radius) {
  const double t = std::clamp(distance / radius, -1.0, 1.0);
  return 0.5 + (t * std::sqrt(1.0 - t * t) + std::asin(t)) / std::numbers::pi;
}

TEST_F(PixelAverageTest, AnEdgeOutOfFocusIsBlurredAsEquation220Says) {
  constexpr double kTolerance = 0.045;  // Of 144 rays, six at one end of the profile.
  constexpr double kFocalLength_m = 0.008, kFNumber = 0.8;
  expert().set_rays_per_pixel_side(12);
  for (const double focus_m : {0.4, 0.5, 0.8}) {
    FocusAt(focus_m);
    // (2.20b) solved for the circle's diameter on the detector.
    const double circle_m = kFocalLength_m * kFocalLength_m * std::abs(focus_m - kWall_m) /
                            (kFNumber * (focus_m - kFocalLength_m) * kWall_m);
    const double image_m = kFocalLength_m * focus_m / (focus_m - kFocalLength_m);
    const double radius_px = std::max(1e-9, 0.5 * circle_m / (image_m / camera_.fx));
    const Image<double> hot = HotFractions(HalfWall(0.0));
    for (int x = 0; x < camera_.width; ++x) {
      double expected = 0.0;
      constexpr int kStrips = 200;
      for (int i = 0; i < kStrips; ++i)
        expected += DiscBeyond(x + (i + 0.5) / kStrips - 0.5 - camera_.cx, radius_px) / kStrips;
      ASSERT_NEAR(hot.At(x, 20), expected, kTolerance) << "focus " << focus_m << ", column " << x;
    }
    // Between two columns the profile rises by as much of the edge's spread as lies there: a disc's
    // variance, the pixel's and that of the difference of two.
    double mean = 0.0, square = 0.0;
    for (int x = 0; x + 1 < camera_.width; ++x) {
      const double rise = hot.At(x + 1, 20) - hot.At(x, 20), middle = x + 0.5 - camera_.cx;
      mean += rise * middle;
      square += rise * middle * middle;
    }
    const double variance = 0.25 * radius_px * radius_px + 2.0 / 12.0;
    // 144 rays have up to 7 % less.
    EXPECT_NEAR((square - mean * mean) / variance, 1.0, 0.08) << "focus " << focus_m;
    EXPECT_NEAR(mean, 0.0, 0.02) << "focus " << focus_m;
  }
}

TEST_F(PixelAverageTest, BlurKeepsARadiatingSpotsTotal) {
  SceneBuilder builder(kCold_celsius);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Box("wall", {-3, -3, kWall_m}, {3, 3, 0.6}).temperature = Uniform(kCold_celsius);
  constexpr double kRadius_m = 0.004;
  builder.Disc("spot", {0.001, 0.002, kWall_m - 1e-5}, {0, 0, -1}, kRadius_m).temperature =
      Uniform(kHot_celsius);
  const Scene scene = builder.Build("spot");
  expert().set_rays_per_pixel_side(8);
  const double radius_px = kRadius_m / kWall_m * camera_.fx;
  const double area_px = std::numbers::pi * radius_px * radius_px;
  for (const double focus_m : {0.0, 0.5, 0.8}) {
    FocusAt(focus_m);
    const Image<double> hot = HotFractions(scene);
    double sum = 0.0;
    for (const double fraction : hot.pixels()) sum += fraction;
    EXPECT_NEAR(sum / area_px, 1.0, 0.01) << focus_m;
  }
}

TEST(LensOptionsTest, AreCheckedAndSayWhatIsWrong) {
  using Set = void (*)(SimulatedThermalExpertOptions&);
  struct Case {
    const char* names;
    Set set;
  };
  for (const Case& wrong : {
           Case{"rays_per_pixel_side", [](auto& o) { o.set_rays_per_pixel_side(0); }},
           Case{"rays_per_pixel_side", [](auto& o) { o.set_rays_per_pixel_side(17); }},
           Case{"rays_per_pixel_side must be 3", [](auto& o) { o.set_rays_per_pixel_side(2); }},
           Case{"3 or more with time_constant_s",
                [](auto& o) {
                  o.mutable_lens()->set_focus_m(0.0);
                  o.set_time_constant_s(0.01);
                  o.set_rays_per_pixel_side(2);
                }},
           Case{"lens.focus_m", [](auto& o) { o.mutable_lens()->set_focus_m(-0.5); }},
           Case{"lens.focus_m", [](auto& o) { o.mutable_lens()->set_focus_m(NAN); }},
           Case{"lens.focus_m", [](auto& o) { o.mutable_lens()->set_focus_m(HUGE_VAL); }},
           Case{"twice the focal length", [](auto& o) { o.mutable_lens()->set_focus_m(0.015); }},
           Case{"focal_length_mm", [](auto& o) { o.mutable_lens()->set_focal_length_mm(0); }},
           Case{"focal_length_mm", [](auto& o) { o.mutable_lens()->set_focal_length_mm(NAN); }},
           Case{"f_number", [](auto& o) { o.mutable_lens()->set_f_number(-1); }},
           Case{"f_number", [](auto& o) { o.mutable_lens()->set_f_number(HUGE_VAL); }},
       }) {
    SimulationOptions options;
    SimulatedThermalExpertOptions& expert = *options.mutable_thermal()->mutable_expert();
    expert.set_rays_per_pixel_side(3);
    expert.mutable_lens()->set_focus_m(0.6);
    ASSERT_TRUE(Validate(options).ok());
    wrong.set(expert);
    const Status status = Validate(options);
    EXPECT_FALSE(status.ok()) << wrong.names;
    EXPECT_NE(status.message().find(wrong.names), std::string::npos) << status.message();
  }
}

TEST(LensOptionsTest, TheRigTellsALensOnlyIfThereIsOne) {
  SimulationOptions options;
  EXPECT_FALSE(SimulatedRig(options)->thermal_sensor.lens);
  SimulatedThermalExpertOptions& expert = *options.mutable_thermal()->mutable_expert();
  expert.set_rays_per_pixel_side(3);
  expert.mutable_lens()->set_focus_m(0.6);
  const Result<Rig> rig = SimulatedRig(options);
  ASSERT_TRUE(rig && rig->thermal_sensor.lens);
  EXPECT_TRUE(Validate(rig->thermal_sensor).ok());
  EXPECT_EQ(rig->thermal_sensor.lens->focus_m, 0.6);
  EXPECT_NEAR(*rig->thermal_sensor.pixel_pitch_m, 0.008 * 0.6 / 0.592 / rig->thermal->fx, 1e-12);
}

}  // namespace
}  // namespace isotherm
