#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "common/testing/volume_shapes.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/tracker/icp_tracker.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

class DepthPreprocessorTest : public ::testing::Test {
 protected:
  const PreparedDepth& Process(const DepthFrame& frame) {
    preprocessor_ = std::make_unique<DepthPreprocessor>(options_, camera_, DepthSensorModel());
    return preprocessor_->Process(frame, pool_);
  }
  DepthFrame Flat(std::uint16_t raw) const {
    DepthFrame frame;
    frame.depth_raw = Image<std::uint16_t>(camera_.width, camera_.height, raw);
    return frame;
  }

  PreprocessorOptions options_;
  CameraModel camera_ = testing::SmallDepthCamera();
  ThreadPool pool_{2};
  std::unique_ptr<DepthPreprocessor> preprocessor_;
};

TEST_F(DepthPreprocessorTest, F12ValuesWithoutReturnOrOutOfRangeAreMasked) {
  DepthFrame frame = Flat(500);
  frame.depth_raw.At(100, 100) = kNoDepth;
  frame.depth_raw.At(101, 100) = kNoDepthSaturated;
  frame.depth_raw.At(102, 100) = 299;   // Nearer than 0.3 m.
  frame.depth_raw.At(103, 100) = 4001;  // Beyond 4 m.
  const PreparedDepth& depth = Process(frame);
  EXPECT_EQ(depth.valid_pixels, camera_.width * camera_.height - 4);
  for (int x = 100; x < 104; ++x) {
    EXPECT_EQ(depth.depth_m.At(x, 100), 0.0F);
    EXPECT_TRUE(std::isnan(depth.maps[0].vz.At(x, 100)));
  }
  EXPECT_FLOAT_EQ(depth.maps[0].vz.At(150, 100), 0.5F);
}

TEST_F(DepthPreprocessorTest, NormalsOfATiltedPlaneAreExactAtEachLevel) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized();
  const auto plane = [&](const Eigen::Vector3d& p) {
    return normal.dot(p - Eigen::Vector3d(0.3, 0.26, 0.5));
  };
  options_.mutable_expert()->set_bilateral_radius_px(0);
  const PreparedDepth& depth = Process(testing::RenderDepth(plane, camera_, testing::FirstPose()));
  for (int level = 0; level < kPyramidLevels; ++level) {
    const SurfaceMaps& maps = depth.maps[static_cast<std::size_t>(level)];
    const int x = maps.width() / 3;
    const int y = maps.height() / 2;
    const Eigen::Vector3d n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
    EXPECT_GT(n.dot(normal), std::cos(0.3 * kRadPerDeg)) << "level " << level;
    const Eigen::Vector3d p(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
    EXPECT_NEAR(plane(testing::FirstPose() * p), 0.0, 2e-5) << "level " << level;
  }
}

/// Which pixels of an image have no return.
struct HolePattern {
  const char* name;
  std::function<bool(int x, int y, std::mt19937& random)> is_hole;
};

const HolePattern kHolePatterns[] = {
    {"every third row and column",
     [](int x, int y, std::mt19937& random) {
       return x % 3 == 2 || y % 3 == 2 || std::bernoulli_distribution(0.19)(random);
     }},
    {"two of five rows and columns",
     [](int x, int y, std::mt19937&) { return x % 5 >= 3 || y % 5 >= 3; }},
    {"60 % at random",
     [](int, int, std::mt19937& random) { return std::bernoulli_distribution(0.6)(random); }},
    {"every second row", [](int, int y, std::mt19937&) { return y % 2 == 0; }},
    {"every second column", [](int x, int, std::mt19937&) { return x % 2 == 0; }},
};

void Punch(const HolePattern& pattern, DepthFrame& frame) {
  std::mt19937 random(5);
  for (int y = 0; y < frame.depth_raw.height(); ++y) {
    for (int x = 0; x < frame.depth_raw.width(); ++x) {
      if (pattern.is_hole(x, y, random)) frame.depth_raw.At(x, y) = kNoDepth;
    }
  }
}

