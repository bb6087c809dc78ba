#include "ground/icp/icp_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "common/testing/volume_shapes.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

class IcpTrackerTest : public ::testing::Test {
 protected:
  IcpTrackerTest() {
    const VolumeOptions volume_options = testing::SmallVolume();
    grid_ = MakeVoxelGrid(volume_options).value();
    volume_ = std::make_unique<TsdfVolume>(grid_, testing::kSmallTruncation_m,
                                           MaxBlocks(volume_options, grid_));
    testing::FillVolume(*volume_, testing::BallInCorner);
    LookFrom(testing::FirstPose());
  }
  void LookFrom(const RigidTransform& pose) {
    view_.camera = camera_;
    view_.T_map_depth = pose;
    Raycaster().Cast(*volume_, camera_, pose, 0.0F, pool_, view_.maps);
  }
  TrackingResult Track(const DepthFrame& frame, int threads = 2) {
    ThreadPool pool(threads);
    DepthPreprocessor preprocessor(PreprocessorOptions(), camera_, DepthSensorModel());
    return IcpTracker(options_).Track(preprocessor.Process(frame, pool), view_, grid_,
                                      {view_.T_map_depth, view_.T_map_depth}, pool);
  }
  DepthFrame Render(const RigidTransform& pose) const {
    return testing::RenderDepth(testing::BallInCorner, camera_, pose);
  }
  static RigidTransform Moved(const Eigen::Vector3d& translation_m, double angle_deg) {
    const Eigen::AngleAxisd rotation(angle_deg * kRadPerDeg,
                                     Eigen::Vector3d(0.4, 1.0, -0.3).normalized());
    return testing::FirstPose() * MakeTransform(translation_m, Eigen::Quaterniond(rotation));
  }

  TrackerOptions options_;
  CameraModel camera_ = testing::SmallDepthCamera();
  ThreadPool pool_{2};
  VoxelGrid grid_;
  std::unique_ptr<TsdfVolume> volume_;
  ModelView view_;
};

TEST_F(IcpTrackerTest, FindsAKnownMotion) {
  constexpr double kMaxError = 0.0003;  // Metres, of 4 mm voxels.
  constexpr double kMaxAngle = 0.05 * kRadPerDeg;
  const RigidTransform truth = Moved({0.008, -0.005, 0.006}, 1.0);
  const TrackingResult result = Track(Render(truth));
  ASSERT_TRUE(result.tracked()) << ToString(result.lost) << " step_m=" << result.step_m
                                << " step_rad=" << result.step_rad
                                << " inliers=" << result.inlier_ratio
                                << " residual_m=" << result.residual_m;
  EXPECT_LT(TranslationDistance(result.T_map_depth, truth), kMaxError);
  EXPECT_LT(RotationAngle(result.T_map_depth, truth), kMaxAngle);
  EXPECT_GT(result.inlier_ratio, 0.8);
  EXPECT_NEAR(result.step_m, std::sqrt(64e-6 + 25e-6 + 36e-6), kMaxError);
}

TEST_F(IcpTrackerTest, DoesNotDependOnTheNumberOfThreads) {
  const DepthFrame frame = Render(Moved({0.004, 0.002, -0.003}, 0.5));
  EXPECT_EQ(Track(frame, 1).T_map_depth.matrix(), Track(frame, 3).T_map_depth.matrix());
}

TEST_F(IcpTrackerTest, ACoveredCameraIsLost) {
  DepthFrame frame;
  frame.depth_raw = Image<std::uint16_t>(camera_.width, camera_.height, 0);
  EXPECT_EQ(Track(frame).lost, LostReason::kTooFewPixels);
}

TEST_F(IcpTrackerTest, AnotherSceneIsLost) {
  const auto other = [](const Eigen::Vector3d& p) {
    return (p - Eigen::Vector3d(0.3, 0.3, 0.36)).norm() - 0.06;
  };
  const TrackingResult result = Track(testing::RenderDepth(other, camera_, testing::FirstPose()));
  EXPECT_FALSE(result.tracked());
}

TEST_F(IcpTrackerTest, APoseThatIsNoneIsLost) {
  const DepthFrame frame = Render(testing::FirstPose());
  DepthPreprocessor preprocessor(PreprocessorOptions(), camera_, DepthSensorModel());
  const PreparedDepth& depth = preprocessor.Process(frame, pool_);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e30}) {
    for (int i = 0; i < 36; ++i) {  // Each entry of the guess, the prior and the model's pose.
      IcpTracker::Start start{testing::FirstPose(), testing::FirstPose()};
      view_.T_map_depth = testing::FirstPose();
      RigidTransform* const poses[] = {&start.guess, &view_.T_map_depth, &start.prior};
      poses[i / 12]->matrix()(i % 3, i % 12 / 3) = bad;
      const TrackingResult result = IcpTracker(options_).Track(depth, view_, grid_, start, pool_);
      // All directions are observed here: what the prior says must not matter.
      ASSERT_EQ(result.tracked(), i >= 24) << bad << " at " << i;
      if (result.tracked()) {
        ASSERT_TRUE(result.T_map_depth.matrix().allFinite());
      }
    }
  }
}

