// `isotherm calibrate refine` and `isotherm calibrate check`, as a user runs them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <variant>

#include "common/options/text_proto.h"
#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "tests/support/tool.h"

namespace isotherm::testing {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Puts a rig's thermal camera elsewhere: a turn of one degree, 8 mm, 20 ms, 6 px; and forgets what
/// other pixels add to each one.
Rig Disturbed(const Rig& right, const Eigen::Vector3d& turn_about, const Eigen::Vector3d& towards,
              double delay_s, const Eigen::Vector2d& principal_px) {
  Rig rig = right;
  rig.T_thermal_depth->linear() =
      Eigen::AngleAxisd(kDegree, turn_about.normalized()).toRotationMatrix() *
      right.T_thermal_depth->linear();
  rig.T_thermal_depth->translation() += 0.008 * towards.normalized();
  rig.thermal_delay_s += delay_s;
  rig.thermal->cx += principal_px.x();
  rig.thermal->cy += principal_px.y();
  rig.thermal_sensor.scene_influence = {};
  return rig;
}

Rig TurnedBy(const Rig& right, double angle_deg, const Eigen::Vector3d& about) {
  Rig rig = right;
  rig.T_thermal_depth->linear() =
      Eigen::AngleAxisd(kDegree * angle_deg, about.normalized()).toRotationMatrix() *
      right.T_thermal_depth->linear();
  return rig;
}

class RefineToolTest : public ToolRun {
 protected:
  Rig Recorded(const std::string& name) const {
    auto reader = RecordingReader::Open(folder_ / name);
    EXPECT_TRUE(reader) << reader.error().message();
    return (*reader)->ReadRig().value();
  }

  void WriteRig(const std::string& name, const Rig& rig) const { Write(name, ToText(rig)); }

  /// A copy without the depth frames of 0.4 s of each second but the first.
  void CopyWithGaps(const std::string& from, const std::string& to) const {
    Copy(from, to, "", [](double at_s) { return at_s > 1.0 && at_s - std::floor(at_s) > 0.6; });
  }

  /// A copy of a camera with a serial number, without the depth frames that `is_missing` by
  /// seconds.
  void Copy(const std::string& from, const std::string& to, const std::string& thermal_serial,
            const std::function<bool(double)>& is_missing) const {
    auto reader = RecordingReader::Open(folder_ / from);
    ASSERT_TRUE(reader) << reader.error().message();
    auto writer = RecordingWriter::Create(folder_ / to, {});
    ASSERT_TRUE(writer) << writer.error().message();
    Rig rig = (*reader)->ReadRig().value();
    rig.thermal_serial = thermal_serial;
    ASSERT_TRUE((*writer)->Write(rig).ok());
    std::optional<CaptureTime> start;
    while (true) {
      auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) break;
      if (const auto* depth = std::get_if<RecordedDepth>(&**item)) {
        const CaptureTime time = depth->frame.header.capture_time;
        if (!start) start = time;
        if (is_missing && is_missing(ToSeconds(time - *start))) continue;
        ASSERT_TRUE((*writer)->Write(depth->frame, depth->arrival).ok());
      }
      if (const auto* thermal = std::get_if<RecordedThermal>(&**item)) {
        ASSERT_TRUE((*writer)->Write(thermal->frame, thermal->arrival).ok());
      }
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }

  /// Defocus of the simulated lens turns it by a tenth of a degree more, with half a pixel of the
  /// principal point that takes it back.
  void ExpectNear(const Rig& found, const Rig& right, double max_turn_deg) const {
    const double turned_deg =
        RotationAngle(*found.T_thermal_depth, *right.T_thermal_depth) / kDegree;
    const double moved_m = TranslationDistance(*found.T_thermal_depth, *right.T_thermal_depth);
    const double delay_s = found.thermal_delay_s - right.thermal_delay_s;
    const double principal_px =
        std::hypot(found.thermal->cx - right.thermal->cx, found.thermal->cy - right.thermal->cy);
    std::printf("off by %.3f degrees, %.2f mm, %+.2f ms, %.2f px\n", turned_deg, 1e3 * moved_m,
                1e3 * delay_s, principal_px);
    EXPECT_LT(turned_deg, max_turn_deg);
    EXPECT_LT(moved_m, 0.001);
    EXPECT_LT(std::abs(delay_s), 0.001);
    EXPECT_LT(principal_px, 1.0);
    const SceneInfluence &a = found.thermal_sensor.scene_influence,
                         &b = right.thermal_sensor.scene_influence;
    std::printf("influence %.4f and %.4f of %.4f and %.4f\n", a.near_fraction, a.total_fraction,
                b.near_fraction, b.total_fraction);
    EXPECT_NEAR(a.near_fraction, b.near_fraction, 0.003);
    EXPECT_NEAR(a.total_fraction, b.total_fraction, 0.003);
  }
};

TEST_F(RefineToolTest, WhatWasDisturbedIsFoundAgain) {
  RunWell("simulate -o scan.mcap --duration 10 --seed 5 --set ideal_cameras=false");
  const Rig right = Recorded("scan.mcap");
  ASSERT_GT(right.thermal_sensor.scene_influence.near_fraction, 0.03);
  WriteRig("rig.textproto",
           Disturbed(right, {1.0, -2.0, 1.0}, {-1.0, 1.0, 1.0}, 0.02, {4.0, -4.5}));
  const std::string before = ReadAll(folder_ / "rig.textproto");
  const Outcome proposed = Run(
      "calibrate refine scan.mcap --rig rig.textproto -o new.textproto --render both.png --json "
      "all.json");
  ASSERT_EQ(proposed.status, 0) << proposed.err;
  EXPECT_THAT(proposed.out, AllOf(HasSubstr("translation z"), HasSubstr("uncertain by"),
                                  HasSubstr("new.textproto: written")));
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto"), before);
  ExpectNear(LoadRigCalibration(folder_ / "new.textproto").value(), right, 0.2);
  EXPECT_THAT(ReadAll(folder_ / "new.textproto"),
              HasSubstr("rx ry rz tx ty tz delay cx cy near total"));
  EXPECT_EQ(ReadAll(folder_ / "both.png").substr(1, 3), "PNG");
  const nlohmann::json all = nlohmann::json::parse(ReadAll(folder_ / "all.json"));
  EXPECT_EQ(all["pose"], "moved");
  EXPECT_EQ(all["influence"], "moved");
  EXPECT_EQ(all["values"].size(), 11U);
  EXPECT_EQ(all["covariance"].size(), 11U);
  EXPECT_LT(all["held_out_after_k"].get<double>(), all["held_out_before_k"].get<double>());

  // How the lenses were found is kept.
  RigCalibration proto = ToProto(right);
  proto.mutable_thermal_calibration()->set_target("thesis-board");
  proto.mutable_thermal()->set_cx(right.thermal->cx + 3.0);
  Write("lens.textproto", "# Mine.\n" + ToTextProto(proto));
  const Outcome applied = Run("calibrate refine scan.mcap --rig lens.textproto --apply");
  EXPECT_EQ(applied.status, 0) << applied.err;
  EXPECT_THAT(ReadAll(folder_ / "lens.textproto"), HasSubstr("thesis-board"));
  EXPECT_THAT(ReadAll(folder_ / "lens.textproto.bak"), ::testing::StartsWith("# Mine."));

  // What agrees is not written again.
  const Outcome again = Run("calibrate refine scan.mcap --rig new.textproto --apply");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("nothing to write"));
  EXPECT_FALSE(fs::exists(folder_ / "new.textproto.bak"));
}

