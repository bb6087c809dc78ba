#include "common/simulation/simulated_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

/// A wall of painted and polished steel that the rig faces, with an operator behind the cameras.
StagedScene PolishedWallAndOperator(bool with_operator) {
  SceneBuilder builder(23.0);
  builder.UseMaterial({0.2, 12.0, 40.0, true});
  builder.Box("polished", {0.1, 0.1, 0.7}, {0.9, 0.9, 0.8}).temperature = Uniform(30.0);
  ScanPath path;
  path.target_x_m = path.target_y_m = {0.5};
  path.target_z_m = {0.7};
  path.distance_m = {0.5};
  StagedScene staged{builder.Build("polished wall"), path, {}};
  if (!with_operator) return staged;
  SceneBuilder carried(23.0);
  carried.UseMaterial({});
  carried.Sphere("operator", {0.0, 0.0, -0.6}, 0.25).temperature = Uniform(90.0);
  staged.carried = carried.Build("carried").primitives();
  return staged;
}

class SimulatedScanTest : public ::testing::Test {
 protected:
  SimulatedScanTest() { options_.set_duration_s(3.0); }

  std::unique_ptr<SimulatedScan> Create(StagedScene staged) {
    auto scan = SimulatedScan::Create(options_, std::move(staged));
    EXPECT_TRUE(scan.has_value()) << scan.error().message();
    return std::move(*scan);
  }
  static double CentreCelsius(const RawFrame& frame) {
    return frame.pixels.At(205, 150) / 100.0 - 273.15;
  }

  SimulationOptions options_;
};

TEST_F(SimulatedScanTest, APolishedWallShowsTheOperatorWhoIsNotInTheDepthPicture) {
  const auto alone = Create(PolishedWallAndOperator(false));
  const auto held = Create(PolishedWallAndOperator(true));
  SimulatedScan::Scratch scratch;
  const double without = CentreCelsius(alone->RenderThermal(0, scratch));
  EXPECT_NEAR(without, 25.0, 2.0) << "a little of the wall, most of the surroundings";
  EXPECT_GT(CentreCelsius(held->RenderThermal(0, scratch)), without + 40.0);
  const RawFrame depth = held->RenderDepth(0, scratch);
  EXPECT_TRUE(
      std::ranges::equal(depth.pixels.pixels(), alone->RenderDepth(0, scratch).pixels.pixels()));
}

TEST_F(SimulatedScanTest, ClosingsCanBecomeLonger) {
  ShutterOptions& shutter = *options_.mutable_shutter();
  shutter.set_first_s(0.5);
  shutter.set_interval_s(1.0);
  shutter.set_duration_s(0.4);
  shutter.set_duration_step_s(0.3);
  const auto scan = Create(PolishedWallAndOperator(false));
  ASSERT_EQ(scan->nuc_events().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const NucEvent& event = scan->nuc_events()[i];
    EXPECT_NEAR(ToSeconds(event.end - event.start), 0.4 + 0.3 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(SimulatedScanTest, OptionsOutOfRangeAreRefusedWithASceneOfOnesOwnToo) {
  options_.mutable_thermal()->set_time_constant_s(-0.01);
  const auto scan = SimulatedScan::Create(options_, PolishedWallAndOperator(false));
  ASSERT_FALSE(scan.has_value());
  EXPECT_NE(scan.error().message().find("thermal.time_constant_s"), std::string::npos);
}

}  // namespace
}  // namespace isotherm
