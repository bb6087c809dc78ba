// `isotherm calibrate time` and the check of the calibration after a scan, as a user runs them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

// The calibration is asked for this accuracy at real cameras' resolution.
constexpr double kTolerance_s = 0.001;
// Small cameras in a coarse model come out 1.1 to 1.4 ms late; presumably tracked poses lag.
constexpr double kSmallCameraTolerance_s = 0.002;

constexpr const char* kRig = R"(# Of a simulated rig.
depth { width: 256 height: 192 fx: 227 fy: 227 cx: 128.4 cy: 96.9 }
thermal { width: 191 height: 144 fx: 185.7 fy: 186 cx: 102.5 cy: 75 k1: -0.44 k2: 0.29 p1: 0.0004 k3: -0.11 }
depth_scale: 4000
T_thermal_depth { tx: 0.05 ty: 0.01 tz: 0.002 qx: -0.00436 qy: 0.00349 qz: -0.000857 qw: 0.999984 }
thermal_delay_s: -0.02
serial: "A 17" date: "2026-01-02" method: "mask" reprojection_error_px: 0.21
)";

/// The number behind `"key": ` in JSON text.
double Number(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\": ");
  return at == std::string::npos ? NAN : std::strtod(json.c_str() + at + key.size() + 4, nullptr);
}

class CalibrateToolTest : public ToolRun {
 protected:
  // scan.mcap, whose stamps are the true exposures.
  void Simulate(const std::string& more = "--scene furnace-door --duration 12") {
    Write("rig.textproto", kRig);
    RunWell(
        "simulate -o scan.mcap --set rig_file=rig.textproto "
        "--set depth.expert.depth_scale=4000 --set depth.expert.disparity_noise_px=0.03 "
        "--set depth.expert.disparity_step_px=0.03125 --set thermal.rate_hz=20 " +
        more);
  }

  // A copy of scan.mcap as another program would have made it, by its metadata.
  void Copy(const std::string& name, Nanoseconds thermal_late, bool depth, bool thermal,
            const std::map<std::string, std::map<std::string, std::string>>& metadata = {}) const {
    auto reader = RecordingReader::Open(folder_ / "scan.mcap");
    ASSERT_TRUE(reader) << reader.error().message();
    auto writer = RecordingWriter::Create(folder_ / name, {});
    ASSERT_TRUE(writer) << writer.error().message();
    ASSERT_TRUE((*writer)->Write((*reader)->ReadRig().value()).ok());
    for (const auto& [key, values] : metadata)
      ASSERT_TRUE((*writer)->WriteMetadata(key, values).ok());
    while (true) {
      auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) break;
      if (auto* frame = std::get_if<RecordedDepth>(&**item); frame != nullptr && depth) {
        ASSERT_TRUE((*writer)->Write(frame->frame, frame->arrival).ok());
      }
      if (auto* frame = std::get_if<RecordedThermal>(&**item); frame != nullptr && thermal) {
        frame->frame.header.capture_time += thermal_late;
        ASSERT_TRUE((*writer)->Write(frame->frame, frame->arrival).ok());
      }
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }

  Outcome Calibrate(const std::string& arguments) const {
    return Run("calibrate time " + arguments +
               " --set volume.voxel_size_m=0.004 --set tsdf.expert.truncation_distance_m=0.016");
  }

  Rig Load(const std::string& name) const {
    const auto rig = LoadRigCalibration(folder_ / name);
    EXPECT_TRUE(rig) << rig.error().message();
    return rig.value_or(Rig());
  }

  void Refused(const std::string& recording, const std::string& says,
               const std::string& more = "") const {
    const Outcome outcome = Calibrate(recording + " --output never.textproto " + more);
    EXPECT_EQ(outcome.status, kData) << recording;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(recording), HasSubstr(says)));
    EXPECT_FALSE(fs::exists(folder_ / "never.textproto"));
  }
};

void ExpectSameButDelay(const Rig& a, const Rig& b) {
  Rig same = b;
  same.thermal_delay_s = a.thermal_delay_s;
  EXPECT_EQ(ToText(a), ToText(same));
}

