#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <array>
#include <cmath>
#include <random>

#include "common/testing/volume_shapes.h"
#include "ground/icp/icp_tracker.h"
#include "ground/icp/observability.h"
#include "ground/icp/pose_uncertainty.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr double kRounding = 1e-9;

Matrix6 RandomMatrix(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Matrix6::NullaryExpr([&] { return normal(random); });
}

Vector6 RandomVector(std::mt19937& random) { return RandomMatrix(random).col(0); }

/// Any orthonormal axes, at a depth of `mean_depth_m`.
Observability RandomSpace(std::mt19937& random, int unobservable_axes, double mean_depth_m = 0.5) {
  Observability space;
  space.axes = RandomMatrix(random).householderQr().householderQ();
  space.mean_depth_m = mean_depth_m;
  space.scale.tail<3>().setConstant(1.0 / mean_depth_m);
  space.unobservable_axes = unobservable_axes;
  return space;
}

class MeasureObservabilityTest : public ::testing::Test {
 protected:
  static double TiltedPlane(const Eigen::Vector3d& p) {
    return Normal().dot(p - Eigen::Vector3d(0.30, 0.26, 0.45));
  }
  static Eigen::Vector3d Normal() { return Eigen::Vector3d(0.3, -0.2, -1.0).normalized(); }
  /// About a vertical axis through (0.3, 0.4), in x and z.
  static double Cylinder(const Eigen::Vector3d& p) {
    return std::hypot(p.x() - 0.30, p.z() - 0.52) - 0.12;
  }

  /// Shows the scene to the model, and to a frame from the same pose.
  void Look(const testing::SignedDistance& scene) {
    const VolumeOptions options = testing::SmallVolume();
    const VoxelGrid grid = MakeVoxelGrid(options).value();
    TsdfVolume volume(grid, testing::kSmallTruncation_m, MaxBlocks(options, grid));
    testing::FillVolume(volume, scene);
    view_.camera = testing::SmallDepthCamera();
    view_.T_map_depth = testing::FirstPose();
    Raycaster().Cast(volume, view_.camera, view_.T_map_depth, 0.0F, pool_, view_.maps);
    DepthPreprocessor preprocessor(PreprocessorOptions(), view_.camera, DepthSensorModel());
    const DepthFrame frame = testing::RenderDepth(scene, view_.camera, view_.T_map_depth);
    current_ = preprocessor.Process(frame, pool_).maps[kPyramidLevels - 1];
  }
  Observability Measure(double min_strength) const {
    return MeasureObservability(current_, view_.T_map_depth, view_, kLimits, min_strength);
  }
  /// Turns each normal by itself.
  static void Roughen(SurfaceMaps& maps, std::mt19937& random) {
    std::normal_distribution<float> noise(0.0F, 0.1F);
    for (int y = 0; y < maps.height(); ++y) {
      for (int x = 0; x < maps.width(); ++x) {
        Eigen::Vector3f n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
        n = (n + Eigen::Vector3f(noise(random), noise(random), noise(random))).normalized();
        maps.nx.At(x, y) = n.x();
        maps.ny.At(x, y) = n.y();
        maps.nz.At(x, y) = n.z();
      }
    }
  }
  /// How much of a twist is said to be free, 0..1.
  static double UnobservableFraction(const Observability& space, const Vector6& twist) {
    return space.UnobservablePart(twist).cwiseQuotient(space.scale).norm() /
           twist.cwiseQuotient(space.scale).norm();
  }
  static Vector6 Twist(const Eigen::Vector3d& translation_m, const Eigen::Vector3d& rotation_rad) {
    Vector6 twist;
    twist << translation_m, rotation_rad;
    return twist;
  }

  static constexpr IcpLimits kLimits{0.03F, 0.9F};
  static constexpr double kMinStrength = 0.001;  ///< As the tracker's default.
  ThreadPool pool_{2};
  ModelView view_;
  SurfaceMaps current_;
};

TEST_F(MeasureObservabilityTest, APlaneLeavesItsThreeSlidesUnobservable) {
  Look(TiltedPlane);
  const Observability space = Measure(kMinStrength);
  ASSERT_TRUE(space.measured);
  EXPECT_EQ(space.unobservable_axes, 3);
  const Eigen::Vector3d n = Normal();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d along = n.unitOrthogonal();
  EXPECT_GT(UnobservableFraction(space, Twist(along, zero)), 0.99);
  EXPECT_GT(UnobservableFraction(space, Twist(n.cross(along), zero)), 0.99);
  EXPECT_GT(UnobservableFraction(space, Twist(zero, n)), 0.99);
  EXPECT_LT(UnobservableFraction(space, Twist(n, zero)), 0.05);
  EXPECT_LT(UnobservableFraction(space, Twist(zero, along)),
            0.9);  // Turns about a point, slides elsewhere.
}

