#include "ground/relocaliser/relocaliser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "common/base/units.h"
#include "common/testing/volume_shapes.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"

namespace isotherm {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

constexpr double kVoxel = 0.004;
constexpr double kTruncation = 0.016;

TsdfVolume MakeVolume() {
  VolumeOptions options;
  options.set_size_x_m(0.64);
  options.set_size_y_m(0.64);
  options.set_size_z_m(0.64);
  options.set_voxel_size_m(kVoxel);
  const VoxelGrid grid = MakeVoxelGrid(options).value();
  return {grid, kTruncation, MaxBlocks(options, grid)};
}

/// The first pose, moved in its own coordinates.
RigidTransform Moved(const Eigen::Vector3d& translation_m, double yaw_deg, double pitch_deg) {
  const Eigen::Quaterniond orientation =
      Eigen::AngleAxisd(yaw_deg * kRadPerDeg, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(pitch_deg * kRadPerDeg, Eigen::Vector3d::UnitX());
  return testing::FirstPose() * MakeTransform(translation_m, orientation);
}

Thumbnail Constant(float depth_m) {
  Thumbnail thumbnail;
  thumbnail.depth_m.fill(depth_m);
  return thumbnail;
}

TEST(DisagreementTest, IsNothingBetweenEqualsAndFullWhereNothingIsSeen) {
  EXPECT_EQ(Disagreement(Constant(0.5F), Constant(0.5F)), 0.0F);
  EXPECT_EQ(Disagreement(Constant(0.0F), Constant(0.0F)), 1.0F);
  EXPECT_EQ(Disagreement(Constant(0.5F), Constant(0.0F)), 1.0F);
  EXPECT_EQ(Disagreement(Constant(0.0F), Constant(0.5F)), 1.0F);
}

TEST(DisagreementTest, GrowsWithTheDifferenceUpToEightCentimetres) {
  EXPECT_NEAR(Disagreement(Constant(0.50F), Constant(0.54F)), 0.5F, 1e-5F);
  EXPECT_NEAR(Disagreement(Constant(0.54F), Constant(0.50F)), 0.5F, 1e-5F);
  EXPECT_EQ(Disagreement(Constant(0.50F), Constant(0.60F)), 1.0F);
  EXPECT_EQ(Disagreement(Constant(0.50F), Constant(2.00F)), 1.0F);
}

TEST(DisagreementTest, WhatOnlyTheImageSeesCountsHalf) {
  Thumbnail half = Constant(0.5F);
  for (std::size_t i = 0; i < half.depth_m.size() / 2; ++i) half.depth_m[i] = 0.0F;
  EXPECT_FLOAT_EQ(Disagreement(Constant(0.5F), half), 0.25F);
  EXPECT_EQ(Disagreement(half, Constant(0.5F)), 0.0F);
}

TEST(DisagreementTest, FewCellsInCommonSayNothing) {
  Thumbnail few;
  for (std::size_t i = 0; i < 39; ++i) few.depth_m[i] = 0.5F;
  EXPECT_EQ(Disagreement(few, Constant(0.5F)), 1.0F);
  few.depth_m[39] = 0.5F;
  EXPECT_EQ(Disagreement(few, Constant(0.5F)), 0.0F);
}

TEST(MakeThumbnailTest, AConstantImageStaysConstant) {
  const Image<float> image(320, 240, 0.7F);
  EXPECT_THAT(MakeThumbnail(image).depth_m, Each(::testing::FloatNear(0.7F, 1e-5F)));
  EXPECT_THAT(MakeThumbnail(Image<float>(320, 240, 0.0F)).depth_m, Each(0.0F));
}

TEST(MakeThumbnailTest, CellsAreMeansOfWhatIsSeenInThem) {
  Image<float> image(60, 60, 0.0F);  // Cells of 3 x 4 pixels, of which four must be seen.
  image.At(0, 0) = 0.4F;
  image.At(2, 1) = 0.5F;
  image.At(1, 2) = 0.7F;
  image.At(2, 3) = 0.8F;
  image.At(3, 4) = image.At(4, 5) = image.At(5, 7) = 0.4F;
  image.At(58, 58) = image.At(59, 58) = image.At(58, 59) = image.At(59, 59) = 1.5F;
  const Thumbnail thumbnail = MakeThumbnail(image);
  EXPECT_FLOAT_EQ(thumbnail.depth_m.front(), 0.6F);
  EXPECT_EQ(thumbnail.depth_m[Thumbnail::kWidth + 1], 0.0F) << "three pixels are too few";
  EXPECT_FLOAT_EQ(thumbnail.depth_m.back(), 1.5F);
}

TEST(MakeThumbnailTest, NothingIsSeenOfATinyImage) {
  EXPECT_THAT(MakeThumbnail(Image<float>(19, 240, 0.7F)).depth_m, Each(0.0F));
  EXPECT_THAT(MakeThumbnail(Image<float>(320, 14, 0.7F)).depth_m, Each(0.0F));
  EXPECT_THAT(MakeThumbnail(Image<float>()).depth_m, Each(0.0F));
}

class MakeSurfaceCloudTest : public ::testing::Test {
 protected:
  static constexpr double kRadius = 0.2;
  static constexpr std::size_t kNoLimit = 1'000'000;
  const Eigen::Vector3d centre_ = {0.31, 0.33, 0.30};
  TsdfVolume volume_ = MakeVolume();
  ThreadPool pool_{2};
};

TEST_F(MakeSurfaceCloudTest, PointsLieOnASphereAllAround) {
  testing::FillSphere(volume_, centre_, kRadius);
  const auto cloud = MakeSurfaceCloud(volume_, kNoLimit, pool_);
  std::array<int, 8> octants{};
  for (const Eigen::Vector3f& point : cloud) {
    const Eigen::Vector3d arm = point.cast<double>() - centre_;
    ASSERT_NEAR(arm.norm(), kRadius, 2.0 * kVoxel);
    ++octants[static_cast<std::size_t>((arm.x() > 0) + 2 * (arm.y() > 0) + 4 * (arm.z() > 0))];
  }
  // A cell of half a block has at most one point, and most cells on the surface have one.
  constexpr double kCellArea = 16.0 * kVoxel * kVoxel;
  constexpr double kOctantArea = 0.5 * std::numbers::pi * kRadius * kRadius;
  EXPECT_THAT(octants, Each(::testing::Gt(0.8 * kOctantArea / kCellArea)));
}

TEST_F(MakeSurfaceCloudTest, HasAtMostAsManyPointsAsAskedFor) {
  testing::FillSphere(volume_, centre_, kRadius);
  for (const std::size_t max_points : {3000U, 300U, 30U, 1U}) {
    const auto cloud = MakeSurfaceCloud(volume_, max_points, pool_);
    EXPECT_LE(cloud.size(), max_points);
    EXPECT_GE(cloud.size(), (max_points + 3) / 4) << "thinned out more than needed";
  }
}

TEST_F(MakeSurfaceCloudTest, WhatIsHardlyObservedIsNoSurface) {
  EXPECT_TRUE(MakeSurfaceCloud(volume_, kNoLimit, pool_).empty());
  testing::FillSphere(volume_, centre_, kRadius, 0.5F);
  EXPECT_TRUE(MakeSurfaceCloud(volume_, kNoLimit, pool_).empty());
}

/// A model of the ball in the corner, and frames of it.
class BallInCornerTest : public ::testing::Test {
 protected:
  BallInCornerTest() { testing::FillVolume(volume_, testing::BallInCorner); }
  const PreparedDepth& Prepared(const RigidTransform& pose,
                                const testing::SignedDistance& scene = testing::BallInCorner) {
    return preprocessor_.Process(testing::RenderDepth(scene, camera_, pose), pool_);
  }

  CameraModel camera_ = testing::SmallDepthCamera();
  ThreadPool pool_{2};
  TsdfVolume volume_ = MakeVolume();
  DepthPreprocessor preprocessor_{PreprocessorOptions(), camera_, DepthSensorModel()};
};

class KeyframeDatabaseTest : public BallInCornerTest {
 protected:
  static constexpr int kMaxViews = 5;
  KeyframeDatabase keyframes_{camera_, kMaxViews};
};

TEST_F(KeyframeDatabaseTest, GuessesNothingWithoutPosesACloudOrAnImage) {
  const Thumbnail image = MakeThumbnail(Prepared(testing::FirstPose()).depth_m);
  const auto cloud = MakeSurfaceCloud(volume_, 3000, pool_);
  keyframes_.SetCloud(cloud);
  EXPECT_TRUE(keyframes_.Guess(image, 3, pool_).empty()) << "no poses";
  keyframes_.Add(testing::FirstPose());
  EXPECT_FALSE(keyframes_.Guess(image, 3, pool_).empty());
  EXPECT_TRUE(keyframes_.Guess(Thumbnail(), 3, pool_).empty()) << "no image";
  keyframes_.SetCloud({});
  EXPECT_TRUE(keyframes_.Guess(image, 3, pool_).empty()) << "no cloud";
}

TEST_F(KeyframeDatabaseTest, FindsTheKnownPoseAnImageWasTakenFrom) {
  constexpr double kMaxError = 0.04;  // Metres: of an image of 20 x 15 cells.
  constexpr double kMaxAngle = 6.0 * kRadPerDeg;
  // All that they see is in the model.
  const std::vector<RigidTransform> known = {Moved({0.0, 0.0, 0.12}, 0.0, 0.0),
                                             Moved({0.10, 0.0, 0.14}, -10.0, 0.0),
                                             Moved({-0.05, -0.03, 0.15}, 15.0, -8.0)};
  for (const RigidTransform& pose : known) keyframes_.Add(pose);
  keyframes_.SetCloud(MakeSurfaceCloud(volume_, 3000, pool_));
  for (const RigidTransform& truth : known) {
    const Thumbnail image = MakeThumbnail(Prepared(truth).depth_m);
    const auto guesses = keyframes_.Guess(image, 3, pool_);
    ASSERT_FALSE(guesses.empty());
    EXPECT_LT(TranslationDistance(guesses[0].T_map_depth, truth), kMaxError);
    EXPECT_LT(RotationAngle(guesses[0].T_map_depth, truth), kMaxAngle);
    EXPECT_LT(guesses[0].disagreement, 0.3F);  // Nearest points of cells against their means.
  }
}

TEST_F(KeyframeDatabaseTest, GuessesAreFewBestFirstAndApart) {
  for (int i = 0; i < kMaxViews; ++i) keyframes_.Add(Moved({0.07 * i - 0.14, 0.0, 0.0}, 0.0, 0.0));
  keyframes_.SetCloud(MakeSurfaceCloud(volume_, 3000, pool_));
  const Thumbnail image = MakeThumbnail(Prepared(testing::FirstPose()).depth_m);
  EXPECT_EQ(keyframes_.Guess(image, 1, pool_).size(), 1U);
  const auto guesses = keyframes_.Guess(image, 4, pool_);
  ASSERT_GE(guesses.size(), 2U);
  ASSERT_LE(guesses.size(), 4U);
  for (std::size_t i = 1; i < guesses.size(); ++i) {
    EXPECT_GE(guesses[i].disagreement, guesses[i - 1].disagreement);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(TranslationDistance(guesses[i].T_map_depth, guesses[j].T_map_depth) >= 0.04 ||
                  RotationAngle(guesses[i].T_map_depth, guesses[j].T_map_depth) >=
                      6.0 * kRadPerDeg);
    }
  }
}

TEST_F(KeyframeDatabaseTest, KeepsNewViewsOnlyAndNotTooMany) {
  keyframes_.Add(testing::FirstPose());
  keyframes_.Add(Moved({0.05, 0.0, 0.0}, 0.0, 0.0));
  keyframes_.Add(Moved({0.0, 0.0, 0.0}, 9.0, 0.0));
  EXPECT_EQ(keyframes_.poses().size(), 1U);
  keyframes_.Add(Moved({0.07, 0.0, 0.0}, 0.0, 0.0));
  keyframes_.Add(Moved({0.0, 0.0, 0.0}, 11.0, 0.0));
  EXPECT_EQ(keyframes_.poses().size(), 3U);
  for (int i = 0; i < 20; ++i) keyframes_.Add(Moved({0.0, 0.0, -1.0 * i}, 0.0, 0.0));
  EXPECT_EQ(keyframes_.poses().size(), static_cast<std::size_t>(kMaxViews));
  EXPECT_EQ(keyframes_.poses().front().matrix(), testing::FirstPose().matrix());
}

TEST(RelocaliserOptionsTest, BoundariesAreNamed) {
  using Set = std::function<void(RelocaliserOptions&, double)>;
  struct Case {
    const char* name;
    std::vector<double> good, bad;
    Set set;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases = {
      {"min_agreement",
       {1e-3, 1.0},
       {0.0, -0.1, 1.001, nan},
       [](auto& o, double v) { o.mutable_expert()->set_min_agreement(v); }},
      {"min_overlap",
       {1e-3, 1.0},
       {0.0, -0.1, 1.001, nan},
       [](auto& o, double v) { o.mutable_expert()->set_min_overlap(v); }},
      {"max_views",
       {1, 100'000},
       {0, -1, 100'001},
       [](auto& o, double v) { o.mutable_expert()->set_max_views(static_cast<int>(v)); }},
      {"guesses_per_frame",
       {1, 100},
       {0, -1, 101},
       [](auto& o, double v) { o.mutable_expert()->set_guesses_per_frame(static_cast<int>(v)); }},
      {"confirming_frames",
       {0, 100},
       {-1, 101},
       [](auto& o, double v) { o.mutable_expert()->set_confirming_frames(static_cast<int>(v)); }},
  };
  EXPECT_TRUE(Validate(RelocaliserOptions()).ok());
  for (const Case& c : cases) {
    for (const double value : c.good) {
      RelocaliserOptions options;
      c.set(options, value);
      EXPECT_TRUE(Validate(options).ok()) << c.name << " " << value;
    }
    for (const double value : c.bad) {
      RelocaliserOptions options;
      c.set(options, value);
      const Status status = Validate(options);
      EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << c.name << " " << value;
      EXPECT_THAT(status.message(), HasSubstr("relocaliser"));
      EXPECT_THAT(status.message(), HasSubstr(c.name));
    }
  }
}

class RelocaliserTest : public BallInCornerTest {
 protected:
  std::optional<RigidTransform> Find(const PreparedDepth& depth) {
    return relocaliser_.Find(depth, volume_, 0.0F, pool_);
  }
  RelocaliserOptions options_;
  Relocaliser relocaliser_{options_, camera_};
};

TEST_F(RelocaliserTest, FindsAPoseBesideAKnownOne) {
  constexpr double kMaxError = 0.002;  // Metres, for the tracker to go on from.
  constexpr double kMaxAngle = 0.5 * kRadPerDeg;
  relocaliser_.Add(testing::FirstPose());
  for (const RigidTransform& truth :
       {Moved({0.03, -0.02, 0.02}, 4.0, -3.0), Moved({-0.04, 0.01, -0.03}, -5.0, 2.0),
        Moved({0.01, 0.04, 0.0}, 0.0, 5.0)}) {
    const auto found = Find(Prepared(truth));
    ASSERT_TRUE(found.has_value());
    EXPECT_LT(TranslationDistance(*found, truth), kMaxError);
    EXPECT_LT(RotationAngle(*found, truth), kMaxAngle);
  }
}

TEST_F(RelocaliserTest, FindsNothingBeforeItKnowsAView) {
  const PreparedDepth& depth = Prepared(testing::FirstPose());
  EXPECT_FALSE(Find(depth).has_value());
  relocaliser_.Add(testing::FirstPose());
  EXPECT_TRUE(Find(depth).has_value());
}

TEST_F(RelocaliserTest, FindsNothingInAnotherScene) {
  relocaliser_.Add(testing::FirstPose());
  const auto balls = [](const Eigen::Vector3d& p) {
    return std::min((p - Eigen::Vector3d(0.2, 0.3, 0.3)).norm() - 0.05,
                    (p - Eigen::Vector3d(0.4, 0.2, 0.5)).norm() - 0.08);
  };
  EXPECT_FALSE(Find(Prepared(testing::FirstPose(), balls)).has_value());
}

TEST_F(RelocaliserTest, FindsNothingOfAModelThatIsTooLight) {
  relocaliser_.Add(testing::FirstPose());
  const PreparedDepth& depth = Prepared(testing::FirstPose());
  EXPECT_TRUE(relocaliser_.Find(depth, volume_, 9.0F, pool_).has_value());
  EXPECT_FALSE(relocaliser_.Find(depth, volume_, 11.0F, pool_).has_value());
}

}  // namespace
}  // namespace isotherm
