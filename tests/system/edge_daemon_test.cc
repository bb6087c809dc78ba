// The built isotherm-edge as a process: starts, records, publishes, leaves.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "tests/support/departure.h"
#include "tests/support/process.h"
#include "tests/support/small_scan.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using system_test::Command;
using system_test::Departure;
using system_test::Finished;
using system_test::kTimeToLeave;
using system_test::Leave;
using system_test::NotifySocket;
using system_test::Process;
using system_test::RunToEnd;
using system_test::Seconds;
using testing::HasSubstr;

/// For things that take a fraction of it on an idle computer.
constexpr Seconds kPatience{60};
constexpr int kFrames = kSmallScanFrames;

struct Counts {
  bool complete = false;
  int depth = 0;
  int thermal = 0;
};

class EdgeDaemonTest : public testing::Test {
 protected:
  EdgeDaemonTest() {
    std::filesystem::create_directories(folder_);
    WriteSmallScan(scan_);
  }
  ~EdgeDaemonTest() override { std::filesystem::remove_all(folder_); }

  static Counts ReadRecording(const std::filesystem::path& path) {
    Counts counts;
    const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(path);
    EXPECT_TRUE(reader.has_value());
    if (!reader) return counts;
    counts.complete = (*reader)->info().complete;
    while (true) {
      const Result<std::optional<RecordedItem>> item = (*reader)->Next();
      EXPECT_TRUE(item.has_value());
      if (!item || !*item) return counts;
      counts.depth += std::holds_alternative<RecordedDepth>(**item) ? 1 : 0;
      counts.thermal += std::holds_alternative<RecordedThermal>(**item) ? 1 : 0;
    }
  }

  Command Edge(std::vector<std::string> arguments) const {
    // A domain of its own, so that a ground station on this computer does not interfere.
    arguments.insert(arguments.end(), {"--domain", std::to_string(100 + getpid() % 100)});
    return {ISOTHERM_BINARY_DIR "/bin/isotherm-edge", std::move(arguments), {}, {}};
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("isotherm_edge_" + std::to_string(getpid()));
  const std::filesystem::path scan_ = folder_ / "scan.mcap";
  const std::filesystem::path copy_ = folder_ / "copy.mcap";
};

TEST_F(EdgeDaemonTest, ReplaysARecordingToItsEndAndAccountsForEachFrame) {
  const Finished edge = RunToEnd(
      Edge({"--recording", scan_, "--record", copy_, "--rate", "0", "--exit-at-end"}), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("captured 30 = recorded 30 + rejected 0"));
  EXPECT_THAT(edge.output, HasSubstr("captured 30 = published 30 + rejected 0"));
  const Counts copy = ReadRecording(copy_);
  EXPECT_TRUE(copy.complete);
  EXPECT_EQ(copy.depth, kFrames);
  EXPECT_EQ(copy.thermal, kFrames);
}

TEST_F(EdgeDaemonTest, F38SigtermLeavesACompleteRecordingInTime) {
  NotifySocket manager(folder_);
  Command command =
      Edge({"--recording", scan_, "--record", copy_, "--set", "source.loops=0", "--rate", "1"});
  command.environment = {manager.environment()};
  Process edge(command);
  ASSERT_TRUE(manager.WaitFor("READY=1", kPatience)) << edge.output();
  // At least a chunk is on the disk: frames are flowing.
  while (!std::filesystem::exists(copy_) || std::filesystem::file_size(copy_) < 10'000) {
    ASSERT_EQ(edge.WaitForExit(Seconds(0.05)), std::nullopt) << edge.output();
  }
  edge.Signal(SIGTERM);
  const Departure departure = Leave(edge, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, 0) << edge.output();
  EXPECT_LT(departure.own(), kTimeToLeave) << departure.ToText();
  EXPECT_TRUE(manager.WaitFor("STOPPING=1", kPatience));
  const Counts copy = ReadRecording(copy_);
  EXPECT_TRUE(copy.complete);
  EXPECT_GT(copy.depth, 0);
  EXPECT_THAT(edge.output(), HasSubstr("captured " + std::to_string(copy.depth) + " = recorded " +
                                       std::to_string(copy.depth) + " + rejected 0"));
}

TEST_F(EdgeDaemonTest, F38ATerminalThatIsGoneLeavesACompleteRecordingToo) {
  NotifySocket manager(folder_);
  Command command =
      Edge({"--recording", scan_, "--record", copy_, "--set", "source.loops=0", "--rate", "1"});
  command.environment = {manager.environment()};
  Process edge(command);
  ASSERT_TRUE(manager.WaitFor("READY=1", kPatience)) << edge.output();
  while (!std::filesystem::exists(copy_) || std::filesystem::file_size(copy_) < 10'000) {
    ASSERT_EQ(edge.WaitForExit(Seconds(0.05)), std::nullopt) << edge.output();
  }
  const Departure departure = Leave(edge, SIGHUP, kPatience);
  EXPECT_EQ(departure.status, 0) << edge.output();
  EXPECT_LT(departure.own(), kTimeToLeave) << departure.ToText();
  EXPECT_TRUE(ReadRecording(copy_).complete);
}

TEST_F(EdgeDaemonTest, ADiskThatFillsUpEndsTheRecordingOnly) {
  // A limit on the file's size fails as a full disk does, and needs no file system of its own.
  const std::string script = "trap '' XFSZ; ulimit -f 200; exec \"$0\" \"$@\"";
  Command command =
      Edge({"--recording", scan_, "--record", copy_, "--rate", "0", "--exit-at-end", "--set",
            "source.loops=3", "--set", "spool.expert.flush_interval_s=0.05"});
  command.arguments.insert(command.arguments.begin(), {"-c", script, command.program});
  command.program = "/bin/sh";
  const Finished edge = RunToEnd(command, kPatience);
  EXPECT_EQ(edge.status, 73) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("captured 90 = published 90 + rejected 0"));
  const Counts copy = ReadRecording(copy_);
  EXPECT_FALSE(copy.complete);
  EXPECT_GT(copy.depth, 0) << "what is good stays";
  EXPECT_LT(copy.depth, 90);
  EXPECT_THAT(edge.output, HasSubstr("captured 90 = recorded " + std::to_string(copy.depth) +
                                     " + rejected 0 + queue full 0 + failed " +
                                     std::to_string(90 - copy.depth)));
  const std::string said = "recording ended early";
  const std::size_t first = edge.output.find(said);
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(edge.output.find(said, first + 1), std::string::npos) << "said once";
}