TEST_F(MeasureObservabilityTest, ACylinderLeavesItsTwoSlidesUnobservable) {
  Look(Cylinder);
  const Observability space = Measure(kMinStrength);
  ASSERT_TRUE(space.measured);
  EXPECT_EQ(space.unobservable_axes, 2);
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d camera_from_axis =
      testing::FirstPose().translation() - Eigen::Vector3d(0.30, 0.26, 0.52);
  EXPECT_GT(UnobservableFraction(space, Twist(axis, Eigen::Vector3d::Zero())), 0.99);
  EXPECT_GT(UnobservableFraction(space, Twist(axis.cross(camera_from_axis), axis)), 0.99);
  EXPECT_LT(UnobservableFraction(space, Twist(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero())),
            0.05);
  EXPECT_LT(UnobservableFraction(space, Twist(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ())),
            0.05);
}

TEST_F(MeasureObservabilityTest, ABallInACornerLeavesNothingUnobservable) {
  Look(testing::BallInCorner);
  const Observability space = Measure(kMinStrength);
  ASSERT_TRUE(space.measured);
  EXPECT_TRUE(space.fully_observed());
  EXPECT_GT(space.mean_depth_m, 0.3);
  EXPECT_LT(space.mean_depth_m, 0.62);
}

TEST_F(MeasureObservabilityTest, IndependentNoiseOfTheNormalsIsNoStructure) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  Look(TiltedPlane);
  Roughen(current_, random);
  Roughen(view_.maps, random);
  const Observability space = Measure(kMinStrength);
  ASSERT_TRUE(space.measured);
  EXPECT_EQ(space.unobservable_axes, 3) << "strength " << space.strength.transpose();
}

TEST_F(MeasureObservabilityTest, StrengthIsTheMeanSquareOfAResidualsChange) {
  Look([](const Eigen::Vector3d& p) { return 0.5 - p.z(); });
  const Observability space = Measure(kMinStrength);
  EXPECT_NEAR(space.mean_depth_m, 0.5, 0.001);
  EXPECT_NEAR(space.strength(5), 1.0, 0.001);  // Towards the wall, all of it.
  // Rotations about the image's axes: (y / z)^2 and (x / z)^2, evenly over the image.
  const CameraModel camera = testing::SmallDepthCamera();
  const double half_x = 0.5 * camera.width / camera.fx;
  const double half_y = 0.5 * camera.height / camera.fy;
  constexpr double kTolerance = 0.05;  // Of it: normals at the image's border are missing.
  EXPECT_NEAR(space.strength(4), half_x * half_x / 3.0, kTolerance * half_x * half_x);
  EXPECT_NEAR(space.strength(3), half_y * half_y / 3.0, kTolerance * half_y * half_y);
}

TEST_F(MeasureObservabilityTest, WithoutAMinimumNothingIsUnobservable) {
  Look(TiltedPlane);
  const Observability space = Measure(0.0);
  EXPECT_TRUE(space.measured);
  EXPECT_TRUE(space.fully_observed());
}

TEST_F(MeasureObservabilityTest, WithoutAssociationsNothingIsMeasuredAndNothingUnobservable) {
  Look(TiltedPlane);
  for (Image<float>* plane : {&view_.maps.vx, &view_.maps.vy, &view_.maps.vz}) {
    *plane = Image<float>(view_.maps.width(), view_.maps.height(), std::nanf(""));
  }
  EXPECT_FALSE(Measure(kMinStrength).measured);
  EXPECT_TRUE(Measure(kMinStrength).fully_observed());
  view_.maps = SurfaceMaps();
  EXPECT_FALSE(Measure(kMinStrength).measured);
  current_ = SurfaceMaps();
  EXPECT_TRUE(Measure(kMinStrength).fully_observed());
}

TEST_F(MeasureObservabilityTest, AFewAssociationsMeasureNothing) {
  Look(TiltedPlane);
  for (int y = 0; y < view_.maps.height(); ++y) {
    if (y >= 100 && y < 108) continue;  // A thirtieth of the image is left.
    for (int x = 0; x < view_.maps.width(); ++x) view_.maps.vx.At(x, y) = std::nanf("");
  }
  EXPECT_FALSE(Measure(kMinStrength).measured);
  EXPECT_TRUE(Measure(kMinStrength).fully_observed());
}

class ObservabilityTest : public ::testing::Test {
 protected:
  static constexpr unsigned kSeed = 11;
  ::testing::ScopedTrace trace_{__FILE__, __LINE__, kSeed};
  std::mt19937 random_{kSeed};
};

