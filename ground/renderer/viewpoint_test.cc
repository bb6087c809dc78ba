#include "ground/renderer/viewpoint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr double kExact = 1e-9;
constexpr double kFloat = 1e-5;  // Points are floats, metres.

std::vector<Eigen::Vector3f> BoxCorners(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  std::vector<Eigen::Vector3f> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? high.z() : low.z());
  }
  return corners;
}

/// Largest distance of a point from the rendering's middle, as a fraction of the way to its edge,
/// per axis; infinite if one is behind the camera.
Eigen::Vector2d Reach(const std::vector<Eigen::Vector3f>& points, const CameraModel& camera,
                      const RigidTransform& T_world_camera) {
  Eigen::Vector2d reach = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3f& p_world : points) {
    const auto u = Project(camera, T_world_camera.inverse() * p_world.cast<double>());
    if (!u) return Eigen::Vector2d::Constant(INFINITY);
    reach = reach.cwiseMax((*u - Eigen::Vector2d(camera.cx, camera.cy))
                               .cwiseAbs()
                               .cwiseQuotient(Eigen::Vector2d(camera.width, camera.height) / 2.0));
  }
  return reach;
}

TEST(RenderingCameraTest, SpansTheAngle) {
  const CameraModel camera = RenderingCamera(800, 600, 90.0);
  EXPECT_NEAR(camera.fx, 400.0, kExact);
  EXPECT_NEAR(camera.fy, 400.0, kExact);
  EXPECT_TRUE(Validate(camera, "rendering").ok());
}

TEST(LookAtTest, PutsThePlaceInTheMiddleAndUpIsUp) {
  const CameraModel camera = RenderingCamera(800, 600, 60.0);
  const Eigen::Vector3d from(1.0, -2.0, 0.5), at(0.2, 0.3, 0.1);
  const auto T_world_camera = LookAt(from, at, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(T_world_camera);
  EXPECT_TRUE(IsRigid(*T_world_camera));
  EXPECT_EQ(T_world_camera->translation(), from);
  const auto middle = Project(camera, T_world_camera->inverse() * at);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->x(), camera.cx, 1e-6);
  EXPECT_NEAR(middle->y(), camera.cy, 1e-6);
  const auto above = Project(camera, T_world_camera->inverse() * (at + Eigen::Vector3d(0, 0, 0.1)));
  EXPECT_NEAR(above->x(), camera.cx, 1e-6);
  EXPECT_LT(above->y(), camera.cy);
  EXPECT_FALSE(LookAt(at, at, Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(LookAt(at + Eigen::Vector3d::UnitZ(), at, Eigen::Vector3d::UnitZ()));
}

TEST(FrameAllTest, ModelTouchesTheMarginInOneDirectionAndIsInsideInTheOther) {
  const auto points = BoxCorners({0.1F, 0.2F, 0.3F}, {0.9F, 0.5F, 0.5F});
  const CameraModel camera = RenderingCamera(640, 480, 60.0);
  for (const Eigen::Vector3d& to_viewer :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0.5, -0.3, -0.8).normalized(),
        Eigen::Vector3d(1, 0, 0)}) {
    const RigidTransform T_world_camera =
        FrameAll(points, to_viewer, -Eigen::Vector3d::UnitY(), camera);
    EXPECT_NEAR(T_world_camera.linear().col(2).dot(to_viewer), -1.0, kExact);
    const Eigen::Vector2d reach = Reach(points, camera, T_world_camera);
    // 94 % of the rendering, give or take half a pixel: (width - 1) / 2 is its middle.
    EXPECT_NEAR(reach.maxCoeff(), 0.94, 1.0 / 480.0);
  }
}

