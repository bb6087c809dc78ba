#include "common/simulation/depth_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/frame/frame.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSeed = 3;

/// A camera at the origin in front of what each test builds.
class DepthSensorTest : public ::testing::Test {
 protected:
  DepthSensorTest() : builder_(23.0), camera_(*DefaultSimulatedRig().depth) {
    std::cout << "seed " << kSeed << '\n';
    builder_.UseMaterial({});
    options_.mutable_expert()->set_depth_scale(
        10000.0);  // Fine units: what is looked at here is disparity.
  }

  void AddWall(double distance_m) {
    builder_.Box("wall", {-3, -3, distance_m}, {3, 3, distance_m + 0.1});
  }
  Image<std::uint16_t> Render(std::uint64_t frame = 0) {
    const DepthSensor sensor(camera_, options_);
    DepthSensor::Scratch scratch;
    return sensor.Render(builder_.Build("test"), RigidTransform::Identity(),
                         NoiseStream(kSeed, 0, frame), scratch);
  }
  double DisparityStepM(double depth_m) const {
    return depth_m * depth_m * options_.expert().disparity_step_px() /
           (camera_.fx * options_.expert().baseline_m());
  }

  SceneBuilder builder_;
  CameraModel camera_;
  SimulatedDepthOptions options_ = IdealDepthCamera({});
};

TEST_F(DepthSensorTest, WithoutNoiseAndStepsDepthIsTrue) {
  options_.mutable_expert()->set_disparity_noise_px(0.0);
  options_.mutable_expert()->set_disparity_step_px(0.0);
  AddWall(0.7);
  const Image<std::uint16_t> depth = Render();
  for (const std::uint16_t raw : depth.pixels()) EXPECT_NEAR(raw, 7000, 1);
}

TEST_F(DepthSensorTest, DepthComesInStepsThatGrowWithTheSquareOfTheDistance) {
  options_.mutable_expert()->set_disparity_noise_px(0.0);
  // A wall that recedes from 0.5 m to 1 m, seen steeply enough for returns.
  builder_.RotatedBox("slope", {0.0, 0.0, 0.75}, {4.0, 4.0, 0.001}, {0.0, 40.0, 0.0});
  const Image<std::uint16_t> depth = Render();
  std::set<std::uint16_t> values;
  for (const std::uint16_t raw : depth.Row(240)) {
    if (raw != kNoDepth) values.insert(raw);
  }
  ASSERT_GT(values.size(), 50U);
  const double units = 10000.0;
  for (auto it = values.begin(); std::next(it) != values.end(); ++it) {
    const double middle_m = (*it + *std::next(it)) / 2.0 / units;
    const double step_m = (*std::next(it) - *it) / units;
    EXPECT_NEAR(step_m, DisparityStepM(middle_m), 2.0 / units) << middle_m;
  }
  EXPECT_NEAR(DisparityStepM(0.5), 0.00073, 0.00001);  // 1/8 px at f = 567.7 px, 75 mm.
}

TEST_F(DepthSensorTest, NoiseGrowsWithTheSquareOfTheDistance) {
  options_.mutable_expert()->set_disparity_step_px(0.0);
  for (const double distance_m : {0.5, 0.7, 1.0, 1.3}) {
    builder_ = SceneBuilder(23.0);
    builder_.UseMaterial({});
    AddWall(distance_m);
    double sum = 0.0, squares = 0.0;
    const Image<std::uint16_t> depth = Render();
    for (const std::uint16_t raw : depth.pixels()) {
      const double error_m = raw / 10000.0 - distance_m;
      sum += error_m;
      squares += error_m * error_m;
    }
    const double count = static_cast<double>(depth.size());
    const double sigma_m = std::sqrt(squares / count);
    const double expected_m = distance_m * distance_m * options_.expert().disparity_noise_px() /
                              (camera_.fx * options_.expert().baseline_m());
    EXPECT_NEAR(sigma_m / expected_m, 1.0, 0.03) << distance_m;
    EXPECT_LT(std::abs(sum / count), 0.05 * expected_m) << distance_m;
  }
}

