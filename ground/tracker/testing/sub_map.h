#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "common/testing/volume_shapes.h"
#include "ground/atlas/sub_map.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm::testing {

/// Sub-maps whose surface is exact, and depth frames of a rig that moves before them.
class SubMapTest : public ::testing::Test {
 protected:
  SubMapTest() {
    *options_.mutable_volume() = SmallVolume();
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(kSmallTruncation_m);
  }

  VoxelGrid Grid() const { return MakeVoxelGrid(options_.volume()).value(); }
  SubMap MakeSubMap() const {
    const std::int32_t max_blocks = MaxBlocks(options_.volume(), Grid());
    SubMap map;
    map.tsdf = std::make_unique<TsdfVolume>(Grid(), kSmallTruncation_m, max_blocks);
    map.thermal = std::make_unique<ThermalVolume>(max_blocks);
    map.relocaliser = std::make_unique<Relocaliser>(options_.relocaliser(), camera_);
    return map;
  }
  static void Fill(SubMap& map, const SignedDistance& distance_m) {
    FillVolume(*map.tsdf, distance_m);
  }

  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }
  /// 3 mm further along x in each frame.
  static RigidTransform TruePose(int i) {
    return FirstPose() *
           MakeTransform({0.003 * i, 0.0015 * i, 0.0}, Eigen::Quaterniond::Identity());
  }
  /// Valid until the next one is prepared.
  const PreparedDepth& Prepare(const SignedDistance& distance_m, const RigidTransform& pose) {
    return preprocessor_.Process(RenderDepth(distance_m, camera_, pose), pool_);
  }
  const PreparedDepth& Nothing() {
    DepthFrame frame;
    frame.depth_raw = Image<std::uint16_t>(camera_.width, camera_.height, kNoDepth);
    return preprocessor_.Process(frame, pool_);
  }

  GroundOptions options_;
  const CameraModel camera_ = SmallDepthCamera();
  ThreadPool pool_{2};
  DepthPreprocessor preprocessor_{options_.preprocessor(), camera_, DepthSensorModel()};
};

}  // namespace isotherm::testing