TEST(AspectTest, IsTheSideThatWasLookedAt) {
  const auto points = BoxCorners({-0.5F, -0.5F, 1.0F}, {0.5F, 0.5F, 1.2F});
  std::vector<RigidTransform> poses;
  for (const double x : {-0.2, 0.0, 0.2}) {
    poses.push_back(MakeTransform({x, 0.0, 0.4}, Eigen::Quaterniond::Identity()));
  }
  const ModelAspect aspect = AspectOf(points, poses);
  EXPECT_TRUE(aspect.one_sided);
  EXPECT_NEAR((aspect.centre_world - Eigen::Vector3d(0, 0, 1.1)).norm(), 0.0, kFloat);
  EXPECT_NEAR((aspect.to_viewer_world - Eigen::Vector3d(0, 0, -1)).norm(), 0.0, kFloat);
  EXPECT_NEAR((aspect.up_world - Eigen::Vector3d(0, -1, 0)).norm(), 0.0, kFloat);
}

TEST(AspectTest, ScanAllAroundHasNoSide) {
  const auto points = BoxCorners({-0.1F, -0.1F, -0.1F}, {0.1F, 0.1F, 0.1F});
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 12; ++i) {
    const Eigen::AngleAxisd rotation(i * std::numbers::pi / 6.0, Eigen::Vector3d::UnitY());
    poses.push_back(RigidTransform(rotation) *
                    MakeTransform({0, 0, -0.6}, Eigen::Quaterniond::Identity()));
  }
  const ModelAspect aspect = AspectOf(points, poses);
  EXPECT_FALSE(aspect.one_sided);
  EXPECT_NEAR((aspect.up_world - Eigen::Vector3d(0, -1, 0)).norm(), 0.0, kFloat);
  EXPECT_NEAR(aspect.to_viewer_world.norm(), 1.0, kExact);
}

TEST(AspectTest, WithoutPosesTheFirstCameraIsAssumed) {
  const auto points = BoxCorners({0, 0, 0}, {1, 1, 1});
  const ModelAspect aspect = AspectOf(points, {});
  EXPECT_EQ(aspect.to_viewer_world, Eigen::Vector3d(0, 0, -1));
}

/// Expects the orbit around a box from the origin, from 20 degrees above.
void ExpectOrbit(const Eigen::Vector3f& size_m, double arc_deg) {
  SCOPED_TRACE(arc_deg);
  const auto points = BoxCorners(Eigen::Vector3f::Zero(), size_m);
  const CameraModel camera = RenderingCamera(640, 480, 50.0);
  const ModelAspect aspect = AspectOf(points, {});
  const auto views = Orbit(points, aspect, camera, {9, arc_deg, 20.0});
  ASSERT_EQ(views.size(), 9U);
  double most = 0.0;
  for (const RigidTransform& view : views) {
    const Eigen::Vector3d to_viewer = view.translation() - aspect.centre_world;
    EXPECT_NEAR(to_viewer.norm(), (views[0].translation() - aspect.centre_world).norm(), kExact);
    EXPECT_NEAR(to_viewer.normalized().dot(aspect.up_world), std::sin(20.0 * kRadPerDeg), kExact);
    EXPECT_NEAR(view.linear().col(2).dot(to_viewer.normalized()), -1.0, kExact);
    most = std::max(most, Reach(points, camera, view).maxCoeff());
  }
  EXPECT_NEAR(most, 0.94, 1.0 / 480.0);
  const auto azimuth_deg = [&](const RigidTransform& view) {
    const Eigen::Vector3d d = view.translation() - aspect.centre_world;
    return std::atan2(d.x(), -d.z()) * 180.0 / std::numbers::pi;
  };
  const bool closed = arc_deg == 360.0;
  EXPECT_NEAR(std::abs(azimuth_deg(views[1]) - azimuth_deg(views[0])), closed ? 40.0 : 15.0, 1e-6);
  EXPECT_NEAR(azimuth_deg(views[closed ? 0 : 4]), 0.0, 1e-6);
}

TEST(OrbitTest, GoesAroundTheCentreAtOneDistanceWithEverythingInView) {
  for (const double arc_deg : {360.0, 120.0}) {
    ExpectOrbit({0.8F, 0.4F, 0.2F}, arc_deg);
    ExpectOrbit({0.2F, 0.8F, 0.2F}, arc_deg);  // High: its top comes nearest.
  }
}

}  // namespace
}  // namespace isotherm