TEST_F(DepthSensorTest, DefaultNoiseIsThatOfTheDataSheet) {
  // PrimeSense Carmine 1.09: 1.0 mm (2 sigma) at 0.5 m.
  AddWall(0.5);
  double squares = 0.0;
  const Image<std::uint16_t> depth = Render();
  for (const std::uint16_t raw : depth.pixels()) squares += std::pow(raw / 10.0 - 500.0, 2);
  const double two_sigma_mm = 2.0 * std::sqrt(squares / static_cast<double>(depth.size()));
  EXPECT_NEAR(two_sigma_mm, 1.0, 0.15);
}

TEST_F(DepthSensorTest, NeighboursShareTheirNoiseAndFramesDoNot) {
  options_.mutable_expert()->set_disparity_step_px(0.0);
  AddWall(1.0);
  const Image<std::uint16_t> first = Render(0), second = Render(1);
  const auto correlation = [&](const Image<std::uint16_t>& other, int dx, int dy) {
    double product = 0.0, squares = 0.0;
    for (int y = 0; y + 10 < first.height(); ++y) {
      for (int x = 0; x + 10 < first.width(); ++x) {
        const double a = first.At(x, y) - 10000.0, b = other.At(x + dx, y + dy) - 10000.0;
        product += a * b;
        squares += a * a;
      }
    }
    return product / squares;
  };
  EXPECT_NEAR(correlation(first, 1, 0), 4.0 / 6.0, 0.03);
  EXPECT_NEAR(correlation(first, 0, 1), 4.0 / 6.0, 0.03);
  EXPECT_NEAR(correlation(first, 4, 0), 0.0, 0.03);
  EXPECT_NEAR(correlation(second, 0, 0), 0.0, 0.03);
}

TEST_F(DepthSensorTest, TheSameStreamGivesTheSameImage) {
  AddWall(0.8);
  EXPECT_EQ(Render(5), Render(5));
  EXPECT_NE(Render(5), Render(6));
}

TEST_F(DepthSensorTest, NothingReturnsOutOfRange) {
  for (const double distance_m : {0.30, 1.5}) {
    builder_ = SceneBuilder(23.0);
    builder_.UseMaterial({});
    AddWall(distance_m);
    const Image<std::uint16_t> depth = Render();
    for (const std::uint16_t raw : depth.pixels()) ASSERT_EQ(raw, kNoDepth);
  }
}

TEST_F(DepthSensorTest, GrazingSurfacesHaveHoles) {
  // Spheres show all angles; the fraction of returns falls from 1 to 0 between the two limits.
  builder_.Sphere("ball", {0.0, 0.0, 0.8}, 0.25);
  options_.mutable_expert()->set_edge_dropout(0.0);
  const Image<std::uint16_t> depth = Render();
  const Scene scene = builder_.Build("test");
  int steep = 0, steep_returns = 0, between = 0, between_returns = 0;
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = camera_.width / 2; x < camera_.width; ++x) {  // The lit side.
      const Vector3d direction = Unproject(camera_, Eigen::Vector2d(x, y)).homogeneous();
      const auto hit = scene.Intersect(Vector3d::Zero(), direction);
      if (!hit) continue;
      const double angle =
          std::acos(std::abs(hit->point.n_world.dot(direction.normalized()))) / kRadPerDeg;
      if (angle > options_.expert().grazing_end_deg() + 0.1) {
        EXPECT_EQ(depth.At(x, y), kNoDepth);
      }
      if (angle > 20.0 && angle < options_.expert().grazing_start_deg() - 0.1) {
        ++steep;
        steep_returns += depth.At(x, y) != kNoDepth;
      }
      if (angle > 74.0 && angle < 78.0) {
        ++between;
        between_returns += depth.At(x, y) != kNoDepth;
      }
    }
  }
  EXPECT_GT(steep_returns, 0.999 * steep);
  EXPECT_GT(between_returns, 0.3 * between);
  EXPECT_LT(between_returns, 0.7 * between);
}

