#include "ground/experiment/closed_loop_scan.h"

#include <gtest/gtest.h>

#include "common/simulation/simulation_options.pb.h"
#include "ground/experiment/raster_path.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// The first seconds of scans of the furnace door.
class ClosedLoopScanTest : public ::testing::Test {
 protected:
  ClosedLoopLog Scan(const Obedience& obedience, std::vector<Waypoint> path, double duration_s) {
    const Result<ClosedLoopLog> log = RunClosedLoop({.staged = staged_,
                                                     .surface = surface_,
                                                     .traits = TraitsOfPerson(1),
                                                     .obedience = obedience,
                                                     .path = std::move(path),
                                                     .seed = 1,
                                                     .max_duration_s = duration_s});
    if (!log) {
      ADD_FAILURE() << log.error().message();
      return {};
    }
    return *log;
  }

  const StagedScene staged_ = MakeScene(SceneOptions());
  const Rig rig_ = RigForClosedLoop();
  const ThermalOptions limits_ = CompleteLimits(ThermalOptions(), rig_.thermal_sensor);
  const MeasurableSurface surface_{staged_.scene, limits_};
};

TEST_F(ClosedLoopScanTest, WhoFollowsTheNextViewMeasuresSomethingWellInSixSeconds) {
  const ClosedLoopLog log = Scan({}, {}, 6.0);
  EXPECT_EQ(log.depth_frames, 120);
  EXPECT_NEAR(log.messages, 60, 1);
  EXPECT_EQ(log.lost_frames, 0);
  EXPECT_EQ(log.blocked_frames, 0);
  EXPECT_GT(log.way_m, 0.2) << "the first view is far off";
  EXPECT_GT(log.measured_well_at_end, 0.08);
  EXPECT_FALSE(log.done_s.has_value());
}

TEST_F(ClosedLoopScanTest, TheSamePersonScansTheSameWayTwice) {
  const ClosedLoopLog once = Scan({}, {}, 2.0), again = Scan({}, {}, 2.0);
  EXPECT_EQ(once.way_m, again.way_m);
  EXPECT_EQ(once.measured_well_at_end, again.measured_well_at_end);
  EXPECT_EQ(once.advice, again.advice);
}

TEST_F(ClosedLoopScanTest, AShortPathEndsTheScan) {
  const RigidTransform first = staged_.path.PoseAt(0.0);
  const ClosedLoopLog log = Scan({.next_view = false, .slower = false}, {{first, 0.3, 17.0}}, 6.0);
  EXPECT_TRUE(log.path_complete);
  EXPECT_LT(log.end_s, 1.0);
}

}  // namespace
}  // namespace isotherm