/// Angles in degrees between the normals of maps and the true ones, where these are turned away
/// from the line of sight by less than 60 degrees.
std::vector<double> NormalErrors(
    const SurfaceMaps& maps,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d& p_depth)>& true_normal) {
  std::vector<double> errors_deg;
  for (int y = 0; y < maps.height(); ++y) {
    for (int x = 0; x < maps.width(); ++x) {
      const Eigen::Vector3d p(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      if (!p.allFinite()) continue;
      const Eigen::Vector3d n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
      const Eigen::Vector3d truth = true_normal(p);
      if (-truth.dot(p.normalized()) < 0.5) continue;
      errors_deg.push_back(std::acos(std::min(1.0, n.dot(truth))) / kRadPerDeg);
    }
  }
  std::ranges::sort(errors_deg);
  return errors_deg;
}

TEST_F(DepthPreprocessorTest, NormalsOfImagesFullOfHolesAreThoseOfTheShape) {
  const Eigen::Vector3d tilted = Eigen::Vector3d(0.5, -0.3, -1.0).normalized();
  const Eigen::Vector3d centre(0.02, -0.01, 0.7);
  struct Shape {
    const char* name;
    testing::SignedDistance distance_m;
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> normal;
  };
  const Shape shapes[] = {
      {"plane",
       [&](const Eigen::Vector3d& p) { return tilted.dot(p - Eigen::Vector3d(0.0, 0.0, 0.6)); },
       [&](const Eigen::Vector3d&) { return tilted; }},
      {"ball", [&](const Eigen::Vector3d& p) { return (p - centre).norm() - 0.2; },
       [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return (p - centre).normalized(); }}};
  for (const Shape& shape : shapes) {
    const DepthFrame whole =
        testing::RenderDepth(shape.distance_m, camera_, RigidTransform::Identity());
    std::array<std::size_t, kPyramidLevels> normals{};
    const PreparedDepth& prepared = Process(whole);
    for (std::size_t level = 0; level < kPyramidLevels; ++level)
      normals[level] = NormalErrors(prepared.maps[level], shape.normal).size();
    for (const HolePattern& pattern : kHolePatterns) {
      DepthFrame frame = whole;
      Punch(pattern, frame);
      const PreparedDepth& depth = Process(frame);
      for (std::size_t level = 0; level < kPyramidLevels; ++level) {
        SCOPED_TRACE(::testing::Message()
                     << shape.name << ", " << pattern.name << ", level " << level);
        const std::vector<double> errors = NormalErrors(depth.maps[level], shape.normal);
        ASSERT_GE(errors.size(), normals[level] * 9 / 10);
        EXPECT_LE(errors[errors.size() / 2], 0.2);
        EXPECT_LE(errors[errors.size() * 95 / 100], 1.5);
        EXPECT_LE(errors[errors.size() * 99 / 100], 4.0);
      }
    }
  }
}

TEST_F(DepthPreprocessorTest, HolesAreFilledOnSurfacesOnly) {
  // A step in depth, and nothing in the lower half.
  DepthFrame frame = Flat(500);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (x >= camera_.width / 2) frame.depth_raw.At(x, y) = 600;
      if (y >= camera_.height / 2) frame.depth_raw.At(x, y) = kNoDepth;
    }
  }
  Punch(kHolePatterns[2], frame);
  const int measured = static_cast<int>(std::ranges::count_if(
      frame.depth_raw.pixels(), [](std::uint16_t raw) { return raw != kNoDepth; }));
  const PreparedDepth& depth = Process(frame);
  EXPECT_EQ(depth.valid_pixels, measured) << "filled pixels are not measured";
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth.depth_m.At(x, y);
      if (y > camera_.height / 2) {
        ASSERT_EQ(z, 0.0F) << x << ", " << y;
      } else if (z > 0.0F) {
        ASSERT_NEAR(z, x < camera_.width / 2 ? 0.5F : 0.6F, 1e-4F) << x << ", " << y;
      }
    }
  }
}

TEST_F(DepthPreprocessorTest, AnImageThatIsNotFullOfHolesIsLeftAsItIs) {
  DepthFrame frame = Flat(500);
  std::mt19937 random(5);
  for (std::uint16_t& raw : frame.depth_raw.pixels()) {
    if (std::bernoulli_distribution(0.05)(random)) raw = kNoDepth;
  }
  const PreparedDepth& depth = Process(frame);
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i)
    ASSERT_EQ(depth.depth_m.data()[i] > 0.0F, frame.depth_raw.data()[i] != kNoDepth);
}

TEST_F(DepthPreprocessorTest, FilterSmoothsNoiseButNotAnEdge) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0.0, 0.5);  // Millimetres, as at half a metre.
  DepthFrame frame = Flat(0);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const double truth = x < 160 ? 500.0 : 560.0;
      frame.depth_raw.At(x, y) = static_cast<std::uint16_t>(std::lround(truth + noise(random)));
    }
  }
  options_.set_min_depth_m(0.1);
  const PreparedDepth& depth = Process(frame);
  const SurfaceMaps& maps = depth.maps[0];
  double squared = 0.0;
  int count = 0;
  for (int y = 20; y < 200; ++y) {
    for (int x = 20; x < 140; ++x, ++count) squared += std::pow(maps.vz.At(x, y) - 0.5, 2);
    EXPECT_NEAR(maps.vz.At(155, y), 0.5, 0.003) << "left of the edge, row " << y;
    EXPECT_NEAR(maps.vz.At(165, y), 0.56, 0.003) << "right of the edge, row " << y;
  }
  EXPECT_LT(std::sqrt(squared / count), 0.00025) << "half of the noise";
}

TEST_F(DepthPreprocessorTest, DepthOfADistortedCameraIsRectified) {
  camera_.k1 = -0.2;
  const auto wall = [](const Eigen::Vector3d& p) { return 0.5 - p.z(); };
  const auto ball = [](const Eigen::Vector3d& p) {
    return std::min(0.5 - p.z(), (p - Eigen::Vector3d(0.10, 0.06, 0.42)).norm() - 0.04);
  };
  const DepthFrame frame = testing::RenderDepth(ball, camera_, RigidTransform::Identity());
  const PreparedDepth& depth = Process(frame);
  // The rectified image shows the ball where an ideal camera would.
  const CameraModel ideal = camera_.WithoutDistortion();
  const auto centre = Project(ideal, {0.10, 0.06, 0.38});
  EXPECT_LT(depth.depth_m.At(static_cast<int>(centre->x()), static_cast<int>(centre->y())), 0.39F);
  EXPECT_GT(wall(Eigen::Vector3d::Zero()), 0.0);
}

class IcpTrackerTest : public ::testing::Test {
 protected:
  IcpTrackerTest() {
    VolumeOptions volume_options;
    volume_options.set_size_x_m(0.64);
    volume_options.set_size_y_m(0.64);
    volume_options.set_size_z_m(0.64);
    volume_options.set_voxel_size_m(0.004);
    grid_ = MakeVoxelGrid(volume_options).value();
    volume_ = std::make_unique<TsdfVolume>(grid_, 0.016, MaxBlocks(volume_options, grid_));
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
