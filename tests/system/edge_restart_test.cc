// The edge is killed in the middle of a scan and started again: it goes on with the scan, and the
// ground gets all that any of the processes has recorded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <iterator>
#include <optional>
#include <thread>

#include "common/recording/recording_parts.h"
#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

constexpr int kKills = 4;
/// Frames that had been published when a process was killed, and not recorded: half a second until
/// the recording is flushed, and as much again for a computer that is busy.
constexpr std::size_t kMaxNotRecorded = 45;

bool ByNumber(const StoredFrame& a, const StoredFrame& b) {
  return a.frame_number < b.frame_number;
}

/// Returns the frames of `a` that `b` lacks.
std::vector<StoredFrame> Without(const std::vector<StoredFrame>& a,
                                 const std::vector<StoredFrame>& b) {
  std::vector<StoredFrame> missing;
  std::ranges::set_difference(a, b, std::back_inserter(missing), ByNumber);
  return missing;
}

class EdgeRestartTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteSmallScan(scan_);
    WriteSmallRig(rig_);
  }

  void StartGround(const std::string& results) {
    results_ = folder_.path() / results;
    std::vector<std::string> arguments = {"--domain", std::to_string(OwnDomain()), "--once",
                                          "--output", results_};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    ground_.emplace(Command{GroundService(), arguments, {}});
    ASSERT_TRUE(ground_->WaitForOutput("ready", kPatience)) << ground_->output();
  }
  /// Starts the edge for the time number `start`, from 1 on.
  void StartEdge(int start, int loops, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--recording", scan_,
                                          "--rig",       rig_,
                                          "--domain",    std::to_string(OwnDomain()),
                                          "--record",    record_,
                                          "--set",       "link.expert.linger_s=60",
                                          "--set",       "source.loops=" + std::to_string(loops)};
    if (leaves_) arguments.emplace_back("--exit-at-end");
    if (waits_for_ground_) arguments.emplace_back("--wait-for-ground");
    arguments.insert(arguments.end(), more.begin(), more.end());
    edge_.emplace(Command{EdgeDaemon(), arguments, {}});
    start_ = start;
    EXPECT_TRUE(edge_->WaitForOutput("recording to", kPatience)) << edge_->output();
  }
  /// Waits until the edge has brought some more to the disk, then kills it.
  void KillEdge() {
    std::uintmax_t size = 0;
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    for (int growths = 0; growths < 4;) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << edge_->output();
      std::error_code ignored;
      const std::uintmax_t now = std::filesystem::file_size(PartPath(record_, start_), ignored);
      if (!ignored && now != std::exchange(size, now)) ++growths;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    edge_->Signal(SIGKILL);
    EXPECT_EQ(edge_->WaitForExit(kPatience), 128 + SIGKILL) << edge_->output();
  }
  void KillGround() {
    ground_->Signal(SIGKILL);
    EXPECT_EQ(ground_->WaitForExit(kPatience), 128 + SIGKILL);
  }
  void End() {
    EXPECT_EQ(edge_->WaitForExit(kPatience), 0) << edge_->output();
    EXPECT_EQ(ground_->WaitForExit(kPatience), 0) << ground_->output();
    EXPECT_THAT(ground_->output(), HasSubstr("scan ended"));
  }

  /// The ground's scan, which is one, has all that stands in the rig's files, and little more.
  void ExpectTheWholeScan(int parts) {
    RecordingContent recorded;
    for (int part = 1; part <= parts; ++part) {
      const RecordingContent content = ReadRecording(PartPath(record_, part));
      EXPECT_EQ(content.complete, part == parts) << "part " << part;
      EXPECT_FALSE(content.depth.empty()) << "part " << part;
      std::ranges::copy(content.depth, std::back_inserter(recorded.depth));
      std::ranges::copy(content.thermal, std::back_inserter(recorded.thermal));
    }
    EXPECT_FALSE(std::filesystem::exists(PartPath(record_, parts + 1)));
    const RecordingContent received = ReadRecording(results_ / "scan.mcap");
    EXPECT_TRUE(received.complete);
    const auto stats = ReadStats(results_);
    for (const auto& [name, sent, got] :
         {std::tuple("depth", &recorded.depth, &received.depth),
          std::tuple("thermal", &recorded.thermal, &received.thermal)}) {
      SCOPED_TRACE(name);
      EXPECT_TRUE(std::ranges::is_sorted(*sent, ByNumber)) << "numbers go on";
      EXPECT_TRUE(std::ranges::adjacent_find(*sent,
                                             [](const auto& a, const auto& b) {
                                               return a.frame_number == b.frame_number ||
                                                      a.capture_time >= b.capture_time;
                                             }) == sent->end())
          << "so do times";
      EXPECT_TRUE(Without(*sent, *got).empty()) << "missing on the ground";
      const std::size_t not_recorded = Without(*got, *sent).size();
      EXPECT_LE(not_recorded, kMaxNotRecorded * static_cast<std::size_t>(parts - 1));
      const auto link = [&stats, stream = name](const char* what) {
        return NumberAt(stats, {"link", stream, what});
      };
      EXPECT_EQ(link("missing"), 0.0);
      EXPECT_EQ(link("received"), static_cast<double>(got->size()));
      EXPECT_GT(NumberAt(stats, {"link", name, "dropped_by_rig", "lost_by_a_restart"}), 0.0);
      EXPECT_EQ(NumberAt(stats, {"frames", name, "in"}), link("received")) << "in the results";
      std::cout << name << ": recorded " << sent->size() << ", received " << got->size() << ", "
                << not_recorded << " of them not recorded, late " << link("late") << "\n";
    }
    EXPECT_TRUE(stats.fields().at("link").struct_value().fields().at("final").bool_value());
    if (HasFailure()) std::cout << ground_->output() << edge_->output();
  }

  /// Completes a file that breaks off, and nothing of it is lost.
  static void ExpectRepaired(const std::filesystem::path& file) {
    const RecordingContent before = ReadRecording(file);
    const Finished repaired = RunToEnd({Tool(), {"inspect", file, "--repair"}, {}, {}}, kPatience);
    EXPECT_EQ(repaired.status, 0) << repaired.output;
    EXPECT_THAT(repaired.output, HasSubstr("completed"));
    const RecordingContent after = ReadRecording(file);
    EXPECT_TRUE(after.complete);
    EXPECT_TRUE(after.depth == before.depth && after.thermal == before.thermal);
    const Finished again = RunToEnd({Tool(), {"inspect", file, "--repair"}, {}, {}}, kPatience);
    EXPECT_THAT(again.output, HasSubstr("nothing to repair"));
  }

  TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "source.mcap";
  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  const std::filesystem::path record_ = folder_.path() / "scan.mcap";
  std::filesystem::path results_;
  std::optional<Process> ground_;
  std::optional<Process> edge_;
  int start_ = 0;
  bool leaves_ = true;  ///< When the source has ended.
  bool waits_for_ground_ = true;
};

