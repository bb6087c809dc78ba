#include "ground/thermal/camera_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <initializer_list>

namespace isotherm {
namespace {

constexpr double kInterval_s = 0.02;

/// A pose after `t_s` of even motion in the camera's own coordinates, small steps after each other.
RigidTransform Moved(RigidTransform pose, const CameraMotion& motion, double t_s) {
  constexpr int kSteps = 2000;
  const double dt = t_s / kSteps;
  RigidTransform step = RigidTransform::Identity();
  step.linear() = Eigen::AngleAxisd(motion.rate_rad_s.norm() * dt, motion.rate_rad_s.normalized())
                      .toRotationMatrix();
  step.translation() = motion.velocity_m_s * dt;
  for (int i = 0; i < kSteps; ++i) pose = pose * step;
  return pose;
}

const CameraMotion kMotion{{0.2, -0.1, 0.3}, {0.4, -0.6, 0.5}};
const RigidTransform kStart =
    MakeTransform({0.3, 0.2, -0.5}, Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized());

TEST(CameraMotionTest, ThePosesOfAnEvenMotionGiveItBack) {
  const CameraMotion found =
      MotionBetween(kStart, Moved(kStart, kMotion, kInterval_s), kInterval_s);
  constexpr double kCurvature = 1e-4;  // Second order in the rotation, about 0.02 rad.
  EXPECT_LT((found.velocity_m_s - kMotion.velocity_m_s).norm(), kCurvature);
  EXPECT_LT((found.rate_rad_s - kMotion.rate_rad_s).norm(), kCurvature);
  EXPECT_EQ(MotionBetween(kStart, kStart, 0.0).velocity_m_s.norm(), 0.0);
}

TEST(CameraMotionTest, AnEvenlyChangingMotionIsCarriedOnToTheEnd) {
  // 1 m/s^2 and 2 rad/s^2 from rest, looked at over 0 .. 0.1 s and 0.1 .. 0.4 s.
  const auto at = [](double t_s) {
    return CameraMotion{{1.0 * t_s, 0.0, 0.0}, {0.0, 2.0 * t_s, 0.0}};
  };
  const CameraMotion end = MotionAtEnd(at(0.05), 0.1, at(0.25), 0.3);
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR(end.velocity_m_s.x(), 0.4, kRounding);
  EXPECT_NEAR(end.rate_rad_s.y(), 0.8, kRounding);
  EXPECT_EQ(MotionAtEnd(at(0.05), 0.0, at(0.25), 0.3).velocity_m_s.x(), 0.25) << "not known";
}

TEST(CameraMotionTest, TheFastestIsTheOneThatMovesTheImageMost) {
  CameraModel camera{101, 101, 100.0, 100.0, 50.0, 50.0};
  const CameraMotion sideways{{0.1, 0.0, 0.0}, Eigen::Vector3d::Zero()};
  const CameraMotion turning{Eigen::Vector3d::Zero(), {0.0, 0.2, 0.0}};
  const CameraMotion rolling{Eigen::Vector3d::Zero(), {0.0, 0.0, 0.5}};
  const auto fastest = [&](std::initializer_list<CameraMotion> motions, double depth_m) {
    return FastestInImage({motions.begin(), motions.size()}, camera, depth_m);
  };
  EXPECT_EQ(fastest({sideways, turning}, 0.3).velocity_m_s, sideways.velocity_m_s);
  EXPECT_EQ(fastest({sideways, turning}, 1.0).rate_rad_s, turning.rate_rad_s);
  EXPECT_EQ(fastest({turning, rolling}, 1.0).rate_rad_s, rolling.rate_rad_s) << "in the corners";
}

TEST(CameraMotionTest, APointGoesThroughTheImageAsItsProjectionsDo) {
  for (const double z : {0.3, 0.5, 2.0}) {
    for (const Eigen::Vector2d& xy :
         {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.4, -0.3), Eigen::Vector2d(-0.5, 0.2)}) {
      const Eigen::Vector3d p_map = kStart * (z * Eigen::Vector3d(xy.x(), xy.y(), 1.0));
      const auto project = [&](double t_s) -> Eigen::Vector2d {
        CameraMotion motion = kMotion;
        if (t_s < 0.0) motion = {-kMotion.velocity_m_s, -kMotion.rate_rad_s};
        const Eigen::Vector3d p = Moved(kStart, motion, std::abs(t_s)).inverse() * p_map;
        return p.head<2>() / p.z();
      };
      constexpr double kStep_s = 1e-4;
      const Eigen::Vector2d slope = (project(kStep_s) - project(-kStep_s)) / (2.0 * kStep_s);
      EXPECT_LT((ImageVelocity(kMotion, xy, z) - slope).norm(), 1e-5) << "at " << z << " m";
    }
  }
}

}  // namespace
}  // namespace isotherm