TEST_F(RefineToolTest, CheckFindsLittleAndIsNotAlarmedByGaps) {
  RunWell("simulate -o scan.mcap --duration 10 --seed 6 --set ideal_cameras=false");
  const Rig right = Recorded("scan.mcap");
  CopyWithGaps("scan.mcap", "gaps.mcap");
  const Outcome gaps = Run("calibrate check gaps.mcap");
  EXPECT_TRUE(gaps.status == 0 || gaps.status == 2) << gaps.out << gaps.err;
  EXPECT_THAT(gaps.out, AllOf(HasSubstr("pose"), HasSubstr("delay"), Not(HasSubstr("moved"))));

  Rig moved = TurnedBy(right, 0.2, {1.0, 1.0, 0.5});
  moved.thermal_delay_s += 0.005;
  WriteRig("moved.textproto", moved);
  const Outcome check = Run("calibrate check scan.mcap --rig moved.textproto");
  EXPECT_EQ(check.status, 1) << check.err;
  EXPECT_THAT(check.out, AllOf(HasSubstr("pose      moved by"), HasSubstr("delay     moved by"),
                               HasSubstr("depth     ok, the same surface looks the same"),
                               HasSubstr("calibrate refine scan.mcap")));
}

TEST_F(RefineToolTest, WhatCannotBeToldIsSaid) {
  RunWell("simulate -o still.mcap --duration 4 --scene plane");
  EXPECT_EQ(Run("calibrate check still.mcap").status, 2);
  const Outcome still = Run("calibrate refine still.mcap -o never.textproto");
  EXPECT_EQ(still.status, kData);
  EXPECT_THAT(still.err,
              AllOf(HasSubstr("still.mcap"), HasSubstr("scan something with more shape")));
  Rig other = Recorded("still.mcap");
  other.thermal->width = 160;
  other.thermal->cx = 80.0;
  WriteRig("other.textproto", other);
  const Outcome size = Run("calibrate check still.mcap --rig other.textproto");
  EXPECT_NE(size.status, 0);
  EXPECT_THAT(size.err, AllOf(HasSubstr("160 x 288"), HasSubstr("382 x 288")));
  Rig another = Recorded("still.mcap");
  another.thermal_serial = "T 2";
  WriteRig("another.textproto", another);
  Copy("still.mcap", "named.mcap", "T 1", {});
  const Outcome serial = Run("calibrate refine named.mcap --rig another.textproto --apply");
  EXPECT_EQ(serial.status, kData);
  EXPECT_THAT(serial.err, AllOf(HasSubstr("T 1"), HasSubstr("T 2")));
  EXPECT_EQ(Run("calibrate refine still.mcap --apply").status, kUsage);
  EXPECT_EQ(Run("calibrate refine still.mcap --prior-rotation -1").status, kUsage);
  EXPECT_EQ(Run("calibrate refine nowhere.mcap").status, kNoInput);
  EXPECT_FALSE(fs::exists(folder_ / "never.textproto"));
}

// Rendered by others.
TEST_F(RefineToolTest, DisturbedRigOfRecordedDataIsFoundAgain) {
  const char* set = std::getenv("ISOTHERM_DATA_DIR");
  const fs::path data =
      fs::path(set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data") / "furnace_dev";
  if (!fs::exists(data)) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  ASSERT_EQ(Run("import --from tum '" + data.string() + "' -o scan.mcap").status, 0);
  const Rig right = Recorded("scan.mcap");
  WriteRig("rig.textproto",
           Disturbed(right, {0.2, 1.0, -0.4}, {1.0, 0.5, -1.0}, -0.02, {-5.0, 3.3}));
  const std::string before = ReadAll(folder_ / "rig.textproto");
  const Outcome refined = Run("calibrate refine scan.mcap --rig rig.textproto --apply");
  ASSERT_EQ(refined.status, 0) << refined.err;
  ExpectNear(LoadRigCalibration(folder_ / "rig.textproto").value(), right, 0.1);
  EXPECT_EQ(ReadAll(folder_ / "rig.textproto.bak"), before);
}

}  // namespace
}  // namespace isotherm::testing
