#include "common/simulation/simulated_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/frame/frame.h"
#include "common/simulation/options.h"
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

TEST_F(SimulatedScanTest, APolishedWallShowsTheOperatorWhoIsNotInTheDepthImage) {
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

/// A wall of one temperature that the rig faces and that fills the thermal image.
StagedScene PlainWall() {
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  builder.Box("wall", {-1.0, -1.0, 0.7}, {2.0, 2.0, 0.8}).temperature = Uniform(40.0);
  ScanPath path;
  path.target_x_m = path.target_y_m = {0.5};
  path.target_z_m = {0.7};
  path.distance_m = {0.5};
  return {builder.Build("plain wall"), path, {}};
}

TEST_F(SimulatedScanTest, AHousingThatWarmsUpFalsifiesTemperaturesUntilTheNextNuc) {
  // Fig. 3.4b: 5 K of the housing, 20 K of error. After 10 time constants nothing is left to come.
  options_.set_duration_s(20.0);
  options_.mutable_thermal()->mutable_expert()->set_netd_kelvin(0.0);
  options_.mutable_shutter()->set_interval_s(0.0);
  ThermalDriftOptions& drift = *options_.mutable_drift();
  drift.set_warm_up_k(5.0);
  drift.set_time_constant_s(2.0);
  const auto without = Create(PlainWall());
  drift.set_error_per_kelvin(4.0);
  const auto with = Create(PlainWall());
  SimulatedScan::Scratch scratch;
  const std::uint64_t last = with->thermal_times().size() - 1;
  const double truth = CentreCelsius(without->RenderThermal(last, scratch));
  const RawFrame late = with->RenderThermal(last, scratch);
  EXPECT_NEAR(CentreCelsius(late) - truth, 20.0, 0.02);
  EXPECT_NEAR(late.housekeeping.housing_celsius, 35.0, 0.01);
  EXPECT_NEAR(CentreCelsius(with->RenderThermal(0, scratch)), truth, 0.3) << "just corrected";

  options_.mutable_shutter()->set_first_s(18.0);
  options_.mutable_shutter()->set_interval_s(100.0);
  const auto corrected = Create(PlainWall());
  EXPECT_NEAR(CentreCelsius(corrected->RenderThermal(last, scratch)), truth, 0.02);
}

TEST_F(SimulatedScanTest, TheShutterClosesWheneverTheHousingHasDrifted) {
  options_.set_duration_s(20.0);
  ThermalDriftOptions& drift = *options_.mutable_drift();
  drift.set_warm_up_k(5.0);
  drift.set_time_constant_s(4.0);
  ShutterOptions& shutter = *options_.mutable_shutter();
  shutter.set_interval_s(0.0);
  shutter.set_duration_s(0.1);
  shutter.mutable_expert()->set_drift_k(0.8);
  const auto scan = Create(PlainWall());
  // The housing at t is 30 + 5 (1 - exp(-t / 4)). It is 0.8 K above h at -4 ln(1 - (h + 0.8 - 30) /
  // 5).
  double opened_s = 0.0;
  ASSERT_GE(scan->nuc_events().size(), 4U);
  for (const NucEvent& event : scan->nuc_events()) {
    const double reached_k = 5.0 * (1.0 - std::exp(-opened_s / 4.0));
    const double expected_s = -4.0 * std::log(1.0 - (reached_k + 0.8) / 5.0);
    const double closed_s = ToSeconds(event.start - scan->depth_times()[0].exposure);
    EXPECT_NEAR(closed_s, expected_s, 0.011) << "two steps of 5 ms";
    opened_s = closed_s + 0.1;
  }
}

TEST_F(SimulatedScanTest, ClosingsCanBecomeLonger) {
  ShutterOptions& shutter = *options_.mutable_shutter();
  shutter.set_first_s(0.5);
  shutter.set_interval_s(1.0);
  shutter.set_duration_s(0.4);
  shutter.mutable_expert()->set_duration_step_s(0.3);
  const auto scan = Create(PolishedWallAndOperator(false));
  ASSERT_EQ(scan->nuc_events().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const NucEvent& event = scan->nuc_events()[i];
    EXPECT_NEAR(ToSeconds(event.end - event.start), 0.4 + 0.3 * static_cast<double>(i), 1e-9);
  }
}

TEST_F(SimulatedScanTest, OptionsOutOfRangeAreRefusedWithASceneOfOnesOwnToo) {
  options_.mutable_thermal()->mutable_expert()->set_time_constant_s(-0.01);
  const auto scan = SimulatedScan::Create(options_, PolishedWallAndOperator(false));
  ASSERT_FALSE(scan.has_value());
  EXPECT_NE(scan.error().message().find("thermal.expert.time_constant_s"), std::string::npos);
}

TEST_F(SimulatedScanTest, IdealCamerasAreWorseOnlyByWhatIsSet) {
  options_.mutable_thermal()->mutable_expert()->set_flicker_k(0.3);
  options_.mutable_depth()->mutable_expert()->set_flying_fraction(0.2);
  const SimulationOptions ideal = Resolved(options_);
  EXPECT_EQ(ideal.thermal().expert().time_constant_s(), 0.0);
  EXPECT_EQ(ideal.thermal().expert().lens().focus_m(), 0.0);
  EXPECT_EQ(ideal.thermal().expert().flicker_k(), 0.3);
  EXPECT_EQ(ideal.depth().expert().flying_fraction(), 0.2);
  EXPECT_EQ(ideal.drift().error_per_kelvin(), 0.0);
  options_.set_ideal_cameras(false);
  const SimulationOptions real = Resolved(options_);
  EXPECT_EQ(real.thermal().expert().time_constant_s(), 0.01);
  EXPECT_EQ(real.thermal().expert().lens().focus_m(), 0.6);
  EXPECT_EQ(real.drift().error_per_kelvin(), 4.0);
}

TEST_F(SimulatedScanTest, TheDepthCameraWarmsUpAsTheOptionsSay) {
  options_.mutable_depth()->mutable_expert()->set_warm_up_stretch(0.02);
  options_.mutable_depth()->mutable_expert()->set_disparity_step_px(0.0);
  options_.mutable_depth()->mutable_expert()->set_depth_scale(10'000.0);
  options_.mutable_depth()->mutable_expert()->set_warm_up_time_constant_s(2.0);
  const auto scan = Create(PolishedWallAndOperator(false));
  const CaptureTime start = scan->depth_times().front().exposure;
  EXPECT_EQ(scan->DepthStretch(start), 1.0);
  EXPECT_NEAR(scan->DepthStretch(start + FromSeconds(2.0)), 1.0 + 0.02 * (1.0 - std::exp(-1.0)),
              1e-9);
  SimulatedScan::Scratch scratch;
  const auto mean = [&](std::uint64_t frame) {
    const RawFrame raw = scan->RenderDepth(frame, scratch);
    double sum = 0.0, count = 0.0;
    for (const std::uint16_t value : raw.pixels.pixels()) {
      sum += value;
      count += value == kNoDepth ? 0.0 : 1.0;
    }
    return sum / count;
  };
  const std::uint64_t last = scan->depth_times().size() - 1;
  const double stretch = scan->DepthStretch(scan->depth_times()[last].exposure);
  EXPECT_NEAR(mean(last) / mean(0), stretch, 2e-4) << "the rig stands still";
}

}  // namespace
}  // namespace isotherm