TEST_F(DepthSensorTest, ThingsThrowAShadowToTheLeftAsWideAsTheDisparityDifference) {
  constexpr double kNear_m = 0.6, kFar_m = 0.9;
  builder_.Box("near", {-0.05, -0.05, kNear_m}, {0.05, 0.05, kNear_m + 0.001});
  AddWall(kFar_m);
  options_.mutable_expert()->set_edge_dropout(0.0);
  const Image<std::uint16_t> depth = Render();
  const int row = camera_.height / 2;
  int holes = 0, last_hole = -1;
  for (int x = 0; x < camera_.width; ++x) {
    if (depth.At(x, row) != kNoDepth) continue;
    ++holes;
    last_hole = x;
  }
  const double expected_px =
      camera_.fx * options_.expert().baseline_m() * (1.0 / kNear_m - 1.0 / kFar_m);
  EXPECT_NEAR(holes, expected_px, 2.0);
  // It ends where the near thing begins.
  EXPECT_NEAR(last_hole, camera_.cx - 0.05 / kNear_m * camera_.fx, 2.0);
}

TEST_F(DepthSensorTest, EdgesLoseTheFractionThatTheOptionsSay) {
  builder_.Box("near", {-0.2, -0.2, 0.6}, {0.2, 0.2, 0.601});
  AddWall(0.9);
  options_.mutable_expert()->set_edge_dropout(0.5);
  const Image<std::uint16_t> depth = Render();
  // The right edge has no shadow.
  const int edge = static_cast<int>(std::floor(camera_.cx + 0.2 / 0.6 * camera_.fx));
  int holes = 0;
  const int top = 150, bottom = 350;
  for (int y = top; y < bottom; ++y) holes += depth.At(edge, y) == kNoDepth;
  EXPECT_NEAR(holes, 0.5 * (bottom - top), 30);
  for (int y = top; y < bottom; ++y) EXPECT_NE(depth.At(edge - 3, y), kNoDepth);
}

TEST_F(DepthSensorTest, PixelsFlyBetweenTheSurfacesOfAnEdgeWhereTheOptionsSay) {
  builder_.Box("near", {-0.2, -0.2, 0.6}, {0.2, 0.2, 0.601});
  AddWall(0.9);
  options_.mutable_expert()->set_edge_dropout(0.0);
  options_.mutable_expert()->set_flying_fraction(0.4);
  const Image<std::uint16_t> depth = Render();
  // The right edge has no shadow.
  const int edge = static_cast<int>(std::floor(camera_.cx + 0.2 / 0.6 * camera_.fx));
  const int top = 150, bottom = 350;
  int flying = 0;
  for (int y = top; y < bottom; ++y) {
    for (const int x : {edge, edge + 1}) flying += depth.At(x, y) > 6300 && depth.At(x, y) < 8700;
    for (const int x : {edge - 2, edge + 3})
      ASSERT_FALSE(depth.At(x, y) > 6300 && depth.At(x, y) < 8700);
  }
  // Of those that fly, four fifths are neither near one surface nor near the other.
  EXPECT_NEAR(flying, 0.8 * 0.4 * 2 * (bottom - top), 35);
}

TEST_F(DepthSensorTest, RowsThatAreReadLaterSeeThingsLater) {
  constexpr double kReadout_s = 0.030, kSpeed_m_s = 0.4, kNear_m = 0.6;
  builder_.Box("near", {-0.1, -3, kNear_m}, {0.1, 3, kNear_m + 0.001});
  AddWall(0.9);
  options_.mutable_expert()->set_edge_dropout(0.0);
  options_.mutable_expert()->set_readout_s(kReadout_s);
  const DepthSensor sensor(camera_, options_);
  DepthSensor::Scratch scratch;
  const Image<std::uint16_t> depth = sensor.RenderMoving(
      builder_.Build("test"),
      [](double seconds) {
        return MakeTransform({kSpeed_m_s * seconds, 0, 0}, Eigen::Quaterniond::Identity());
      },
      1.0, NoiseStream(kSeed, 0, 0), scratch);
  // Last column of the near thing, whose right edge has no shadow.
  const auto edge_column = [&](int y) {
    int last = 0;
    for (int x = 0; x < camera_.width; ++x) {
      if (depth.At(x, y) != kNoDepth && depth.At(x, y) < 7000) last = x;
    }
    return last;
  };
  const double shift_px = kSpeed_m_s * kReadout_s * camera_.fx / kNear_m;
  ASSERT_GT(shift_px, 10.0);
  EXPECT_NEAR(edge_column(0) - edge_column(camera_.height - 1), shift_px, 1.5);
  EXPECT_NEAR(edge_column(camera_.height / 2), camera_.cx + 0.1 / kNear_m * camera_.fx, 1.5);
}