TEST_F(CalibrateToolTest, TheDelayIsWrittenIntoTheRigFileAndNothingElseIsChanged) {
  Simulate();
  constexpr double kLate_s = 0.0313;
  Copy("late.mcap", FromSeconds(kLate_s), true, true);
  const Outcome outcome = Calibrate("late.mcap --rig rig.textproto --output new.textproto");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("thermal_delay_s: -0.03"), HasSubstr("uncertain by"),
                    HasSubstr("before: -20.0 ms"), HasSubstr("new.textproto: written")));
  EXPECT_NEAR(Load("new.textproto").thermal_delay_s, -kLate_s, kSmallCameraTolerance_s);
  ExpectSameButDelay(Load("rig.textproto"), Load("new.textproto"));
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto"), kRig);

  EXPECT_THAT(ReadAll(folder_ / "new.textproto"), ::testing::StartsWith("# Of a simulated rig.\n"));

  // The file itself is changed only when asked for, in one number, and kept as it was.
  const Outcome told = Calibrate("late.mcap --rig rig.textproto");
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("rig.textproto is not changed: --apply"));
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto"), kRig);
  ASSERT_EQ(Calibrate("late.mcap --rig rig.textproto --apply").status, 0);
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto"), ReadAll(folder_ / "new.textproto"));
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto.bak"), kRig);

  // What agrees is not written again.
  const Outcome agrees = Calibrate("late.mcap --rig rig.textproto --apply");
  EXPECT_EQ(agrees.status, 0) << agrees.err;
  EXPECT_THAT(agrees.out, HasSubstr("agrees with the calibration"));
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto.bak"), kRig);
  EXPECT_EQ(Calibrate("late.mcap --apply").status, kUsage);
  const Outcome only = Calibrate("late.mcap");
  EXPECT_EQ(only.status, 0) << only.err;
  EXPECT_THAT(only.out, Not(HasSubstr("written")));
}

// What an edge added to the stamps is part of the delay; what the ground records says nothing of
// it.
TEST_F(CalibrateToolTest, WhatTheStampsContainAlreadyIsCounted) {
  Simulate();
  constexpr double kLeft_s = 0.012;
  Copy("edge.mcap", FromSeconds(kLeft_s), true, true, {{"timing", {{"thermal_delay_s", "-0.02"}}}});
  const Outcome edge = Calibrate("edge.mcap --output new.textproto");
  ASSERT_EQ(edge.status, 0) << edge.err;
  EXPECT_THAT(edge.out, HasSubstr("-20.0 ms were in the recording's stamps already"));
  EXPECT_NEAR(Load("new.textproto").thermal_delay_s, -0.02 - kLeft_s, kSmallCameraTolerance_s);

  Copy("ground.mcap", FromSeconds(kLeft_s), true, true,
       {{"configuration", {{"program", "isotherm-ground"}}}});
  Refused("ground.mcap", "made by the ground");
  const Outcome ground =
      Calibrate("ground.mcap --rig rig.textproto --output from_ground.textproto");
  ASSERT_EQ(ground.status, 0) << ground.err;
  EXPECT_NEAR(Load("from_ground.textproto").thermal_delay_s, -0.02 - kLeft_s,
              kSmallCameraTolerance_s);
}

TEST_F(CalibrateToolTest, WhatIsMissingIsSaid) {
  Simulate("--scene furnace-door --duration 6");
  Refused("scan.mcap", "uncertain by", "--max-sigma 0.0001");
  Copy("depth.mcap", Nanoseconds(0), true, false);
  Refused("depth.mcap", "0 thermal frames, 40 are needed");
  Copy("thermal.mcap", Nanoseconds(0), false, true);
  Refused("thermal.mcap", "no depth frames");
  EXPECT_EQ(Calibrate("scan.mcap --range 5").status, kUsage);
  EXPECT_EQ(Calibrate("nowhere.mcap").status, 66);
}

TEST_F(CalibrateToolTest, ARigThatStandsStillIsRefused) {
  Simulate("--duration 4 --scene plane");
  Refused("scan.mcap", "the rig hardly moves");
}