TEST_F(EdgeRestartTest, F33AnEdgeThatIsKilledAgainAndAgainGoesOnWithItsScan) {
  ASSERT_NO_FATAL_FAILURE(StartGround("ground"));
  for (int start = 1; start <= kKills; ++start) {
    StartEdge(start, 100);
    ASSERT_NO_FATAL_FAILURE(KillEdge());
  }
  StartEdge(kKills + 1, 4);
  EXPECT_THAT(edge_->output(), HasSubstr("was interrupted, and goes on"));
  End();
  EXPECT_THAT(edge_->output(), HasSubstr("numbers left out while the edge was started again"));
  EXPECT_THAT(ground_->output(), Not(HasSubstr("a second rig of the name")));
  EXPECT_THAT(ground_->output(), Not(HasSubstr("stream has jumped")));
  ExpectTheWholeScan(kKills + 1);
  ExpectRepaired(record_);
}

TEST_F(EdgeRestartTest, F34ANewGroundGetsTheWholeScanOfAnEdgeThatWasStartedAgain) {
  ASSERT_NO_FATAL_FAILURE(StartGround("first"));
  StartEdge(1, 100);
  ASSERT_NO_FATAL_FAILURE(KillEdge());
  KillGround();
  ASSERT_NO_FATAL_FAILURE(StartGround("second"));
  StartEdge(2, 6);
  End();
  EXPECT_THAT(ground_->output(), HasSubstr("complete "));
  ExpectTheWholeScan(2);
}

TEST_F(EdgeRestartTest, F33AnEdgeThatStaysCompletesTheFilesThatBreakOff) {
  ASSERT_NO_FATAL_FAILURE(StartGround("ground"));
  StartEdge(1, 100);
  ASSERT_NO_FATAL_FAILURE(KillEdge());
  leaves_ = false;
  StartEdge(2, 2);
  EXPECT_TRUE(edge_->WaitForOutput("scan.mcap has broken off, and is completed", kPatience))
      << edge_->output();
  EXPECT_TRUE(ReadRecording(record_).complete);
  EXPECT_TRUE(ReadRecording(PartPath(record_, 2)).complete);
  edge_->Signal(SIGTERM);
  EXPECT_EQ(edge_->WaitForExit(kPatience), 0) << edge_->output();
  // What is complete is over: the next start begins a scan. The ground may have left with the one
  // before.
  waits_for_ground_ = false;
  StartEdge(3, 1, {"--set", "link.expert.linger_s=1"});
  EXPECT_THAT(edge_->output(), Not(HasSubstr("was interrupted")));
}

TEST_F(EdgeRestartTest, F33AnEdgeThatMayNotGoOnBeginsAnotherScan) {
  ASSERT_NO_FATAL_FAILURE(StartGround("ground"));
  StartEdge(1, 100);
  ASSERT_NO_FATAL_FAILURE(KillEdge());
  StartEdge(2, 2, {"--set", "spool.resume_s=0", "--set", "link.expert.linger_s=1"});
  EXPECT_EQ(edge_->WaitForExit(kPatience), 0) << edge_->output();
  EXPECT_THAT(edge_->output(), Not(HasSubstr("was interrupted")));
  End();
  EXPECT_GT(NumberAt(ReadStats(results_), {"link", "depth", "received"}), 0.0);
  EXPECT_EQ(ReadRecording(PartPath(record_, 2)).depth.front().frame_number, 0U);
}

}  // namespace
}  // namespace isotherm::system_test
