#include "common/simulation/scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/surface_sampling.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-9;

std::vector<StagedScene> AllScenes() {
  std::vector<StagedScene> scenes;
  for (int i = 0; i < SimulatedScene_ARRAYSIZE; ++i) {
    SceneOptions options;
    options.set_scene(static_cast<SimulatedScene>(i));
    scenes.push_back(MakeScene(options));
  }
  return scenes;
}

TEST(TemperatureFieldTest, RunsAlongItsLineAndAroundItsAxis) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  Primitive& box = builder.RotatedBox("box", {0.1, 0.2, 0.3}, {0.2, 0.2, 0.2}, {20.0, -30.0, 70.0});
  const auto celsius_at = [&](const Vector3d& p_world) {
    return box.temperature.CelsiusAt(box.T_world_primitive.inverse() * p_world);
  };
  box.temperature = Linear(box, {0.0, 0.2, 0.3}, 20.0, {0.2, 0.2, 0.3}, 60.0);
  EXPECT_NEAR(celsius_at({0.05, 0.7, -1.0}), 30.0, kRounding);
  EXPECT_NEAR(celsius_at({-1.0, 0.2, 0.3}), 20.0, kRounding);
  EXPECT_NEAR(celsius_at({1.0, 0.2, 0.3}), 60.0, kRounding);
  box.temperature = Radial(box, {0.1, 0.2, 0.0}, {0.0, 0.0, 1.0}, 100.0, 0.1, 40.0);
  EXPECT_NEAR(celsius_at({0.1, 0.2, 0.5}), 100.0, kRounding);
  EXPECT_NEAR(celsius_at({0.15, 0.2, -0.5}), 70.0, kRounding);
  EXPECT_NEAR(celsius_at({0.1, 0.4, 0.1}), 40.0, kRounding);
}

TEST(SceneTest, TheNearestSurfaceIsSeen) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("behind", {-1, -1, 1.0}, {1, 1, 1.1}).temperature = Uniform(50.0);
  builder.Sphere("ball", {0.0, 0.0, 0.6}, 0.1).temperature = Uniform(70.0);
  const Scene scene = builder.Build("test");
  const auto ball = scene.Intersect(Vector3d::Zero(), {0.0, 0.0, 1.0});
  ASSERT_TRUE(ball);
  EXPECT_NEAR(ball->distance, 0.5, kRounding);
  EXPECT_NEAR(ball->point.celsius, 70.0, kRounding);
  EXPECT_TRUE(ball->point.n_world.isApprox(Vector3d(0, 0, -1)));
  const auto behind = scene.Intersect(Vector3d::Zero(), {0.0, 0.5, 1.0});
  ASSERT_TRUE(behind);
  EXPECT_NEAR(behind->distance, 1.0, kRounding);
  EXPECT_EQ(behind->point.primitive, 0);
  EXPECT_FALSE(scene.Intersect(Vector3d::Zero(), {0.0, 0.0, -1.0}));
}

TEST(SceneTest, ApparentTemperatureFollowsEmissivityAndSurroundings) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({0.96, 1.5, 0.0, false});
  builder.Box("plate", {-1, -1, 1.0}, {1, 1, 1.1}).temperature = Uniform(280.0);
  const Scene scene = builder.Build("test");
  const BandRadiance band;
  const auto seen_at = [&](double angle_rad) {
    const Vector3d viewer(-std::tan(angle_rad), 0.0, 0.0);
    const auto hit = scene.Intersect(viewer, -viewer + Vector3d(0, 0, 1));
    return TrueApparentCelsius(scene, band, hit->point, viewer);
  };
  EXPECT_NEAR(seen_at(0.0), ApparentCelsius(band, 280.0, 0.96, 23.0), 1e-6);
  const double sixty = std::numbers::pi / 3.0;
  EXPECT_NEAR(seen_at(sixty),
              ApparentCelsius(band, 280.0, DirectionalEmissivity(sixty, 0.96, 1.5, 0.0), 23.0),
              1e-6);
  EXPECT_LT(seen_at(1.3), seen_at(sixty));
}

TEST(SceneTest, AMirrorShowsWhatIsOpposite) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({0.2, 12.0, 40.0, true});
  builder.RotatedBox("mirror", {0, 0, 1}, {0.4, 0.4, 0.01}, {0, 45, 0}).temperature = Uniform(23.0);
  builder.UseMaterial({1.0, 1.0, 0.0, false});
  builder.Box("heater", {-0.6, -0.3, 0.7}, {-0.5, 0.3, 1.3}).temperature = Uniform(200.0);
  builder.Box("wall on the other side", {0.5, -0.3, 0.7}, {0.6, 0.3, 1.3}).temperature =
      Uniform(400.0);
  const Scene scene = builder.Build("test");
  const BandRadiance band;
  const auto hit = scene.Intersect(Vector3d::Zero(), {0.0, 0.0, 1.0});
  ASSERT_TRUE(hit);
  ASSERT_EQ(hit->point.primitive, 0);
  const double emissivity = DirectionalEmissivity(std::numbers::pi / 4.0, 0.2, 12.0, 40.0);
  // The line of sight leaves towards the side that the mirror is turned to.
  const double facing = hit->point.n_world.x() < 0.0 ? 200.0 : 400.0;
  EXPECT_NEAR(TrueApparentCelsius(scene, band, hit->point, Vector3d::Zero()),
              ApparentCelsius(band, 23.0, emissivity, facing), 1e-6);
}

