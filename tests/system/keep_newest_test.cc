// An edge that keeps the newest of its recording only, as one without a disk does in memory, and a
// ground that comes late.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

/// The small scan with images of this many times its width and height gives 0.26 MB/s, of which 1
/// MB is kept.
constexpr int kScale = 4;
constexpr double kKept_bytes = 1e6;

std::set<std::uint64_t> Numbers(const std::vector<StoredFrame>& frames) {
  std::set<std::uint64_t> numbers;
  for (const StoredFrame& frame : frames) numbers.insert(frame.frame_number);
  return numbers;
}

class KeepNewestTest : public ::testing::Test {
 protected:
  KeepNewestTest() {
    WriteSmallScan(scan_, kScale);
    WriteSmallRig(rig_, kScale);
    std::filesystem::create_directory(memory_);
  }

  void StartEdge(int seconds) {
    edge_.emplace(
        Command{EdgeDaemon(),
                {"--recording", scan_, "--rig", rig_, "--domain", std::to_string(OwnDomain()),
                 "--record", memory_.string() + "/", "--exit-at-end", "--set",
                 "spool.when_full=KEEP_NEWEST", "--set", "spool.quota_gb=0.001", "--set",
                 "link.expert.linger_s=60", "--set", "source.loops=" + std::to_string(seconds)},
                {}});
    ASSERT_TRUE(edge_->WaitForOutput("recording to", kPatience)) << edge_->output();
  }
  void StartGround() {
    std::vector<std::string> arguments = {"--domain", std::to_string(OwnDomain()), "--once",
                                          "--output", results_};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    ground_.emplace(Command{GroundService(), arguments, {}});
  }
  /// Waits until the edge has deleted what no ground had.
  void AwaitDeleted() {
    ASSERT_TRUE(edge_->WaitForOutput("frames are deleted that the ground does not have", kPatience))
        << edge_->output();
  }
  void End() {
    EXPECT_EQ(edge_->WaitForExit(kPatience), 0) << edge_->output();
    EXPECT_EQ(ground_->WaitForExit(kPatience), 0) << ground_->output();
  }
  /// Returns the number that the edge's summary begins this line with.
  double Said(const std::string& line) const {
    const std::string output = edge_->output();
    const std::size_t at = output.find(line);
    return at == std::string::npos ? 0.0 : std::stod(output.substr(at + line.size()));
  }
  std::uintmax_t MemoryTaken() const {
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(memory_))
      bytes += entry.file_size();
    return bytes;
  }
  /// The ground has all that was captured, but for what is missing there; missing are
  /// the frames that the edge says to have deleted.
  void ExpectTheRestCounted() {
    const RecordingContent received = ReadRecording(results_ / "scan.mcap");
    EXPECT_TRUE(received.complete);
    const auto stats = ReadStats(results_);
    double missing = 0.0;
    for (const auto& [stream, frames] :
         {std::pair("depth", &received.depth), std::pair("thermal", &received.thermal)}) {
      SCOPED_TRACE(stream);
      const auto link = [&stats, name = stream](const char* what) {
        return NumberAt(stats, {"link", name, what});
      };
      const std::set<std::uint64_t> numbers = Numbers(*frames);
      EXPECT_EQ(numbers.size(), frames->size()) << "each once";
      EXPECT_EQ(static_cast<double>(numbers.size()), link("received"));
      missing += link("missing");
      EXPECT_GT(link("missing"), 0.0);
    }
    EXPECT_EQ(Said("\ndeleted  "), missing) << edge_->output() << ground_->output();
    EXPECT_LT(static_cast<double>(MemoryTaken()), 1.6 * kKept_bytes);
    // Whatever is kept in the end is there.
    const std::set<std::uint64_t> numbers = Numbers(received.depth);
    for (const auto& file : std::filesystem::directory_iterator(memory_)) {
      for (const std::uint64_t number : Numbers(ReadRecording(file.path()).depth))
        EXPECT_TRUE(numbers.contains(number)) << number;
    }
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "source.mcap";
  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  const std::filesystem::path memory_ = folder_.path() / "memory";
  const std::filesystem::path results_ = folder_.path() / "results";
  std::optional<Process> edge_, ground_;
};

TEST_F(KeepNewestTest, F35AGroundThatComesLateGetsWhatIsKeptAndTheRestIsCounted) {
  StartEdge(16);
  ASSERT_NO_FATAL_FAILURE(AwaitDeleted());
  StartGround();
  End();
  ExpectTheRestCounted();
}

TEST_F(KeepNewestTest, F33AKilledEdgeGoesOnWithWhatIsKept) {
  StartEdge(100);
  ASSERT_NO_FATAL_FAILURE(AwaitDeleted());
  edge_->Signal(SIGKILL);
  EXPECT_EQ(edge_->WaitForExit(kPatience), 128 + SIGKILL);
  EXPECT_LT(static_cast<double>(MemoryTaken()), 1.6 * kKept_bytes);
  StartEdge(8);
  StartGround();
  End();
  EXPECT_THAT(edge_->output(), HasSubstr("was interrupted, and goes on"));
  const RecordingContent received = ReadRecording(results_ / "scan.mcap");
  const std::set<std::uint64_t> numbers = Numbers(received.depth);
  const auto stats = ReadStats(results_);
  const auto link = [&](const char* what) { return NumberAt(stats, {"link", "depth", what}); };
  EXPECT_GT(link("missing"), 0.0) << "deleted by the process before, or by this one";
  EXPECT_GT(NumberAt(stats, {"link", "depth", "dropped_by_rig", "lost_by_a_restart"}), 0.0);
  EXPECT_EQ(link("published"), link("received") + link("missing"));
  EXPECT_EQ(static_cast<double>(numbers.size()), link("received"));
  EXPECT_EQ(Said("\ndeleted  "), link("missing") + NumberAt(stats, {"link", "thermal", "missing"}))
      << edge_->output() << ground_->output();
}

}  // namespace
}  // namespace isotherm::system_test
