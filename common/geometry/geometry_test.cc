#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {
namespace {

constexpr double kExact = 1e-12;
constexpr double kSubPixel = 1e-6;  // Iterative undistortion, pixels.

RigidTransform Rotation(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& t) {
  return MakeTransform(t, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)));
}

TEST(InterpolateTest, HalfWayIsHalfTheAngleAndHalfTheDistance) {
  const RigidTransform a = Rotation(0.2, Eigen::Vector3d::UnitY(), {0, 0, 0});
  const RigidTransform b = Rotation(0.6, Eigen::Vector3d::UnitY(), {0.1, 0.2, -0.4});
  const RigidTransform middle = Interpolate(a, b, 0.5);
  EXPECT_NEAR(RotationAngle(a, middle), 0.2, kExact);
  EXPECT_NEAR(RotationAngle(middle, b), 0.2, kExact);
  EXPECT_TRUE(middle.translation().isApprox(Eigen::Vector3d(0.05, 0.1, -0.2), kExact));
}

TEST(InterpolateTest, TakesTheShortWayRound) {
  const RigidTransform a = Rotation(3.0, Eigen::Vector3d::UnitZ(), {0, 0, 0});
  const RigidTransform b = Rotation(-3.0, Eigen::Vector3d::UnitZ(), {0, 0, 0});
  const double gap = 2.0 * (std::numbers::pi - 3.0);
  EXPECT_NEAR(RotationAngle(a, Interpolate(a, b, 0.5)), gap / 2.0, 1e-9);
}

TEST(TwistTest, SmallAnglesKeepFullPrecision) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.001, -0.002, 0.003, 0.0, 1e-9, 0.0;
  const RigidTransform transform = TransformFromTwist(twist);
  EXPECT_NEAR(RotationAngle(RigidTransform::Identity(), transform), 1e-9, 1e-15);
  EXPECT_NEAR(TranslationDistance(RigidTransform::Identity(), transform), std::sqrt(14e-6), kExact);
}

TEST(IsRigidTest, RefusesScaleReflectionAndNan) {
  EXPECT_TRUE(IsRigid(RigidTransform::Identity()));
  RigidTransform bad = RigidTransform::Identity();
  bad.linear() *= 1.01;
  EXPECT_FALSE(IsRigid(bad));
  bad.linear() = -Eigen::Matrix3d::Identity();
  EXPECT_FALSE(IsRigid(bad));
  bad = RigidTransform::Identity();
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(IsRigid(bad));
}

CameraModel ThermalCameraModel() {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = 371.4;
  camera.fy = 372.1;
  camera.cx = 205.5;
  camera.cy = 150.5;
  camera.k1 = -0.439;
  camera.k2 = 0.29;
  camera.p1 = 0.000454;
  camera.p2 = -0.000257;
  camera.k3 = -0.114;
  return camera;
}

TEST(CameraTest, UnprojectInvertsProjectOverTheWholeImage) {
  const CameraModel camera = ThermalCameraModel();
  for (int v = 0; v < camera.height; v += 7) {
    for (int u = 0; u < camera.width; u += 7) {
      const Eigen::Vector2d pixel(u, v);
      const Eigen::Vector2d back = ProjectNormalized(camera, Unproject(camera, pixel));
      EXPECT_NEAR((back - pixel).norm(), 0.0, kSubPixel) << "u=" << u << " v=" << v;
    }
  }
}

TEST(CameraTest, UnprojectFindsThePointThatAnyLensHasMoved) {
  constexpr double kNearFold = 1e-9;  // Normalised: the polynomial is flat there.
  struct Lens {
    double k1, k2, p1, p2, k3;
    double radius;  ///< Normalised; within the fold of the polynomial.
  };
  for (const auto& [k1, k2, p1, p2, k3, radius] :
       {Lens{-0.4, 0.0, 0.0, 0.0, 0.0, 0.9}, Lens{-0.4, 0.05, 0.01, -0.02, 0.0, 0.9},
        Lens{0.5, 0.0, -0.01, 0.01, 0.0, 1.5}, Lens{-0.2, 0.3, 0.0, 0.0, -0.1, 0.9},
        Lens{0.0, 0.0, 0.05, 0.05, 0.0, 1.0}}) {
    CameraModel camera = ThermalCameraModel();
    camera.k1 = k1, camera.k2 = k2, camera.p1 = p1, camera.p2 = p2, camera.k3 = k3;
    constexpr int kRadii = 20, kDirections = 8;
    for (int i = 0; i < kRadii * kDirections; ++i) {
      const int ring = i / kDirections;
      const double r = radius * ring / (kRadii - 1), angle = 0.8 * (i % kDirections);
      const Eigen::Vector2d point(r * std::cos(angle), r * std::sin(angle));
      const Eigen::Vector2d found = Unproject(camera, ProjectNormalized(camera, point));
      EXPECT_NEAR((found - point).norm(), 0.0, kNearFold) << "k1=" << k1 << " r=" << r;
    }
  }
}