TEST_F(EdgeDaemonTest, F11GarbageInARecordingIsCountedNotPublished) {
  {
    std::filesystem::remove(scan_);
    const auto writer = RecordingWriter::Create(scan_, {});
    ASSERT_TRUE(writer.has_value());
    for (int i = 0; i < 10; ++i) {
      EncodedDepthFrame depth;
      depth.header.capture_time = CaptureTime(seconds(1'600'000'000)) + i * milliseconds(33);
      depth.image = DepthEncoder().Encode(Image<std::uint16_t>(i == 5 ? 32 : 64, 48, 700));
      ASSERT_TRUE((*writer)->Write(depth, std::nullopt).ok());
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }
  const Finished edge =
      RunToEnd(Edge({"--recording", scan_, "--rate", "0", "--exit-at-end"}), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("captured 10 = published 9 + rejected 1"));
}

TEST_F(EdgeDaemonTest, AMissingRecordingIsAnInputError) {
  const Finished edge = RunToEnd(Edge({"--recording", "/nowhere/scan.mcap"}), kPatience);
  EXPECT_EQ(edge.status, 66);
  EXPECT_THAT(edge.output, HasSubstr("/nowhere/scan.mcap"));
}

TEST_F(EdgeDaemonTest, F59AWrongConfigurationListsAllProblems) {
  const Finished edge = RunToEnd(Edge({"--set", "timestamper.expert.depth_window=0", "--set",
                                       "link.expert.queue_frames=0", "--rate", "-1"}),
                                 kPatience);
  EXPECT_EQ(edge.status, 78);
  EXPECT_THAT(edge.output, HasSubstr("timestamper.expert.depth_window"));
  EXPECT_THAT(edge.output, HasSubstr("link.expert.queue_frames"));
  EXPECT_THAT(edge.output, HasSubstr("source.rate"));
}

TEST_F(EdgeDaemonTest, F59AnUnknownFieldIsAnErrorWithItsLine) {
  const std::filesystem::path config = folder_ / "edge.textproto";
  std::ofstream(config) << "nuc {\n  settle_tim_s: 1\n}\n";
  const Finished edge = RunToEnd(Edge({"--config", config}), kPatience);
  EXPECT_EQ(edge.status, 78);
  EXPECT_THAT(edge.output, HasSubstr("edge.textproto:2"));
}

TEST_F(EdgeDaemonTest, AWrongCommandLineIsAUsageError) {
  EXPECT_EQ(RunToEnd(Edge({"--no-such-option"}), kPatience).status, 64);
  EXPECT_EQ(RunToEnd(Edge({"--source", "webcam"}), kPatience).status, 64);
}

TEST_F(EdgeDaemonTest, ARecordingThatCannotBeCreatedEndsTheStartOfAScript) {
  const Finished edge =
      RunToEnd(Edge({"--recording", scan_, "--record", "/proc/nowhere/scan.mcap", "--exit-at-end"}),
               kPatience);
  EXPECT_EQ(edge.status, 73) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("/proc/nowhere"));
}

TEST_F(EdgeDaemonTest, HelpAndVersionEndWell) {
  const Finished help = RunToEnd(Edge({"--help"}), kPatience);
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.output, HasSubstr("Exit status"));
  EXPECT_EQ(RunToEnd(Edge({"--version"}), kPatience).status, 0);
  EXPECT_THAT(RunToEnd(Edge({"--list-sources"}), kPatience).output, HasSubstr("furnace-door"));
}

}  // namespace
}  // namespace isotherm
