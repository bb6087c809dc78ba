#include "ground/experiment/raster_path.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/units.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"
#include "ground/experiment/closed_loop_scan.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

class RasterPathTest : public ::testing::Test {
 protected:
  const Scene scene_ = MakeScene(SceneOptions()).scene;
  const Rig rig_ = RigForClosedLoop();
  const ThermalOptions limits_ = CompleteLimits(ThermalOptions(), rig_.thermal_sensor);
};

TEST_F(RasterPathTest, TheFrontOfTheFurnaceDoorIsTheWallWithWhatIsOnIt) {
  const SceneFront front = FrontOf(scene_);
  EXPECT_NEAR(front.region_m.min().x(), 0.01, 0.011);
  EXPECT_NEAR(front.region_m.max().y(), 0.95, 0.011);
  EXPECT_GT(front.median_z_m, 0.78);
  EXPECT_LT(front.median_z_m, 0.87);
}

TEST_F(RasterPathTest, ItsSpeedSmearsFourFifthsOfWhatIsGood) {
  const double speed_m_s = RasterSpeed(rig_, limits_);
  // Half a pixel is good; 0.45 m away a pixel of the thermal camera is 1.2 mm wide.
  EXPECT_NEAR(speed_m_s * rig_.thermal_sensor.time_constant_s * rig_.thermal->fx / 0.45, 0.4, 1e-9);
}

TEST_F(RasterPathTest, EachPointOfTheFrontIsInViewFromSomewhereAtAGoodDistanceStraightOn) {
  const SceneFront front = FrontOf(scene_);
  const std::vector<Waypoint> path = RasterPath(scene_, rig_, limits_, 0.05);
  for (double y = front.region_m.min().y(); y < front.region_m.max().y(); y += 0.02) {
    for (double x = front.region_m.min().x(); x < front.region_m.max().x(); x += 0.02) {
      const Eigen::Vector3d p_world(x, y, front.median_z_m);
      EXPECT_TRUE(std::ranges::any_of(
          path,
          [&](const Waypoint& waypoint) {
            const RigidTransform T_thermal_world =
                *rig_.T_thermal_depth * waypoint.T_world_depth.inverse();
            const Eigen::Vector3d p = T_thermal_world * p_world;
            if (p.z() < 0.3 || p.norm() > 0.6) return false;
            return std::abs(p.x() / p.z()) <= 0.52 && std::abs(p.y() / p.z()) <= 0.39;
          }))
          << x << " " << y;
    }
  }
}

TEST_F(RasterPathTest, FacesToAllSidesAreSeenAtAGoodAngle) {
  const std::vector<Waypoint> path = RasterPath(scene_, rig_, limits_, 0.05);
  const double cos_good = std::cos((limits_.angle().good_deg() + 1.0) * kRadPerDeg);
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0),
        Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, -1)}) {
    EXPECT_TRUE(std::ranges::any_of(path, [&](const Waypoint& waypoint) {
      return -waypoint.T_world_depth.linear().col(2).dot(normal) > cos_good;
    })) << normal.transpose();
  }
}

TEST_F(RasterPathTest, NoWaypointIsInOrNextToAnything) {
  for (const Waypoint& waypoint : RasterPath(scene_, rig_, limits_, 0.05))
    EXPECT_FALSE(scene_.IsCovered(waypoint.T_world_depth.translation(), -1, 0.05));
}

}  // namespace
}  // namespace isotherm