// Rendered by others: 300 depth and 399 thermal frames, stamps late by 42.7 ms with 1 ms jitter.
TEST_F(CalibrateToolTest, TheDelayOfRecordedDataIsFoundAndThenAgrees) {
  constexpr double kTrue_s = -0.0427;
  const char* set = std::getenv("ISOTHERM_DATA_DIR");
  const fs::path data =
      fs::path(set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data") / "furnace_dev";
  if (!fs::exists(data)) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  const std::string import =
      "import --from tum '" + data.string() + "' --thermal-list thermal_delayed.txt ";
  ASSERT_EQ(Run(import + "-o late.mcap").status, 0);
  const Outcome calibrate = Run("calibrate time late.mcap --output rig.textproto");
  ASSERT_EQ(calibrate.status, 0) << calibrate.err;
  std::puts(calibrate.out.c_str());
  EXPECT_NEAR(Load("rig.textproto").thermal_delay_s, kTrue_s, kTolerance_s);

  const auto reconstruct = [this](const std::string& recording) {
    return Run("reconstruct " + recording + " -o " + recording + ".out --voxel 0.003 " +
               "--set tsdf.expert.truncation_distance_m=0.012");
  };
  const Outcome moved = reconstruct("late.mcap");
  ASSERT_EQ(moved.status, 0) << moved.err;
  EXPECT_THAT(moved.err, HasSubstr("not as it was calibrated (delay moved by -4"));
  EXPECT_THAT(moved.out, HasSubstr("isotherm calibrate refine"));
  const std::string stats = ReadAll(folder_ / "late.mcap.out" / "stats.json");
  EXPECT_EQ(nlohmann::json::parse(stats)["calibration_check"]["verdict"], "moved");
  EXPECT_EQ(Number(stats, "calibrated_ms"), 0.0);
  EXPECT_NEAR(Number(stats, "estimated_ms"), 1e3 * kTrue_s, 1e3 * kTolerance_s);
  EXPECT_LT(Number(stats, "sigma_ms"), 5.0) << "a delay that is right would not be assessed";

  ASSERT_EQ(
      Run(import + "--rig '" + (folder_ / "rig.textproto").string() + "' -o right.mcap").status, 0);
  const Outcome right = reconstruct("right.mcap");
  ASSERT_EQ(right.status, 0) << right.err;
  EXPECT_THAT(right.err, Not(HasSubstr("not as it was calibrated")));
  const auto json = nlohmann::json::parse(ReadAll(folder_ / "right.mcap.out" / "stats.json"));
  EXPECT_EQ(json["calibration_check"]["verdict"], "agrees") << json["calibration_check"].dump();
}

TEST_F(CalibrateToolTest, WhatSwellsInTheDepthImageIsFoundFromAWallAndCorrected) {
  const std::string wall = "--duration 8 --scene flat-wall --set depth.expert.corner_swelling=0.02";
  Simulate(wall);
  const Outcome told = Run("calibrate depth-bias scan.mcap --rig rig.textproto");
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(HasSubstr("nothing is written"), HasSubstr("unevenness")));
  EXPECT_TRUE(Load("rig.textproto").depth_sensor.bias.empty());

  RunWell("calibrate depth-bias scan.mcap --rig rig.textproto --apply --json bias.json");
  const Rig rig = Load("rig.textproto");
  ASSERT_FALSE(rig.depth_sensor.bias.empty());
  EXPECT_EQ(rig.serial, "A 17") << "what else the file says stays";
  EXPECT_TRUE(fs::exists(folder_ / "rig.textproto.bak"));
  // The simulated camera's swelling, closed form.
  double before = 0.0, after = 0.0;
  for (int column = 0; column <= 10; ++column)
    for (int row = 0; row <= 10; ++row)
      for (const double distance_m : {0.5, 0.7, 0.9}) {
        const double x = 0.1 * column, y = 0.1 * row;
        // Of the corner's distance from the middle, squared; the image is 255 by 191 pixels.
        const double radius2 = (std::pow(255.0 * (x - 0.5), 2) + std::pow(191.0 * (y - 0.5), 2)) /
                               (0.25 * (255.0 * 255.0 + 191.0 * 191.0));
        const double swelling = 1.0 + 0.02 * radius2;
        before += std::pow(swelling - 1.0, 2);
        after += std::pow(swelling * rig.depth_sensor.bias.At(x, y, distance_m) - 1.0, 2);
      }
  EXPECT_LT(std::sqrt(after / before), 0.1);

  // Another scan of the wall, with the new calibration: there is nothing left.
  RunWell("simulate -o again.mcap --seed 5 --set rig_file=rig.textproto --set thermal.rate_hz=10 " +
          wall);
  EXPECT_THAT(Run("calibrate depth-bias again.mcap -o never.textproto").out,
              HasSubstr("nothing to write, never.textproto is not made"));
  EXPECT_THAT(Run("inspect again.mcap").out, HasSubstr("bias corrected by -2.0"));
  EXPECT_FALSE(fs::exists(folder_ / "never.textproto"));
}

TEST_F(CalibrateToolTest, WhatIsNoWallTellsNothingOfTheDepthCamera) {
  Simulate("--scene corner-sphere --duration 3");
  const Outcome outcome = Run("calibrate depth-bias scan.mcap --rig rig.textproto --apply");
  EXPECT_EQ(outcome.status, kData);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("scan.mcap"), HasSubstr("a flat wall fills the image"),
                                 HasSubstr("move slowly before a bare wall")));
  EXPECT_EQ(Run("calibrate depth-bias nothing.mcap").status, kNoInput);
}

}  // namespace
}  // namespace isotherm::testing