TEST_F(IcpTrackerTest, AModelThatWasNeverCastIsLost) {
  view_.maps = SurfaceMaps();
  EXPECT_EQ(Track(Render(testing::FirstPose())).lost, LostReason::kTooFewInliers);
}

TEST_F(IcpTrackerTest, AJumpBeyondTheStepLimitIsLost) {
  options_.mutable_expert()->set_max_step_m(0.005);
  EXPECT_EQ(Track(Render(Moved({0.012, 0.0, 0.0}, 0.0))).lost, LostReason::kStep);
}

/// The sums of one pass, pixel by pixel in double precision.
IcpSums ReferenceSums(const SurfaceMaps& current, const RigidTransform& T, const ModelView& model,
                      const VoxelGrid& grid, const IcpLimits& limits) {
  IcpSums sums;
  const RigidTransform T_model_map = model.T_map_depth.inverse();
  for (int y = 0; y < current.height(); ++y) {
    for (int x = 0; x < current.width(); ++x) {
      const Eigen::Vector3d p_depth(current.vx.At(x, y), current.vy.At(x, y), current.vz.At(x, y));
      if (!(p_depth.z() > 0.0)) continue;
      const Eigen::Vector3d p = T * p_depth;
      if ((p.array() < grid.min_m.array()).any() || (p.array() > grid.max_m().array()).any())
        continue;
      ++sums.candidates;
      const auto pixel = Project(model.camera, T_model_map * p);
      if (!pixel) continue;
      const int u = static_cast<int>(std::floor(pixel->x() + 0.5));
      const int v = static_cast<int>(std::floor(pixel->y() + 0.5));
      if (!model.maps.vx.Contains(u, v)) continue;
      const Eigen::Vector3d q(model.maps.vx.At(u, v), model.maps.vy.At(u, v),
                              model.maps.vz.At(u, v));
      const Eigen::Vector3d n(model.maps.nx.At(u, v), model.maps.ny.At(u, v),
                              model.maps.nz.At(u, v));
      const Eigen::Vector3d n_current(current.nx.At(x, y), current.ny.At(x, y),
                                      current.nz.At(x, y));
      if (!((p - q).norm() < limits.max_distance_m)) continue;
      if (!(n.dot(T.linear() * n_current) > limits.min_normal_cosine)) continue;
      ++sums.inliers;
      Eigen::Matrix<double, 6, 1> J;
      J << n, (p - T.translation()).cross(n);
      const double weight = std::pow(0.5 / p_depth.z(), 4);
      const double residual = n.dot(p - q);
      sums.H += weight * J * J.transpose();
      sums.g += weight * J * residual;
      sums.squared_residuals_m2 += residual * residual;
    }
  }
  return sums;
}

TEST_F(IcpTrackerTest, KernelMatchesTheScalarReference) {
  const RigidTransform guess = Moved({0.003, 0.004, -0.002}, 0.7);
  DepthPreprocessor preprocessor(PreprocessorOptions(), camera_, DepthSensorModel());
  const PreparedDepth& depth =
      preprocessor.Process(Render(Moved({0.006, -0.002, 0.004}, 0.2)), pool_);
  const IcpLimits limits{0.03F, 0.9F};
  for (const SurfaceMaps& maps : depth.maps) {
    const IcpSums fast = AccumulateIcp(maps, guess, view_, grid_, limits, pool_);
    const IcpSums slow = ReferenceSums(maps, guess, view_, grid_, limits);
    ASSERT_GT(slow.inliers, 500);
    // Rounding decides a few pixels on borders differently.
    EXPECT_NEAR(static_cast<double>(fast.inliers), static_cast<double>(slow.inliers),
                0.002 * static_cast<double>(slow.inliers) + 2.0);
    EXPECT_NEAR(static_cast<double>(fast.candidates), static_cast<double>(slow.candidates), 2.0);
    EXPECT_LT((fast.H - slow.H).norm(), 0.003 * slow.H.norm());
    EXPECT_LT((fast.g - slow.g).norm(), 0.01 * slow.g.norm());
  }
}

}  // namespace
}  // namespace isotherm