TEST_F(ObservabilityTest, UnobservablePartAndItsComplementAreTheTwist) {
  for (int unobservable_axes = 0; unobservable_axes <= 6; ++unobservable_axes) {
    const Observability space = RandomSpace(random_, unobservable_axes);
    const Vector6 twist = RandomVector(random_);
    const Vector6 unobservable = space.UnobservablePart(twist);
    const Vector6 held = twist - unobservable;
    EXPECT_LT((space.UnobservablePart(unobservable) - unobservable).norm(), kRounding);
    EXPECT_LT(space.UnobservablePart(held).norm(), kRounding);
    // As motions, the two are orthogonal, and each lies along its own axes only.
    const Vector6 unobservable_motion =
        space.axes.transpose() * unobservable.cwiseQuotient(space.scale);
    const Vector6 held_motion = space.axes.transpose() * held.cwiseQuotient(space.scale);
    EXPECT_LT(unobservable_motion.tail(6 - unobservable_axes).norm(), kRounding);
    EXPECT_LT(held_motion.head(unobservable_axes).norm(), kRounding);
  }
}

TEST_F(ObservabilityTest, SolvesAsUsualIfAllIsObserved) {
  const Matrix6 J = RandomMatrix(random_);
  const Matrix6 H = J * J.transpose() + Matrix6::Identity();
  const Vector6 g = RandomVector(random_);
  const Vector6 expected = H.ldlt().solve(-g);
  for (const Observability& space : {Observability(), RandomSpace(random_, 0)}) {
    const auto twist = space.SolveObserved(H, g);
    ASSERT_TRUE(twist.has_value());
    EXPECT_LT((*twist - expected).norm(), kRounding);
  }
}

TEST_F(ObservabilityTest, SolutionIsTheBestWithoutAPartAlongUnobservableAxes) {
  const Matrix6 J = RandomMatrix(random_);
  const Matrix6 H = J * J.transpose() + Matrix6::Identity();
  const Vector6 g = RandomVector(random_);
  for (int unobservable_axes = 1; unobservable_axes < 6; ++unobservable_axes) {
    const Observability space = RandomSpace(random_, unobservable_axes);
    const auto twist = space.SolveObserved(H, g);
    ASSERT_TRUE(twist.has_value());
    EXPECT_GT(twist->norm(), 1e-3);
    EXPECT_LT(space.UnobservablePart(*twist).norm(), kRounding);
    // What is left of the gradient cannot be reduced along observed axes.
    const Vector6 gradient = space.scale.cwiseProduct(H * *twist + g);
    EXPECT_LT((space.axes.rightCols(6 - unobservable_axes).transpose() * gradient).norm(), 1e-8);
  }
}

TEST_F(ObservabilityTest, WhatCannotBeSolvedIsNot) {
  const Vector6 g = RandomVector(random_);
  EXPECT_FALSE(RandomSpace(random_, 6).SolveObserved(Matrix6::Identity(), g).has_value());
  Observability space;
  Matrix6 H = Matrix6::Identity();
  H(0, 0) = 0.0;
  EXPECT_FALSE(space.SolveObserved(H, g).has_value());
  space.unobservable_axes = 1;  // The singular direction is not asked for.
  EXPECT_TRUE(space.SolveObserved(H, g).has_value());
}

class PoseUncertaintyTest : public ::testing::Test {
 protected:
  static constexpr double kFrame_s = 1.0 / 30.0;
  static constexpr double kSpeed = 0.02;
  static constexpr double kDepth = 0.4;

  /// `measured_sigma_m` along each observed axis.
  TrackingResult Result(int unobservable_axes, double measured_sigma_m) {
    std::mt19937 random(3);
    TrackingResult result;
    result.motion = RandomSpace(random, unobservable_axes, kDepth);
    const Eigen::MatrixXd twists =
        result.motion.scale.asDiagonal() * result.motion.axes.rightCols(6 - unobservable_axes);
    result.covariance = measured_sigma_m * measured_sigma_m * twists * twists.transpose();
    return result;
  }
  static PriorError Inertial(double seconds) {
    return ConstantVelocityError(kSpeed, seconds, kDepth);
  }
  /// The covariance as motions along the space's axes.
  Matrix6 AlongAxes(const Observability& space) const {
    const Matrix6 to_axes = space.axes.transpose() * space.scale.cwiseInverse().asDiagonal();
    return to_axes * uncertainty_.covariance() * to_axes.transpose();
  }

  PoseUncertainty uncertainty_;
};