TEST(ScenesTest, EveryPartFitsTheCube) {
  for (const StagedScene& staged : AllScenes()) {
    if (staged.scene.name() == "flat-wall") continue;  // It goes on beyond.
    for (const SurfaceSample& sample : SampleSurface(staged.scene, 0.01)) {
      const std::string& part =
          staged.scene.primitives()[static_cast<std::size_t>(sample.point.primitive)].name;
      EXPECT_TRUE((sample.point.p_world.array() >= 0.0).all() &&
                  (sample.point.p_world.array() <= kSceneCube_m).all())
          << staged.scene.name() << ": " << part << " " << sample.point.p_world.transpose();
    }
  }
}

TEST(ScenesTest, TheHotPartHasTheTemperatureThatIsAskedFor) {
  for (int i = 0; i < SimulatedScene_ARRAYSIZE; ++i) {
    SceneOptions options;
    options.set_scene(static_cast<SimulatedScene>(i));
    options.set_hot_celsius(111.0);
    double hottest = 0.0;
    const StagedScene staged = MakeScene(options);
    for (const SurfaceSample& sample : SampleSurface(staged.scene, 0.004)) {
      hottest = std::max(hottest, sample.point.celsius);
    }
    EXPECT_GE(hottest, 110.5) << staged.scene.name();
  }
}

TEST(SurfaceSamplingTest, PointsLieOnVisibleSurfacesWithTheirNormal) {
  for (const StagedScene& staged : AllScenes()) {
    const std::vector<SurfaceSample> samples = SampleSurface(staged.scene, 0.02);
    ASSERT_GT(samples.size(), 500U) << staged.scene.name();
    for (const SurfaceSample& sample : samples) {
      // From very near along the normal nothing else is in between.
      constexpr double kNear_m = 2e-5;
      const auto hit = staged.scene.Intersect(sample.point.p_world + kNear_m * sample.point.n_world,
                                              -sample.point.n_world);
      ASSERT_TRUE(hit);
      const std::string& part =
          staged.scene.primitives()[static_cast<std::size_t>(sample.point.primitive)].name;
      EXPECT_NEAR(hit->distance, kNear_m, 1e-9) << staged.scene.name() << " " << part;
      EXPECT_NEAR(hit->point.celsius, sample.point.celsius, 1e-6) << staged.scene.name() << part;
    }
  }
}

TEST(SurfaceSamplingTest, SpacingIsAsAskedFor) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("cube", {0.1, 0.1, 0.1}, {0.5, 0.5, 0.5});
  const auto samples = SampleSurface(builder.Build("test"), 0.01);
  EXPECT_EQ(samples.size(), 6U * 40U * 40U);
}

TEST(SurfaceSamplingTest, OnlyWhatFacesTheCameraIsSeen) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("front", {-0.1, -0.1, 0.5}, {0.1, 0.1, 0.52});
  builder.Box("hidden", {-0.05, -0.05, 0.6}, {0.05, 0.05, 0.62});
  const Scene scene = builder.Build("test");
  auto samples = SampleSurface(scene, 0.01);
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 567.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  CountSeen(scene, camera, RigidTransform::Identity(), 2.0, SeenBy::kDepth, samples);
  for (const SurfaceSample& sample : samples) {
    const bool front_face = sample.point.primitive == 0 && sample.point.n_world.z() < -0.5;
    EXPECT_EQ(sample.seen_depth, front_face ? 1 : 0) << sample.point.p_world.transpose();
    EXPECT_EQ(sample.seen_thermal, 0);
  }
  CountSeen(scene, camera, RigidTransform::Identity(), 0.3, SeenBy::kThermal, samples);
  for (const SurfaceSample& sample : samples) EXPECT_EQ(sample.seen_thermal, 0);
}

TEST(SurfaceSamplingTest, PlyHasTheSizeItsHeaderPromises) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Sphere("ball", {0.5, 0.5, 0.5}, 0.1);
  const auto samples = SampleSurface(builder.Build("test"), 0.02);
  const auto path = std::filesystem::temp_directory_path() /
                    ("isotherm_surface_sampling_test_" + std::to_string(getpid()) + ".ply");
  ASSERT_TRUE(WriteSurfacePly(path, samples).ok());
  std::ifstream file(path, std::ios::binary);
  const std::string content((std::istreambuf_iterator<char>(file)), {});
  std::filesystem::remove(path);
  constexpr std::size_t kBytesPerPoint = 7 * 4 + 1 + 2 + 2;
  const std::size_t header = content.find("end_header\n") + 11;
  EXPECT_EQ(content.size(), header + samples.size() * kBytesPerPoint);
  EXPECT_NE(content.find("element vertex " + std::to_string(samples.size())), std::string::npos);
  EXPECT_EQ(WriteSurfacePly("/no such folder/x.ply", samples).code(), StatusCode::kIoError);
}

}  // namespace
}  // namespace isotherm
