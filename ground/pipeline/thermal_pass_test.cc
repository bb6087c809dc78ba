#include "ground/pipeline/thermal_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "common/testing/volume_shapes.h"
#include "ground/pipeline/testing/pipeline_fixture.h"

namespace isotherm {
namespace {

constexpr float kPostCelsius = 90.0F, kWallCelsius = 30.0F;
/// The rig goes to the left by this from frame to frame, so that the depth camera comes to see what
/// only the thermal camera, 6 cm to its left, saw at the beginning.
constexpr double kLeft_m = 0.003;
/// It begins so far to the right that the volume does not end where it comes to look.
constexpr double kBegin_m = 0.10;
constexpr int kFrames = 24;

/// A wall with a ball on it, so that all directions are held, and at the left a thin hot post
/// before it. Metres, `world`.
double Post(const Eigen::Vector3d& p) {
  const Eigen::Vector3d q =
      (p - Eigen::Vector3d(0.125, 0.26, 0.45)).cwiseAbs() - Eigen::Vector3d(0.011, 0.2, 0.011);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}
double WallWithPost(const Eigen::Vector3d& p) {
  return std::min(testing::BallInCorner(p), Post(p));
}

class ThermalPassTest : public testing::PipelineFixture {
 protected:
  ThermalPassTest() {
    rig_.T_thermal_depth = MakeTransform({0.06, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  }
  static RigidTransform Pose(double frame) {
    return testing::FirstPose() *
           MakeTransform({kBegin_m - kLeft_m * frame, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  }

  DepthFrame DepthAt(int frame) const {
    DepthFrame depth = testing::RenderDepth(scene_, *rig_.depth, Pose(frame));
    depth.header.capture_time = Time(frame);
    return depth;
  }
  /// The only thermal frame, between the first two depth frames.
  ThermalFramePtr ThermalAt(double frame) const {
    auto thermal = std::make_shared<ThermalFrame>();
    thermal->header.capture_time = Time(frame);
    thermal->valid = true;
    const CameraModel& camera = *rig_.thermal;
    thermal->temperature_raw = Image<std::uint16_t>(camera.width, camera.height);
    const RigidTransform T_map_thermal = Pose(frame) * rig_.T_thermal_depth->inverse();
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const double z = testing::TraceDepth(scene_, camera, T_map_thermal, u, v);
        const Eigen::Vector2d xy = Unproject(camera, {u, v});
        const Eigen::Vector3d p = T_map_thermal * Eigen::Vector3d(xy.x() * z, xy.y() * z, z);
        const float celsius = Post(p) < 1e-3 ? kPostCelsius : kWallCelsius;
        thermal->temperature_raw.At(u, v) =
            static_cast<std::uint16_t>(std::lround((celsius + 273.15) * 100.0));
      }
    }
    return thermal;
  }

  void StartHere() {
    auto created = GroundPipeline::Create(options_, rig_, Pose(0));
    ASSERT_TRUE(created.has_value()) << created.error().message();
    pipeline_ = std::move(*created);
  }
  void Scan() {
    StartHere();
    pipeline_->ProcessDepth(DepthAt(0));
    pipeline_->ProcessThermal(ThermalAt(0.5));
    for (int i = 1; i < kFrames; ++i) pipeline_->ProcessDepth(DepthAt(i));
    pipeline_->Finish();
    ASSERT_EQ(pipeline_->model().counts.depth_tracked, std::uint64_t{kFrames});
    ASSERT_EQ(pipeline_->model().counts.thermal_fused, 1U);
  }
  void ScanAgain() {
    const std::unique_ptr<ThermalPass> pass = pipeline_->BeginThermalPass();
    ASSERT_NE(pass, nullptr);
    pass->ProcessDepth(DepthAt(0));
    pass->ProcessThermal(ThermalAt(0.5));
    for (int i = 1; i < kFrames; ++i) pass->ProcessDepth(DepthAt(i));
    pass->Finish();
  }
  ThermalVoxel At(const Eigen::Vector3d& p_map) const {
    const ScanModel model = pipeline_->model();
    return ThermalVoxelAt(model.tsdf(), model.thermal(), p_map);
  }

  std::function<double(const Eigen::Vector3d&)> scene_ = testing::BallInCorner;
};

/// A point on the far wall that the first ray meets.
Eigen::Vector3d OnSurface(const testing::SignedDistance& scene, double x, double y) {
  Eigen::Vector3d p(x, y, 0.05);
  for (int i = 0; i < 200; ++i) p.z() += scene(p);
  return p;
}

TEST_F(ThermalPassTest, SurfaceThatTheDepthCameraSawOnlyLaterTakesTheTemperature) {
  Scan();
  // Half-way between the left border of the depth camera's first view and that of the thermal
  // camera's.
  const double z_m = OnSurface(scene_, 0.08, 0.20).z();
  const double border = 159.5 / 285.0;
  const Eigen::Vector3d p = OnSurface(scene_, 0.37 - border * z_m, 0.20);
  ASSERT_NEAR(p.z(), z_m, 0.02);
  EXPECT_FALSE(At(p).measured()) << "not in the first depth frame";
  ScanAgain();
  ASSERT_TRUE(At(p).measured());
  EXPECT_NEAR(At(p).celsius(), kWallCelsius, 0.1F);
}

TEST_F(ThermalPassTest, WhatWasScannedLaterHidesWhatLiesBehindIt) {
  scene_ = WallWithPost;
  Scan();
  ScanAgain();
  const ScanModel model = pipeline_->model();
  int hot_post = 0, cold_wall = 0, wrong = 0;
  for (std::int32_t block = 0; block < model.tsdf().block_count(); ++block) {
    testing::ForEachVoxel(
        model.thermal().voxels(block), model.tsdf().grid(), model.tsdf().block_coordinates(block),
        [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
          if (!voxel.measured()) return;
          const bool is_hot = voxel.celsius() > 0.5F * (kPostCelsius + kWallCelsius);
          const bool is_post = Post(p) < 0.01;
          hot_post += is_hot && is_post ? 1 : 0;
          cold_wall += !is_hot && !is_post ? 1 : 0;
          wrong += is_hot != is_post ? 1 : 0;
        });
  }
  EXPECT_GT(hot_post, 50);
  EXPECT_GT(cold_wall, 5'000);
  EXPECT_EQ(wrong, 0);
}

TEST_F(ThermalPassTest, CountsAreThoseOfThePassAlone) {
  Scan();
  const ScanCounts first = pipeline_->model().counts;
  ScanAgain();
  const ScanCounts& again = pipeline_->model().counts;
  EXPECT_EQ(again.thermal_in, first.thermal_in);
  EXPECT_EQ(again.thermal_fused, first.thermal_fused);
  EXPECT_EQ(again.depth_in, first.depth_in);
  EXPECT_GT(again.fusion.assigned, first.fusion.assigned);
}

TEST_F(ThermalPassTest, FramesAroundALossHaveNoPose) {
  StartHere();
  pipeline_->ProcessDepth(DepthAt(0));
  pipeline_->ProcessThermal(ThermalAt(0.5));
  pipeline_->ProcessDepth(DepthAt(1));
  pipeline_->Finish();
  const std::unique_ptr<ThermalPass> pass = pipeline_->BeginThermalPass();
  ASSERT_NE(pass, nullptr);
  pass->ProcessDepth(DepthAt(0));
  pass->ProcessThermal(ThermalAt(1.2));
  pass->ProcessDepth(DepthAt(2));  // Was never tracked.
  pass->ProcessThermal(ThermalAt(2.5));
  pass->Finish();
  EXPECT_EQ(pipeline_->model().counts.thermal_fused, 0U);
  EXPECT_EQ(LeftOut(LeftOutReason::kNoDepthAfter), 2U);
}

TEST_F(ThermalPassTest, WithoutTemperaturesThereIsNothingToDo) {
  StartHere();
  for (int i = 0; i < 3; ++i) pipeline_->ProcessDepth(DepthAt(i));
  pipeline_->Finish();
  EXPECT_EQ(pipeline_->BeginThermalPass(), nullptr);
}

}  // namespace
}  // namespace isotherm