TEST_F(PoseUncertaintyTest, GrowsWithTimeAlongEachUnobservableAxis) {
  constexpr double kMeasured = 1e-4;
  constexpr int kFrames = 60;
  for (int unobservable_axes = 1; unobservable_axes <= 6; ++unobservable_axes) {
    SCOPED_TRACE(unobservable_axes);
    uncertainty_ = PoseUncertainty();
    const TrackingResult result = Result(unobservable_axes, kMeasured);
    for (int i = 0; i < kFrames; ++i) uncertainty_.Update(result, Inertial(kFrame_s));
    const double sigma = kSpeed * kFrames * kFrame_s;
    EXPECT_NEAR(uncertainty_.surface_sigma_m(), sigma, 1e-9);
    EXPECT_EQ(uncertainty_.mean_depth_m(), kDepth);
    Vector6 expected = Vector6::Constant(kMeasured * kMeasured);
    expected.head(unobservable_axes).setConstant(sigma * sigma);
    const Matrix6 covariance = AlongAxes(result.motion);
    EXPECT_LT((covariance - Matrix6(expected.asDiagonal())).norm(), 1e-12);
  }
}

TEST_F(PoseUncertaintyTest, FallsToWhatIsMeasuredOnceAllIsObserved) {
  constexpr double kMeasured = 2e-4;
  for (int i = 0; i < 60; ++i) uncertainty_.Update(Result(3, kMeasured), Inertial(kFrame_s));
  ASSERT_GT(uncertainty_.surface_sigma_m(), 0.03);
  uncertainty_.Update(Result(0, kMeasured), Inertial(kFrame_s));
  EXPECT_NEAR(uncertainty_.surface_sigma_m(), kMeasured, kRounding);
  EXPECT_LT((uncertainty_.covariance() - Result(0, kMeasured).covariance).norm(), 1e-15);
}

TEST_F(PoseUncertaintyTest, StartsFromWhatWasMeasuredBefore) {
  constexpr double kMeasured = 5e-4;
  uncertainty_.Update(Result(0, kMeasured), Inertial(kFrame_s));
  uncertainty_.Update(Result(2, kMeasured), Inertial(kFrame_s));
  EXPECT_NEAR(uncertainty_.surface_sigma_m(), kMeasured + kSpeed * kFrame_s, kRounding);
}

TEST_F(PoseUncertaintyTest, DoesNotShrinkIfTimeStandsStillOrGoesBack) {
  for (const double seconds : {kFrame_s, 0.0, -1.0})
    uncertainty_.Update(Result(1, 0.0), Inertial(seconds));
  EXPECT_NEAR(uncertainty_.surface_sigma_m(), kSpeed * kFrame_s, kRounding);
}

/// Jitter of odometry poses shows in each pose, but the path does not wander with it; drift
/// adds up.
TEST_F(PoseUncertaintyTest, NoiseOfASourceDoesNotAddUpWhileItGoesOnAndItsDriftDoes) {
  constexpr double kGrowth = 1e-4;
  constexpr double kNoise = 1e-3;
  constexpr int kFrames = 50;
  // The same in any direction at the scene's depth.
  PriorError prior{.translation_growth_m = kGrowth,
                   .rotation_growth_rad = kGrowth / kDepth,
                   .translation_noise_m = kNoise,
                   .rotation_noise_rad = kNoise / kDepth};
  for (int i = 0; i < kFrames; ++i) {
    uncertainty_.Update(Result(2, 0.0), prior);
    prior.continues = true;
  }
  const double drift = kFrames * kGrowth;
  EXPECT_NEAR(uncertainty_.surface_sigma_m(), std::hypot(drift, kNoise), kRounding);
  // Once something else holds the direction, the noise of the last pose stays in.
  uncertainty_.Update(Result(2, 0.0), Inertial(kFrame_s));
  EXPECT_NEAR(uncertainty_.surface_sigma_m(), std::hypot(drift, kNoise) + kSpeed * kFrame_s,
              kRounding);
}

/// With three unobservable axes along x, y and the rotation about z, only the rotation is uncertain
/// if only the rotation is.
TEST_F(PoseUncertaintyTest, RotationAndTranslationErrorsCountWhereTheyBelong) {
  TrackingResult result;
  result.motion.mean_depth_m = kDepth;
  result.motion.scale.tail<3>().setConstant(1.0 / kDepth);
  result.motion.axes.setZero();
  const std::array<int, 6> order = {0, 1, 5, 2, 3, 4};
  for (int i = 0; i < 6; ++i) result.motion.axes(order[i], i) = 1.0;
  result.motion.unobservable_axes = 3;
  uncertainty_.Update(result, {.translation_growth_m = 0.01, .rotation_growth_rad = 0.02});
  const Matrix6& covariance = uncertainty_.covariance();
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.01, kRounding);
  EXPECT_NEAR(std::sqrt(covariance(5, 5)), 0.02, kRounding);
  EXPECT_EQ(covariance(3, 3), 0.0);
}

}  // namespace
}  // namespace isotherm
