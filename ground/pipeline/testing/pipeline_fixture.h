#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "common/base/units.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm::testing {

/// A pipeline to which a rig with both cameras shows a ball in a corner, going along it slowly: the
/// whole scan line of the ground, on known frames.
class PipelineFixture : public ::testing::Test {
 protected:
  static constexpr double kStep = 0.003;  // Metres per frame.

  PipelineFixture() {
    rig_.depth = SmallDepthCamera();
    rig_.thermal = rig_.depth;
    rig_.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    *options_.mutable_volume() = SmallVolume();
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(kSmallTruncation_m);
    options_.set_threads(2);
    Start();
  }
  void Start() {
    auto created = GroundPipeline::Create(options_, rig_, FirstPose());
    ASSERT_TRUE(created.has_value()) << created.error().message();
    pipeline_ = std::move(*created);
  }

  static RigidTransform TruePose(int i) {
    const double orientation = 0.3 * i * kRadPerDeg;
    return FirstPose() * MakeTransform({kStep * i, 0.5 * kStep * i, 0.0},
                                       Eigen::Quaterniond(Eigen::AngleAxisd(
                                           -orientation, Eigen::Vector3d::UnitY())));
  }
  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }

  /// The depth frame that is taken at the pose of frame `i`.
  DepthReport Depth(int i) {
    DepthFrame frame = RenderDepth(BallInCorner, *rig_.depth, TruePose(i));
    frame.header.capture_time = Time(i);
    return pipeline_->ProcessDepth(frame);
  }
  /// A hand is before the depth camera.
  DepthReport Covered(int i) {
    DepthFrame frame;
    frame.depth_raw =
        Image<std::uint16_t>(rig_.depth->width, rig_.depth->height, kNoDepthSaturated);
    frame.header.capture_time = Time(i);
    return pipeline_->ProcessDepth(frame);
  }
  /// All that the thermal camera sees has 50 degrees Celsius. `at` in depth frames.
  void Thermal(double at, bool valid = true, Nanoseconds sigma = Nanoseconds(0)) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = Time(at);
    frame->header.capture_sigma = sigma;
    frame->temperature_raw =
        Image<std::uint16_t>(rig_.thermal->width, rig_.thermal->height, 32'315);  // 50 °C
    frame->valid = valid;
    pipeline_->ProcessThermal(frame);
  }
  std::uint64_t LeftOut(LeftOutReason reason) const {
    return pipeline_->model().counts.thermal_left_out[reason];
  }

  Rig rig_;
  GroundOptions options_;
  std::unique_ptr<GroundPipeline> pipeline_;
};

}  // namespace isotherm::testing
