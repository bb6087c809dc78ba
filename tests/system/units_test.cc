// The installed programs under the installed units, started by a real systemd.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#ifdef RECORDS_ONI
#include "common/testing/temporary_directory.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/openni/testing/record_oni.h"
#endif
#include "tests/system/units.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(UnitsScanTest, AScanBetweenTheTwoServices) {
  Prepare(20, Plays::kOnce);
  const Finished started = Run({"systemctl", "start", kGround, kEdge});
  ASSERT_EQ(started.status, 0) << started.output;
  ASSERT_TRUE(Until(kPatience, [&] { return JournalHas("the source has ended"); }));
  ExpectHealthy();
  for (const std::string& unit : {kEdge, kGround}) {
    EXPECT_EQ(Run({"systemctl", "stop", unit}).status, 0) << unit;
    EXPECT_EQ(Property(unit, "Result"), "success") << unit;
    EXPECT_EQ(Property(unit, "ExecMainStatus"), "0") << unit;
  }
  ExpectNoUnexplainedWarning();
  for (const char* file : {"scan.mcap", "cloud.ply", "mesh.ply", "model.iso", "trajectory.txt"}) {
    EXPECT_TRUE(std::filesystem::exists(OnlyScan() / file)) << file;
  }
  ExpectTheCountersBalance();
  ExpectReadableByTheGroupOnly();
}

TEST_F(UnitsScanTest, EachOfSeveralRigsHasAGroundOfItsOwn) {
  Prepare(2, Plays::kForEver);
  container_->Output("sed -i 's|edge_id: \"\"|edge_id: \"north-1\"|' /etc/isotherm/edge.textproto");
  Configure("ground-south.env", "ARGUMENTS=--set console.port=8085\n");
  const std::string north = "isotherm-ground@north-1.service",
                    south = "isotherm-ground@south.service";
  ASSERT_EQ(Run({"systemctl", "start", north, south, kEdge}).status, 0)
      << container_->Output("systemctl status " + north + ' ' + south);
  EXPECT_TRUE(Until(kPatience, [&] {
    return Property(north, "StatusText").find("tracked") != std::string::npos;
  })) << container_->Output("systemctl status " + north);
  for (const std::string& unit : {north, south}) {
    EXPECT_EQ(Property(unit, "ActiveState"), "active") << unit;
    EXPECT_EQ(Property(unit, "NRestarts"), "0") << unit;
    ExpectWatched(unit);
  }
  EXPECT_THAT(Property(south, "StatusText"), Not(HasSubstr("tracked"))) << "another's rig";
  EXPECT_THAT(container_->Output("journalctl --no-pager --quiet --output cat --unit " + south),
              HasSubstr("http://127.0.0.1:8085"));
  EXPECT_EQ(Run({"systemctl", "stop", kEdge, north, south}).status, 0);
  EXPECT_EQ(container_->Output("ls /var/lib/isotherm/ground-north-1/*/stats.json | wc -l"), "1");
  EXPECT_EQ(
      container_->Output("ls /var/lib/isotherm/ground-south/*/stats.json 2>/dev/null | wc -l"),
      "0");
}

#ifdef RECORDS_ONI
// The library of the camera locks itself in (system calls, files) under what the unit forbids
// already; a played file takes the same way as a camera.
TEST_F(UnitsTest, F14TheCamerasProcessConfinesItselfUnderTheUnitAndItsFramesArrive) {
  constexpr int kFrames = 40;
  const ::isotherm::testing::TemporaryDirectory folder;
  const FakeDepthCamera camera{};
  const Status recorded = RecordOni(folder.path() / "scan.oni", kFrames);
  ASSERT_TRUE(recorded.ok()) << recorded.message();
  std::filesystem::copy_file(folder.path() / "scan.oni", root() / "srv/scan.oni",
                             std::filesystem::copy_options::overwrite_existing);
  // The shipped configuration, but for the name of the camera.
  container_->Output(
      "chmod 0644 /srv/scan.oni; sed -i 's|kind: CAMERAS|& depth_camera { uri: "
      "\"/srv/scan.oni\" } thermal_camera { enabled: false }|' "
      "/etc/isotherm/edge.textproto");
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] { return JournalHas("is confined to its camera"); }));
  EXPECT_TRUE(Until(kPatience, [&] { return JournalHas("the source has ended"); }));
  EXPECT_EQ(Run({"systemctl", "stop", kEdge}).status, 0);
  EXPECT_EQ(Property(kEdge, "Result"), "success");
  const std::string journal = Journal("--identifier isotherm-edge") + '\n';
  EXPECT_THAT(journal, Not(HasSubstr("not confined")));
  const FrameCountersText counters = CountersOf(journal, Sensor::kDepth, "recorded");
  EXPECT_TRUE(counters.Closes()) << journal;
  EXPECT_GE(counters.done, kFrames) << journal;
}
#endif

TEST_F(UnitsTest, TheSandboxAllowsWhatIsNeededAndNoMore) {
  std::filesystem::copy_file(UNIT_PROBE, root() / "usr/bin/unit_probe",
                             std::filesystem::copy_options::overwrite_existing);
  container_->Output("touch /srv/camera; chown root:plugdev /srv/camera; chmod 0660 /srv/camera");
  const std::map<std::string, std::vector<std::string>> allowed = {
      {kEdge, {"reads-clock", "cameras", "landlock"}}, {kGround, {"reads-clock", "cameras"}}};
  for (const auto& [unit, words] : allowed) {
    since_ = Now();
    AddToUnit(unit, "Type=oneshot\nRestart=no\nExecStart=\nExecStart=/usr/bin/unit_probe\n");
    const Finished probed = Run({"systemctl", "start", unit});
    EXPECT_EQ(probed.status, 0) << probed.output;
    Run({"journalctl", "--sync"});
    EXPECT_EQ(LinesOf(Journal("--identifier unit_probe")), words) << unit;
  }
}

}  // namespace
}  // namespace isotherm::system_test
