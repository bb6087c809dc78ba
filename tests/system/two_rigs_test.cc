// More than one rig on one network: two of one name, one of a name that nobody follows, one that
// was killed and comes back, four with a ground each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <deque>
#include <iostream>
#include <memory>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

class TwoRigsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TemporaryDirectory>();
    SimulateScan(shared_->path() / "source.mcap", 2.0);
  }
  static void TearDownTestSuite() { shared_.reset(); }

  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }

  /// A rig that plays the scan `loops` times in real time, and records what it sends.
  Command Edge(const std::string& name, int loops, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"--recording",
                                          shared_->path() / "source.mcap",
                                          "--domain",
                                          std::to_string(OwnDomain()),
                                          "--record",
                                          Path(name + ".mcap"),
                                          "--exit-at-end",
                                          "--set",
                                          "source.loops=" + std::to_string(loops)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {EdgeDaemon(), arguments, {}};
  }
  Command Ground(std::vector<std::string> more = {}, const std::string& folder = "ground") const {
    std::vector<std::string> arguments = {"--domain", std::to_string(OwnDomain()), "--output",
                                          Path(folder)};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {GroundService(), arguments, {}};
  }
  /// The ground has everything that the rig recorded, and nothing else, and its counters say so.
  static void ExpectTheScanOf(const std::filesystem::path& edge,
                              const std::filesystem::path& results) {
    const RecordingContent sent = ReadRecording(edge);
    const RecordingContent received = ReadRecording(results / "scan.mcap");
    ASSERT_FALSE(sent.depth.empty());
    EXPECT_TRUE(received.depth == sent.depth)
        << received.depth.size() << " of " << sent.depth.size();
    EXPECT_TRUE(received.thermal == sent.thermal)
        << received.thermal.size() << " of " << sent.thermal.size();
    const auto stats = ReadStats(results);
    const auto depth = static_cast<double>(sent.depth.size());
    EXPECT_EQ(NumberAt(stats, {"link", "depth", "published"}), depth);
    EXPECT_EQ(NumberAt(stats, {"link", "depth", "received"}), depth);
    EXPECT_EQ(NumberAt(stats, {"link", "depth", "missing"}), 0.0);
  }
  static int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }

  static std::unique_ptr<TemporaryDirectory> shared_;
  TemporaryDirectory folder_;
};

std::unique_ptr<TemporaryDirectory> TwoRigsTest::shared_;

TEST_F(TwoRigsTest, F36TheFirstOfOneNameKeepsItsScanAndTheSecondIsRefusedAndTold) {
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process first(Edge("first", 6, {"--wait-for-ground"}));
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience)) << ground.output();
  Process second(Edge("second", 100));
  EXPECT_TRUE(second.WaitForOutput("refuses this scan", kPatience)) << second.output();
  second.Signal(SIGTERM);
  EXPECT_EQ(second.WaitForExit(kPatience), 0) << second.output();
  EXPECT_FALSE(first.WaitForExit(Seconds(0))) << "it was told while the scan went on";
  EXPECT_EQ(first.WaitForExit(kPatience), 0) << first.output();
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  ExpectTheScanOf(Path("first.mcap"), Path("ground"));
  EXPECT_THAT(first.output(), HasSubstr("ground received"));
  EXPECT_THAT(first.output(), Not(HasSubstr("refuses this scan")));
  EXPECT_THAT(second.output(), Not(HasSubstr("ground received"))) << "that is the other one's";
  EXPECT_EQ(Count(second.output(), "refuses this scan"), 1) << second.output();
  EXPECT_EQ(Count(ground.output(), "a second rig of the name"), 1) << ground.output();
  EXPECT_LE(Count(ground.output(), "clock is not synchronised"), 1) << ground.output();
  EXPECT_GT(NumberAt(ReadStats(Path("ground")), {"link", "depth", "refused"}), 0.0);
}

TEST_F(TwoRigsTest, EachOfFourRigsArrivesWholeAtItsOwnGround) {
  const std::vector<std::string> names = {"north", "east", "south", "west"};
  std::deque<Process> grounds, edges;
  for (const std::string& name : names) {
    grounds.emplace_back(Ground({"--once", "--edge-id", name}, "ground-" + name));
    ASSERT_TRUE(grounds.back().WaitForOutput("ready", kPatience)) << grounds.back().output();
  }
  for (const std::string& name : names)
    edges.emplace_back(Edge(name, 2, {"--wait-for-ground", "--edge-id", name}));
  for (Process& edge : edges) EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  for (Process& ground : grounds) EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  for (const std::string& name : names) {
    ExpectTheScanOf(Path(name + ".mcap"), Path("ground-" + name));
    EXPECT_TRUE(std::filesystem::exists(Path("ground-" + name) / "cloud.ply")) << name;
  }
}

TEST_F(TwoRigsTest, ARigThatNobodyFollowsIsNamedOnBothSidesAndDoesNotWait) {
  Process ground(Ground({"--edge-id", "rig7"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge("drone", 2, {"--edge-id", "drone", "--set", "link.policy=LOSSLESS"}));
  EXPECT_TRUE(
      ground.WaitForOutput("a rig \"drone\" is here, this ground follows \"rig7\"; start "
                           "with --edge-id drone",
                           kPatience))
      << ground.output();
  EXPECT_TRUE(edge.WaitForOutput("follows \"rig7\", not \"drone\"", kPatience)) << edge.output();
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  const FrameCountersText counters = CountersOf(edge.output(), Sensor::kDepth, "published");
  EXPECT_TRUE(counters.Closes()) << edge.output();
  EXPECT_EQ(counters.queue_full, 0) << "it waited for receipts of a ground that is not its own";
  EXPECT_THAT(edge.output(), Not(HasSubstr("no receipt from the ground")));
}

TEST_F(TwoRigsTest, F33AnEdgeThatWasKilledIsFollowedByItsSuccessorWithoutLoss) {
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process killed(Edge("killed", 100, {"--wait-for-ground"}));
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience)) << ground.output();
  killed.Signal(SIGKILL);
  const auto start = std::chrono::steady_clock::now();
  Process next(Edge("next", 2, {"--wait-for-ground"}));
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience, 2)) << ground.output();
  const Seconds until_followed = std::chrono::steady_clock::now() - start;
  std::cout << "followed after " << until_followed.count() << " s, its start included\n";
  EXPECT_EQ(next.WaitForExit(kPatience), 0) << next.output();
  ASSERT_TRUE(ground.WaitForOutput("published = ", kPatience, 4)) << ground.output();
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  std::filesystem::path newest;
  for (const auto& entry : std::filesystem::directory_iterator(Path("ground"))) {
    if (entry.path().filename() > newest.filename()) newest = entry.path();
  }
  ExpectTheScanOf(Path("next.mcap"), newest);
  EXPECT_THAT(next.output(), Not(HasSubstr("refuses this scan")));
  EXPECT_THAT(ground.output(), Not(HasSubstr("a second rig of the name")));
  if (HasFailure()) std::cout << ground.output() << next.output();
}

}  // namespace
}  // namespace isotherm::system_test
