#include "ground/experiment/thesis_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/rectified_camera.h"
#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

/// A hot ball in front of a cold wall, both in the model. The thermal camera is to the right of the
/// depth camera, so that the ball hides another part of the wall from it.
class ThesisFuserTest : public ::testing::Test {
 protected:
  static constexpr double kHot = 80.0, kCold = 20.0;

  ThesisFuserTest() {
    CameraModel camera;
    camera.width = 320;
    camera.height = 240;
    camera.fx = camera.fy = 283.0;
    camera.cx = 159.5;
    camera.cy = 119.5;
    rig_.depth = rig_.thermal = camera;
    VolumeOptions volume;
    volume.set_size_x_m(0.64);
    volume.set_size_y_m(0.64);
    volume.set_size_z_m(0.64);
    volume.set_voxel_size_m(0.004);
    const VoxelGrid grid = MakeVoxelGrid(volume).value();
    const std::int32_t max_blocks = MaxBlocks(volume, grid);
    tsdf_ = std::make_unique<TsdfVolume>(grid, 0.016, max_blocks);
    thermal_ = std::make_unique<ThermalVolume>(max_blocks);
    testing::FillVolume(*tsdf_, [](const Eigen::Vector3d& p) {
      return std::min((p - kBall).norm() - kRadius, kWall - p.z());
    });
  }

  /// Closed form: the ball where the line of sight passes its centre within the radius.
  ThermalFrame TakeFrame() const {
    ThermalFrame frame;
    frame.valid = true;
    const CameraModel& camera = *rig_.thermal;
    frame.temperature_raw = Image<std::uint16_t>(camera.width, camera.height);
    const Eigen::Vector3d to_ball = T_map_thermal_.inverse() * kBall;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray =
            Unproject(camera, Eigen::Vector2d(u, v)).homogeneous().normalized();
        const double celsius = ray.cross(to_ball).norm() < kRadius ? kHot : kCold;
        frame.temperature_raw.At(u, v) =
            static_cast<std::uint16_t>(std::lround((celsius + 273.15) * 100.0));
      }
    }
    return frame;
  }

  struct Outcome {
    int assigned = 0;
    int hot_on_wall = 0;
  };
  Outcome Fuse(ParallaxFilter filter, const OtherRules* rules = nullptr) {
    ThesisFuser(options_, rig_, 0.0F, filter)
        .Fuse({TakeFrame(), T_map_thermal_, T_map_depth_, rules}, *tsdf_, pool_, *thermal_);
    Outcome outcome;
    for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
      testing::ForEachVoxel(thermal_->voxels(block), tsdf_->grid(), tsdf_->block_coordinates(block),
                            [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
                              if (!voxel.measured()) return;
                              ++outcome.assigned;
                              if (p.z() > kWall - 0.02 && voxel.celsius() > 50.0F)
                                ++outcome.hot_on_wall;
                            });
    }
    return outcome;
  }

  inline static const Eigen::Vector3d kBall{0.32, 0.32, 0.40};
  static constexpr double kRadius = 0.06, kWall = 0.60;
  ThermalOptions options_;
  Rig rig_;
  RigidTransform T_map_depth_ = MakeTransform({0.32, 0.32, 0.0}, Eigen::Quaterniond::Identity());
  RigidTransform T_map_thermal_ = MakeTransform({0.40, 0.36, 0.0}, Eigen::Quaterniond::Identity());
  ThreadPool pool_{2};
  std::unique_ptr<TsdfVolume> tsdf_;
  std::unique_ptr<ThermalVolume> thermal_;
};

TEST_F(ThesisFuserTest, WithoutAFilterTheHiddenWallGetsTheBallsTemperature) {
  const Outcome outcome = Fuse(ParallaxFilter::kNone);
  EXPECT_GT(outcome.assigned, 10'000);
  EXPECT_GT(outcome.hot_on_wall, outcome.assigned / 50);
}

TEST_F(ThesisFuserTest, Algorithm4KeepsItOffWhatTheDepthCameraSeesBehindTheBall) {
  const int without = Fuse(ParallaxFilter::kNone).hot_on_wall;
  thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks());
  const Outcome outcome = Fuse(ParallaxFilter::kAlgorithm4);
  EXPECT_GT(outcome.assigned, 10'000);
  EXPECT_LT(outcome.hot_on_wall, without / 5) << "what is left is along the silhouette";
}

/// The steps of temperature along the silhouette, and the margin beside it.
TEST_F(ThesisFuserTest, OurOtherRulesLeaveOutWhatIsLeftAlongTheSilhouette) {
  const Outcome alone = Fuse(ParallaxFilter::kAlgorithm4);
  ASSERT_GT(alone.hot_on_wall, 0);
  const CameraModel camera = RectifiedCamera(*rig_.thermal);
  const NearRangeOcclusion near_range(options_.expert().occlusion(), rig_.depth_sensor, camera);
  const LineOfSightOcclusion line_of_sight(options_.expert().occlusion(), rig_.depth_sensor,
                                           camera);
  const OtherRules rules{{}, near_range, line_of_sight};
  const auto fuse_again = [&] {
    thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks());
    return Fuse(ParallaxFilter::kAlgorithm4, &rules);
  };
  const Outcome with_rules = fuse_again();
  EXPECT_LT(with_rules.hot_on_wall, alone.hot_on_wall / 2);
  EXPECT_GT(with_rules.assigned, alone.assigned / 2);
  options_.mutable_distance()->set_max_m(0.45);
  options_.mutable_distance()->set_good_m(0.44);
  EXPECT_LT(fuse_again().assigned, with_rules.assigned / 2) << "the wall is too far away";
}

}  // namespace
}  // namespace isotherm
