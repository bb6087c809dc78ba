#include "ground/feedback/view_smear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace isotherm {
namespace {

constexpr double kFocal_px = 400.0;

CameraModel Thermal() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = kFocal_px;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

ThermalSensorModel Sensor(double time_constant_s, double row_readout_s) {
  ThermalSensorModel sensor;
  sensor.time_constant_s = time_constant_s;
  sensor.row_readout_s = row_readout_s;
  return sensor;
}

/// One pixel that shows the point `p_map`.
SurfaceMaps Showing(const Eigen::Vector3f& p_map) {
  SurfaceMaps maps;
  maps.Resize(1, 1);
  maps.vx.At(0, 0) = p_map.x();
  maps.vy.At(0, 0) = p_map.y();
  maps.vz.At(0, 0) = p_map.z();
  return maps;
}

float Smear(const Eigen::Vector3f& p_map, const CameraMotion& motion,
            const ThermalSensorModel& sensor = Sensor(0.010, 0.0),
            const CameraModel& camera = Thermal()) {
  return SmearInView(Showing(p_map), RigidTransform::Identity(), motion, camera, sensor).At(0, 0);
}

/// How far the projection of a resting point moves within the time constant, by finite difference.
double ProjectedWay(const Eigen::Vector3d& p, const CameraMotion& motion, double time_s) {
  const auto project = [](const Eigen::Vector3d& q) {
    return Eigen::Vector2d(kFocal_px * q.x() / q.z(), kFocal_px * q.y() / q.z());
  };
  constexpr double kStep_s = 1e-6;
  RigidTransform T_before_after = RigidTransform::Identity();
  T_before_after.translation() = kStep_s * motion.velocity_m_s;
  const double angle = kStep_s * motion.rate_rad_s.norm();
  if (angle > 0.0) {
    T_before_after.linear() =
        Eigen::AngleAxisd(angle, motion.rate_rad_s.normalized()).toRotationMatrix();
  }
  return (project(T_before_after.inverse() * p) - project(p)).norm() / kStep_s * time_s;
}

TEST(SmearInViewTest, IsTheWayOfAPointsProjectionWithinTheTimeConstant) {
  const Eigen::Vector3f p(0.05F, -0.04F, 0.6F);
  for (const CameraMotion& motion :
       {CameraMotion{{0.3, 0.0, 0.0}, {0.0, 0.0, 0.0}}, CameraMotion{{0.0, 0.0, 0.4}, {0, 0, 0}},
        CameraMotion{{0.0, 0.0, 0.0}, {0.1, 0.3, -0.2}},
        CameraMotion{{0.1, -0.2, 0.05}, {0.2, -0.1, 0.3}}}) {
    EXPECT_NEAR(Smear(p, motion), ProjectedWay(p.cast<double>(), motion, 0.010), 1e-3);
  }
  // The thesis's speed at its distance: 0.3 m/s, 0.6 m away.
  EXPECT_NEAR(Smear({0, 0, 0.6F}, {{0.3, 0, 0}, {0, 0, 0}}), 2.0, 1e-3);
  EXPECT_EQ(Smear(p, {}), 0.0F);
}

TEST(SmearInViewTest, RowsThatAreReadLateAreShiftedByTheReadOut) {
  const ThermalSensorModel sensor = Sensor(0.0, 1e-4);
  // Row 119.5 + 80.
  const float smear = Smear({0, 0.12F, 0.6F}, {{0.3, 0, 0}, {0, 0, 0}}, sensor);
  EXPECT_NEAR(smear, 80 * 1e-4 * 0.3 / 0.6 * kFocal_px, 1e-3);
}

TEST(SmearInViewTest, IsKnownWhereABarrelLensDrawsASurfaceIn) {
  // 0.25 m aside at 0.6 m: 167 px from the middle without distortion, beyond the border at 160.
  const Eigen::Vector3f p(0.25F, 0, 0.6F);
  const CameraMotion motion{{0.3, 0, 0}, {0, 0, 0}};
  EXPECT_TRUE(std::isnan(Smear(p, motion)));
  CameraModel barrel = Thermal();
  barrel.k1 = -0.3;
  EXPECT_NEAR(Smear(p, motion, Sensor(0.010, 0.0), barrel), 2.0, 1e-3);
}

TEST(SmearInViewTest, IsNotKnownWhereTheThermalCameraSeesNothing) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const CameraMotion motion{{0.3, 0, 0}, {0, 0, 0}};
  EXPECT_TRUE(std::isnan(Smear({kNaN, kNaN, kNaN}, motion)));
  EXPECT_TRUE(std::isnan(Smear({0, 0, -0.6F}, motion))) << "behind it";
  EXPECT_TRUE(std::isnan(Smear({0.5F, 0, 0.6F}, motion))) << "beside its image";
}

}  // namespace
}  // namespace isotherm