TEST(CameraTest, AWideLensesPointsAreFoundToItsEdge) {
  CameraModel fisheye = ThermalCameraModel().WithoutDistortion();
  fisheye.lens = LensKind::kFisheye;
  fisheye.k1 = -0.03, fisheye.k2 = 0.01;
  CameraModel rational = ThermalCameraModel();
  rational.lens = LensKind::kRational;
  rational.k1 = 0.778, rational.k2 = 0.068, rational.k3 = 0.002;
  rational.k4 = 1.11, rational.k5 = 0.238, rational.k6 = 0.004;
  for (const auto& [camera, max_tangent] : {std::pair(fisheye, 50.0), std::pair(rational, 1.8)}) {
    for (int i = 0; i <= 50; ++i) {
      const double r = 0.02 * i * max_tangent;
      const Eigen::Vector2d point(r * std::cos(3.0 * r), r * std::sin(3.0 * r));
      const Eigen::Vector2d found = Unproject(camera, ProjectNormalized(camera, point));
      EXPECT_NEAR((found - point).norm(), 0.0, 1e-8 * (1.0 + r * r)) << r;
    }
  }
}

TEST(CameraTest, AFisheyePixelThatLooksBackwardsSeesNothing) {
  CameraModel camera = ThermalCameraModel().WithoutDistortion();
  camera.lens = LensKind::kFisheye;
  for (const double radius : {1.6, 3.0, 50.0}) {
    const Eigen::Vector2d pixel(camera.cx, camera.cy - radius * camera.fy);
    const Eigen::Vector2d back = ProjectNormalized(camera, Unproject(camera, pixel));
    EXPECT_FALSE((back - pixel).norm() <= 1.0) << radius;
  }
}

TEST(CameraTest, TheDerivativeIsTheSlopeOfTheProjection) {
  for (const LensKind lens : {LensKind::kBrownConrady, LensKind::kRational, LensKind::kFisheye}) {
    CameraModel camera = ThermalCameraModel();
    camera.lens = lens;
    camera.k4 = 0.02, camera.k5 = -0.03, camera.k6 = 0.01;
    for (const Eigen::Vector2d& point : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1e-5, -1e-5),
                                         Eigen::Vector2d(0.3, -0.2), Eigen::Vector2d(-0.6, 0.4)}) {
      const ProjectedPixel found = ProjectWithDerivative(camera, point);
      EXPECT_EQ(found.pixel, ProjectNormalized(camera, point));
      constexpr double kStep = 1e-6;
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
        const Eigen::Vector2d slope =
            (ProjectNormalized(camera, point + step) - ProjectNormalized(camera, point - step)) /
            (2.0 * kStep);
        EXPECT_NEAR((found.by_normalized.col(axis) - slope).norm(), 0.0, 1e-5)
            << static_cast<int>(lens) << " at " << point.transpose();
      }
    }
  }
}

TEST(CameraTest, WhatThePolynomialDoesNotReachIsNotUnprojected) {
  CameraModel camera = ThermalCameraModel();
  camera.k1 = -0.4, camera.k2 = camera.p1 = camera.p2 = camera.k3 = 0.0;
  // It moves nothing farther out than to 0.609.
  const Eigen::Vector2d pixel(camera.cx + 0.7 * camera.fx, camera.cy);
  const Eigen::Vector2d back = ProjectNormalized(camera, Unproject(camera, pixel));
  EXPECT_FALSE((back - pixel).norm() <= 1.0) << "nor NaN";
}

TEST(CameraTest, PointsBehindTheCameraDoNotProject) {
  EXPECT_EQ(Project(ThermalCameraModel(), {0.0, 0.0, 0.0}), std::nullopt);
  EXPECT_EQ(Project(ThermalCameraModel(), {0.1, 0.0, -1.0}), std::nullopt);
}

TEST(CameraTest, DownscaledCameraSeesTheSameDirections) {
  CameraModel camera = ThermalCameraModel().WithoutDistortion();
  const CameraModel half = camera.Downscaled(1);
  EXPECT_EQ(half.width, 191);
  // The centre between full-resolution pixels 10 and 11 is half-resolution pixel 5.
  const Eigen::Vector2d full = Unproject(camera, {10.5, 20.5});
  const Eigen::Vector2d coarse = Unproject(half, {5.0, 10.0});
  EXPECT_NEAR((full - coarse).norm(), 0.0, kExact);
}

TEST(CameraTest, ALensOfALaterVersionIsRejected) {
  CameraModel camera = ThermalCameraModel().WithoutDistortion();
  camera.lens = static_cast<LensKind>(3);
  EXPECT_FALSE(Validate(camera, "thermal").ok());
}

TEST(CameraTest, F57NonPhysicalIntrinsicsAreRejectedByName) {
  CameraModel camera = ThermalCameraModel();
  EXPECT_TRUE(Validate(camera, "thermal").ok());
  camera.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(Validate(camera, "thermal").message().find("thermal: fx"), std::string::npos);
  camera = ThermalCameraModel();
  camera.width = 0;
  EXPECT_FALSE(Validate(camera, "thermal").ok());
  camera = ThermalCameraModel();
  camera.cx = 1e6;
  EXPECT_FALSE(Validate(camera, "thermal").ok());
}

}  // namespace
}  // namespace isotherm
