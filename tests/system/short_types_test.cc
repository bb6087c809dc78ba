// Row F60 with the daemons as they ship: beside them an ordinary DDS program whose types end too
// early, on every topic and in both directions, under the rig's own name.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <iostream>
#include <memory>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::TemporaryDirectory;

constexpr double kScan_s = 1.0;

std::vector<std::string> Joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

class ShortTypesTest : public ::testing::Test {
 protected:
  ShortTypesTest() { SimulateScan(Path("source.mcap"), kScan_s); }

  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }
  static std::string Domain() { return std::to_string(OwnDomain()); }
  Command Edge() const {
    return {EdgeDaemon(),
            {"--recording", Path("source.mcap"), "--domain", Domain(), "--record",
             Path("edge.mcap"), "--rate", "0", "--wait-for-ground", "--exit-at-end"},
            {}};
  }
  Command Ground(const std::string& folder) const {
    return {GroundService(),
            Joined({"--domain", Domain(), "--output", Path(folder), "--once"}, QuickScan()),
            {}};
  }

  /// From now on the peer has had all of `topics` acknowledged by whoever reads them.
  static void AwaitDelivery(Process& peer, const std::vector<std::string>& topics) {
    for (const std::string& topic : topics) {
      const std::string delivered = "delivered isotherm/" + topic + "\n";
      const int before = Count(peer.output(), delivered);
      // Twice: the first may have been on its way before.
      EXPECT_TRUE(peer.WaitForOutput(delivered, kPatience, before + 2)) << topic;
    }
  }
  static void ExpectAlive(Process& daemon) {
    EXPECT_EQ(daemon.WaitForExit(Seconds(0)), std::nullopt) << daemon.output();
    EXPECT_THAT(daemon.output(), HasSubstr("sample refused: members are missing"));
  }
  /// The daemon beside the peer, and again: most topics keep samples for who comes later.
  static void ExpectToSurviveTwice(const Command& daemon, Process& peer,
                                   const std::vector<std::string>& topics) {
    for (int i = 0; i < 2; ++i) {
      Process running(daemon);
      AwaitDelivery(peer, topics);
      ExpectAlive(running);
      running.Signal(SIGTERM);
      EXPECT_TRUE(running.WaitForExit(kPatience).has_value());
    }
  }
  void ExpectTheScanIsWhole(const std::string& folder) const {
    const RecordingContent source = ReadRecording(Path("source.mcap"));
    const RecordingContent received = ReadRecording(Path(folder) / "scan.mcap");
    ASSERT_THAT(source.depth, Not(IsEmpty()));
    EXPECT_EQ(received.depth.size(), source.depth.size());
    EXPECT_EQ(received.thermal.size(), source.thermal.size());
    const auto stats = ReadStats(Path(folder));
    EXPECT_EQ(NumberAt(stats, {"link", "depth", "received"}),
              static_cast<double>(source.depth.size()));
    EXPECT_GT(NumberAt(stats, {"link", "refused_samples"}), 0.0);
  }

  TemporaryDirectory folder_;
};

TEST_F(ShortTypesTest, F60TheGroundSurvivesThemAndTheNextScanIsWhole) {
  Process peer({SHORT_PEER, {Domain(), "edge"}, {}});
  const std::vector<std::string> topics = {"3/depth", "3/thermal",     "3/external_odometry",
                                           "3/rig",   "3/edge_status", "3/command_result"};
  ExpectToSurviveTwice(Ground("waiting"), peer, topics);
  Process ground(Ground("ground"));
  AwaitDelivery(peer, topics);
  const Finished edge = RunToEnd(Edge(), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  ExpectTheScanIsWhole("ground");
  if (HasFailure()) std::cout << "edge:\n" << edge.output << "ground:\n" << ground.output();
}

TEST_F(ShortTypesTest, F60TheEdgeSurvivesThemAndTheNextScanIsWhole) {
  Process peer({SHORT_PEER, {Domain(), "edge"}, {}});
  const std::vector<std::string> topics = {"3/command", "3/receipt", "3/feedback",
                                           "3/recording_request"};
  ExpectToSurviveTwice(Edge(), peer, topics);
  std::filesystem::remove(Path("edge.mcap"));
  Process edge(Edge());
  AwaitDelivery(peer, topics);
  Process ground(Ground("ground"));
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  ExpectTheScanIsWhole("ground");
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << "ground:\n" << ground.output();
}

}  // namespace
}  // namespace isotherm::system_test
