// `isotherm calibrate radiometric`, as a user runs it, on simulated cameras whose errors are known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "common/rig/rig_calibration.h"
#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kRig = R"(# Of a simulated rig.
depth { width: 256 height: 192 fx: 227 fy: 227 cx: 128.4 cy: 96.9 }
thermal { width: 191 height: 144 fx: 185.7 fy: 186 cx: 102.5 cy: 75 k1: -0.44 k2: 0.29 p1: 0.0004 k3: -0.11 }
T_thermal_depth { tx: 0.05 ty: 0.01 tz: 0.002 qx: -0.00436 qy: 0.00349 qz: -0.000857 qw: 0.999984 }
serial: "A 17" date: "2026-01-02" method: "mask"
)";
constexpr double kOffset_k = 1.5, kGain = -0.02;

class RadiometricToolTest : public ToolRun {
 protected:
  RadiometricToolTest() { Write("rig.textproto", kRig); }

  /// A recording of a camera that reads wrong before a hole of this radius.
  void LookThrough(const std::string& name, double radius_m, double hot_celsius) const {
    RunWell("simulate -o " + name +
            " --duration 1 --scene aperture-plate --set rig_file=rig.textproto "
            "--set thermal.rate_hz=20 --set depth.rate_hz=5 --set ideal_cameras=false "
            "--set thermal.expert.lens.focus_m=0.22 "
            "--set thermal.expert.scene_influence.near_sigma_px=20 "
            "--set thermal.expert.offset_error_k=" +
            std::to_string(kOffset_k) + " --set thermal.expert.gain_error=" +
            std::to_string(kGain) + " --set scene.hole_radius_m=" + std::to_string(radius_m) +
            " --set scene.hot_celsius=" + std::to_string(hot_celsius));
  }
  static int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }
  ThermalSensorModel Sensor(const std::string& file) const {
    const Result<Rig> rig = LoadRigCalibration(folder_ / file);
    EXPECT_TRUE(rig) << rig.error().message();
    return rig ? rig->thermal_sensor : ThermalSensorModel();
  }
};

TEST_F(RadiometricToolTest, WhatIsWrongWithReadingsIsFoundBeforeBlackBodies) {
  LookThrough("small.mcap", 0.017, 120.0);
  LookThrough("middle.mcap", 0.03, 120.0);
  LookThrough("large.mcap", 0.055, 120.0);
  LookThrough("larger.mcap", 0.08, 120.0);
  LookThrough("cool.mcap", 0.4, 40.0);
  LookThrough("warm.mcap", 0.4, 80.0);
  LookThrough("hot.mcap", 0.4, 160.0);
  Write(
      "bodies.csv",
      "# black body, images\n120, small.mcap\n120, middle.mcap\n120, large.mcap\n120, larger.mcap\n"
      "40, cool.mcap\n80, warm.mcap\n160, hot.mcap\n");
  const std::string calibrate =
      "calibrate radiometric bodies.csv --rig rig.textproto --emissivity 0.95 --reflected 23 ";
  const Outcome told = Run(calibrate);
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(HasSubstr("a line"), HasSubstr("nothing is written")));
  EXPECT_TRUE(Sensor("rig.textproto").radiometric_correction.empty());

  RunWell(calibrate + "--calibrator-sigma 0.1 --apply --json found.json --html found.html");
  EXPECT_TRUE(fs::exists(folder_ / "rig.textproto.bak"));
  const ThermalSensorModel sensor = Sensor("rig.textproto");
  EXPECT_NEAR(sensor.scene_influence.near_fraction, 0.0387, 0.003) << told.out;
  EXPECT_NEAR(sensor.scene_influence.near_sigma_px, 20.0, 3.0);
  EXPECT_NEAR(sensor.scene_influence.total_fraction, 0.0387, 0.003);
  for (const double apparent : {40.0, 70.0, 110.0, 150.0}) {
    const double reading = kOffset_k + (1.0 + kGain) * apparent;
    EXPECT_NEAR(reading + sensor.radiometric_correction.At(reading), apparent, 0.15);
    EXPECT_GT(sensor.radiometric_correction.SigmaAt(reading), 0.1);
    EXPECT_LT(sensor.radiometric_correction.SigmaAt(reading), 0.3);
  }
  const auto json = nlohmann::json::parse(std::ifstream(folder_ / "found.json"));
  EXPECT_TRUE(json["scene_influence"]["known"]);
  EXPECT_LT(json["scene_influence"]["apart_after_k"], 0.3);
  EXPECT_GT(json["scene_influence"]["apart_before_k"], 1.5);

  std::ostringstream html;
  html << std::ifstream(folder_ / "found.html").rdbuf();
  EXPECT_THAT(html.str(), AllOf(HasSubstr("as measured"), HasSubstr("The black body at 120 °C"),
                                HasSubstr("a line")));
  // A row each, and the curve's.
  EXPECT_EQ(Count(html.str(), "r=\"3.5\""), 7 + 2 * 4);
  EXPECT_EQ(Count(html.str(), "nan"), 0);

  RunWell("simulate -o again.mcap --duration 1 --set rig_file=rig.textproto --scene plane");
  EXPECT_THAT(Run("inspect again.mcap").out, HasSubstr("readings corrected by"));
}

TEST_F(RadiometricToolTest, TheDriftOfTheHousingIsFoundWhileItWarmsUp) {
  RunWell(
      "simulate -o warm-up.mcap --duration 100 --scene plane --set rig_file=rig.textproto "
      "--set thermal.rate_hz=5 --set depth.rate_hz=1 --set ideal_cameras=false "
      "--set drift.warm_up_k=3 --set drift.time_constant_s=60 --set drift.error_per_kelvin=-3.5 "
      "--set shutter.first_s=20 --set shutter.interval_s=20");
  const Outcome told =
      Run("calibrate radiometric --warm-up warm-up.mcap --rig rig.textproto --apply");
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("in 5 parts between NUCs"));
  const auto drift = Sensor("rig.textproto").housing_drift;
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->error_per_kelvin, -3.5, 0.05);
  EXPECT_LT(drift->sigma, 0.05);
}

TEST_F(RadiometricToolTest, WhatCannotBeIsSaidInASentence) {
  const auto refuses = [&](const std::string& table, const std::string& arguments,
                           const std::string& why) {
    Write("bodies.csv", table);
    const Outcome outcome = Run("calibrate radiometric " + arguments);
    EXPECT_NE(outcome.status, 0) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << outcome.out;
  };
  refuses("20, 20\n", "", "name a table of black bodies");
  refuses("20, 20\n", "nothing.csv", "nothing.csv");
  refuses("20\n", "bodies.csv", "bodies.csv:1");
  refuses("20, nothing.mcap\n", "bodies.csv", "nothing.mcap");
  refuses("20, 20\n300, 20\n", "bodies.csv", "bodies.csv:2: the camera should read 300.0");
  refuses("20, 20\n", "bodies.csv --emissivity 0", "--emissivity");
  refuses("20, 20\n", "bodies.csv --calibrator-sigma -1", "--calibrator-sigma");
  refuses("20, 20\n", "bodies.csv -o new.textproto", "name the one to change, --rig");
  // It moves before the wall.
  RunWell(
      "simulate -o moving.mcap --duration 3 --scene corner-sphere --set rig_file=rig.textproto "
      "--set thermal.rate_hz=20");
  refuses("80, moving.mcap\n", "bodies.csv", "the camera has to rest");
  refuses("", "--warm-up moving.mcap", "from switching it on");
  EXPECT_FALSE(fs::exists(folder_ / "new.textproto"));
}

}  // namespace
}  // namespace isotherm::testing