TEST_F(DepthSensorTest, AWarmCameraShowsDistancesThatAreTooLong) {
  options_.mutable_expert()->set_disparity_step_px(0.0);
  AddWall(0.8);
  const DepthSensor sensor(camera_, options_);
  DepthSensor::Scratch scratch;
  const auto pose = [](double) { return RigidTransform::Identity(); };
  const Image<std::uint16_t> depth =
      sensor.RenderMoving(builder_.Build("test"), pose, 1.01, NoiseStream(kSeed, 0, 0), scratch);
  double sum = 0.0;
  for (const std::uint16_t raw : depth.pixels()) sum += raw;
  EXPECT_NEAR(sum / static_cast<double>(depth.size()), 1.01 * 8000.0, 2.0);
}

TEST_F(DepthSensorTest, DistancesSwellTowardsTheCorners) {
  options_.mutable_expert()->set_disparity_noise_px(0.0);
  options_.mutable_expert()->set_disparity_step_px(0.0);
  options_.mutable_expert()->set_corner_swelling(0.02);
  AddWall(0.8);
  const Image<std::uint16_t> depth = Render();
  EXPECT_NEAR(depth.At(320, 240), 8000, 1);
  EXPECT_NEAR(depth.At(639, 479), 8160, 1);
  EXPECT_NEAR(depth.At(0, 0), 8160, 1);
  // 319.5 of 399.4 pixels from the middle: 0.64 of the swelling.
  EXPECT_NEAR(depth.At(0, 240), 8102, 1);
}

TEST(DepthSensorOptionsTest, AreCheckedAndSayWhatIsWrong) {
  using Set = void (*)(SimulatedDepthExpertOptions&, double);
  struct Case {
    const char* name;
    Set set;
    std::vector<double> wrong;
  };
  for (const Case& one :
       {Case{"flying_fraction", [](auto&o, double v) { o.set_flying_fraction(v); }, {-0.1, 1.1}},
        Case{"depth.expert.readout_s", [](auto&o, double v) { o.set_readout_s(v); }, {-0.01, 2.0}},
        Case{"warm_up_stretch", [](auto&o, double v) { o.set_warm_up_stretch(v); }, {-0.2, 0.2}},
        Case{"corner_swelling", [](auto&o, double v) { o.set_corner_swelling(v); }, {-0.2, 0.2}},
        Case{"warm_up_time_constant_s",
             [](auto&o, double v) { o.set_warm_up_time_constant_s(v); },
             {0.0, -1.0}}}) {
    std::vector<double> wrong = one.wrong;
    wrong.insert(wrong.end(), {NAN, HUGE_VAL, -HUGE_VAL});
    for (const double value : wrong) {
      SimulationOptions options;
      one.set(*options.mutable_depth()->mutable_expert(), value);
      const Status status = Validate(options);
      EXPECT_FALSE(status.ok()) << one.name << " " << value;
      EXPECT_NE(status.message().find(one.name), std::string::npos) << status.message();
    }
  }
}

TEST_F(DepthSensorTest, AnySizeAndUnitWorks) {
  camera_ = camera_.Downscaled(2);
  camera_.width = 101;
  camera_.height = 77;
  options_.mutable_expert()->set_depth_scale(5000.0);
  AddWall(0.8);
  const Image<std::uint16_t> depth = Render();
  EXPECT_EQ(depth.width(), 101);
  EXPECT_EQ(depth.height(), 77);
  EXPECT_NEAR(depth.At(50, 38), 4000, 60);
}

}  // namespace
}  // namespace isotherm
