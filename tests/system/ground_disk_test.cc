// The ground and its disk: stuck, slow; results that take long; a rig that dies. Edge and
// ground as two processes over DDS on loopback.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include "common/testing/temporary_directory.h"
#include "tests/support/departure.h"
#include "tests/support/machine_load.h"
#include "tests/support/programs.h"
#include "tests/system/ground_disk.h"

namespace isotherm::system_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

/// Waits for a file that another process makes.
bool WaitForFile(const std::filesystem::path& path, Seconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!std::filesystem::exists(path)) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Holds what the ground's log says of the scans that it began.
struct Scan {
  std::uint64_t session = 0;
  std::filesystem::path folder;
};
std::vector<Scan> ScansIn(const std::string& log) {
  const std::string before_session = "scan started, session=";
  const std::string before_folder = " results=";
  std::vector<Scan> scans;
  for (std::size_t at = log.find(before_session); at != std::string::npos;
       at = log.find(before_session, at + 1)) {
    const std::size_t session = at + before_session.size();
    const std::size_t folder = log.find(before_folder, session) + before_folder.size();
    scans.push_back(
        {std::stoull(log.substr(session)), log.substr(folder, log.find('\n', folder) - folder)});
  }
  return scans;
}

TEST_F(GroundDiskTest, F42AStuckRecordingCostsTheRecordingOnly) {
  PutPipeInPlaceOfTheRecording();
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  // More frames than may wait for the disk.
  const Finished edge = RunToEnd(Edge(5), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_EQ(ground.WaitForExit(kPatience), kDiskStuck) << ground.output();
  EXPECT_THAT(ground.output(), HasSubstr("the disk does not take the recording fast enough"));
  EXPECT_THAT(ground.output(), HasSubstr("the disk is stuck: the recording is not complete"));
  EXPECT_THAT(ground.output(), HasSubstr("frames are not in the recording"));
  const auto stats = ReadStats(Path("ground"));
  ExpectWholeCounters(stats, "depth");
  ExpectWholeCounters(stats, "thermal");
  EXPECT_GT(NumberAt(stats, {"link", "depth", "not_recorded_by_reason", "disk_too_slow"}), 0);
  EXPECT_GT(NumberAt(stats, {"frames", "depth", "tracked"}), 100);
  EXPECT_TRUE(std::filesystem::exists(Path("ground/cloud.ply")));
  EXPECT_TRUE(std::filesystem::exists(Path("ground/model.iso")));
  if (HasFailure()) std::cout << "edge:\n" << edge.output << "ground:\n" << ground.output();
}

/// And before the calibration has been checked.
TEST_F(GroundDiskTest, F38SigtermEndsTheGroundWhileItsRecordingIsStuck) {
  PutPipeInPlaceOfTheRecording();
  Process ground(Ground({"--once", "--set", "calibration_check.expert.enabled=true"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(EndlessEdge());
  ASSERT_TRUE(edge.WaitForOutput("tracked", kPatience)) << edge.output() << ground.output();
  const Departure departure = Leave(ground, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, kDiskStuck) << ground.output();
  constexpr Seconds kForTheRecording{1.5};  // Longer it does not wait for one that does not close.
  EXPECT_LT(departure.own(), kTimeToLeave + kForTheRecording)
      << departure.ToText() << ground.output();
  EXPECT_THAT(ground.output(), HasSubstr("the disk is stuck: the recording is not complete"));
  EXPECT_TRUE(std::filesystem::exists(Path("ground/cloud.ply"))) << ground.output();
}

/// As when the results of a long scan take longer than the service manager waits.
TEST_F(GroundDiskTest, F38WhileResultsAreWrittenTheServiceManagerIsAskedForMoreTime) {
  const std::filesystem::path stuck = Path("stuck");
  std::ofstream(stuck).put('\n');
  NotifySocket manager(folder_.path());
  Command command = Ground();
  command.environment = {manager.environment(), "LD_PRELOAD=" STUCK_DISK,
                         "STUCK_DISK_NAME=cloud.ply", "STUCK_DISK_WHILE=" + stuck.string()};
  Process ground(command);
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const Finished edge = RunToEnd(Edge(1), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  ASSERT_TRUE(WaitForFile(stuck.string() + ".reached", kPatience)) << ground.output();
  manager.Forget();
  ground.Signal(SIGTERM);
  ASSERT_TRUE(manager.WaitFor("STOPPING=1", kPatience)) << ground.output();
  // Ten seconds more each time, long before the last ones are over.
  constexpr const char* kMore = "EXTEND_TIMEOUT_USEC=10000000";
  EXPECT_LT(manager.LongestSilence(kMore, Seconds(12)).count(), 5.0) << ground.output();
  EXPECT_EQ(ground.WaitForExit(Seconds(0)), std::nullopt) << "it has not given up";
  std::filesystem::remove(stuck);
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  while (!ground.HasEnded(Seconds(0.02)) && std::chrono::steady_clock::now() < limit)
    manager.Drain();  // A manager that does not listen holds the service up.
  EXPECT_EQ(ground.WaitForExit(Seconds(0)), 0) << ground.output();
  ASSERT_EQ(ScansIn(ground.output()).size(), 1U) << ground.output();
  EXPECT_TRUE(std::filesystem::exists(ScansIn(ground.output())[0].folder / "stats.json"));
}

TEST_F(GroundDiskTest, F39TheWatchdogIsNotFedAnyMoreWhenTheDiskIsStuckForLong) {
  PutPipeInPlaceOfTheRecording();
  const TemporaryDirectory folder;
  NotifySocket manager(folder.path());
  Command command = Ground({"--once"});
  command.environment = {manager.environment(), "WATCHDOG_USEC=500000"};
  Process ground(command);
  ASSERT_TRUE(manager.WaitFor("READY=1", kPatience)) << ground.output();
  ASSERT_TRUE(manager.WaitFor("WATCHDOG=1", kPatience)) << ground.output();
  Process edge(EndlessEdge());
  ASSERT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output() << edge.output();
  manager.Forget();
  EXPECT_TRUE(manager.WaitFor("WATCHDOG=1", kPatience)) << "a disk may be slow for a while";
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (
      !ground.WaitForOutput("the recording (is the disk stuck?) has not gone on", Seconds(0.1))) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << ground.output();
    manager.Forget();  // A manager that does not listen holds the service up.
  }
  manager.Forget();
  EXPECT_FALSE(manager.WaitFor("WATCHDOG=1", Seconds(3))) << "fed six times as often before";
  EXPECT_THAT(manager.received(), ContainsRegex("STATUS=STUCK: the recording")) << "and it is said";
}

/// "0": as fast as the ground takes it; "1": as a camera would, which waits for nobody.
class NextScanTest : public GroundDiskTest, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rates, NextScanTest, ::testing::Values("0", "1"), [](const auto& test) {
  return std::string(test.param) == "1" ? "OfACamera" : "OfTheGround";
});

/// The second scan arrives while the first one's results cannot be written.
TEST_P(NextScanTest, ANewScanLosesNothingWhileResultsAreWritten) {
  const MachineLoad load;
  const std::filesystem::path stuck = Path("stuck");
  std::ofstream(stuck).put('\n');
  Command command = Ground();
  command.environment = {"LD_PRELOAD=" STUCK_DISK, "STUCK_DISK_NAME=cloud.ply",
                         "STUCK_DISK_WHILE=" + stuck.string()};
  Process ground(command);
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const Finished first = RunToEnd(Edge(1), kPatience);
  EXPECT_EQ(first.status, 0) << first.output;
  ASSERT_TRUE(WaitForFile(stuck.string() + ".reached", kPatience)) << ground.output();
  const Finished second = RunToEnd(Edge(1, GetParam()), kPatience);
  EXPECT_EQ(second.status, 0) << second.output;
  EXPECT_TRUE(ground.WaitForOutput("scan ended", kPatience, 2)) << ground.output();
  const FrameCountersText sent = CountersOf(second.output, Sensor::kDepth, "published");
  EXPECT_LE(static_cast<double>(sent.captured - sent.done),
            load.excused_fraction() * static_cast<double>(sent.captured))
      << "what the rig's queue dropped; " << load.ToText() << second.output;
  EXPECT_THAT(second.output, Not(HasSubstr("publishing without")));
  std::filesystem::remove(stuck);
  EXPECT_TRUE(ground.WaitForOutput("results  ", kPatience, 2)) << ground.output();
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  const std::vector<Scan> scans = ScansIn(ground.output());
  ASSERT_EQ(scans.size(), 2U) << ground.output();
  for (const Scan& scan : scans) {
    const auto stats = ReadStats(scan.folder);
    ExpectWholeCounters(stats, "depth");
    ExpectWholeCounters(stats, "thermal");
    EXPECT_EQ(NumberAt(stats, {"link", "session"}), static_cast<double>(scan.session));
    EXPECT_TRUE(ReadRecording(scan.folder / "scan.mcap").complete);
  }
  if (HasFailure()) std::cout << "edge:\n" << second.output << "ground:\n" << ground.output();
}

TEST_F(GroundDiskTest, F33TheScanOfAKilledEdgeHasItsOwnCounters) {
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  {
    Process killed(EndlessEdge());
    ASSERT_TRUE(killed.WaitForOutput("tracked", kPatience)) << killed.output() << ground.output();
    killed.Signal(SIGKILL);
    EXPECT_EQ(killed.WaitForExit(kPatience), 128 + SIGKILL);
  }
  const Finished again = RunToEnd(Edge(1), kPatience);
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_TRUE(ground.WaitForOutput("results  ", kPatience, 2)) << ground.output();
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  const std::vector<Scan> scans = ScansIn(ground.output());
  ASSERT_EQ(scans.size(), 2U) << ground.output();
  ASSERT_NE(scans[0].session, scans[1].session);
  for (const Scan& scan : scans) {
    const auto stats = ReadStats(scan.folder);
    EXPECT_EQ(NumberAt(stats, {"link", "session"}), static_cast<double>(scan.session));
    const RecordingContent recording = ReadRecording(scan.folder / "scan.mcap");
    for (const char* sensor : {"depth", "thermal"}) {
      const auto count = [&](const char* what) { return NumberAt(stats, {"link", sensor, what}); };
      const auto& frames = sensor == std::string("depth") ? recording.depth : recording.thermal;
      EXPECT_GT(count("received"), 0) << sensor;
      EXPECT_EQ(count("published"), count("received") + count("missing")) << sensor;
      EXPECT_EQ(count("received"), static_cast<double>(frames.size())) << sensor;
      EXPECT_EQ(count("recorded"), count("received")) << sensor;
      EXPECT_EQ(NumberAt(stats, {"frames", sensor, "in"}), count("received")) << sensor;
    }
    const bool last_word =
        stats.fields().at("link").struct_value().fields().at("final").bool_value();
    EXPECT_EQ(last_word, scan.session == scans[1].session);
  }
  EXPECT_THAT(ground.output(), HasSubstr("the rig had not said its last word"));
  if (HasFailure()) std::cout << "ground:\n" << ground.output();
}

}  // namespace
}  // namespace isotherm::system_test
