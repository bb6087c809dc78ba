// Both daemons on a network of their own, whose interfaces come late or go down. Takes root, for
// network namespaces.

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/system/two_hosts.h"

namespace isotherm::system_test {
namespace {

class NetworkDownTest : public TwoHostsTest {
 protected:
  void SetUp() override {
    TwoHostsTest::SetUp();
    if (!IsSkipped()) SimulateScan(scan_, 3.0);
  }
  Command Edge() const {
    return On(edge_, LanProfile(edge_), EdgeDaemon(),
              {"--recording", scan_, "--set", "source.loops=0", "--record", copy_});
  }
  Command Ground() const {
    std::vector<std::string> arguments = {"--output", folder_.path() / "ground"};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return On(ground_, LanProfile(ground_), GroundService(), arguments);
  }
  static void ExpectToLeaveInTime(Process& daemon) {
    const Departure departure = Leave(daemon, SIGTERM, kPatience);
    EXPECT_EQ(departure.status, 0) << daemon.output();
    EXPECT_LT(departure.own(), kTimeToLeave) << departure.ToText() << daemon.output();
    std::cout << departure.ToText();
  }
};

TEST_F(NetworkDownTest, F38WithTheirOwnInterfaceDownBothLeaveInTime) {
  Connect();
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge());
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience))
      << ground.output() << edge.output();
  Set(edge_, "down");
  Set(ground_, "down");
  ExpectToLeaveInTime(edge);
  EXPECT_TRUE(ReadRecording(copy_).complete);
  EXPECT_TRUE(CountersOf(edge.output(), Sensor::kDepth, "published").Closes()) << edge.output();
  ExpectToLeaveInTime(ground);
}

TEST_F(NetworkDownTest, F38WithThePeerGoneBothLeaveInTime) {
  Connect();
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge());
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience))
      << ground.output() << edge.output();
  CarryNothing();
  ExpectToLeaveInTime(edge);
  EXPECT_TRUE(ReadRecording(copy_).complete);
  EXPECT_TRUE(CountersOf(edge.output(), Sensor::kDepth, "published").Closes()) << edge.output();
  ExpectToLeaveInTime(ground);
}

TEST_F(NetworkDownTest, F31BothWaitForTheirInterfaceAndFindEachOther) {
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("trying again", kPatience)) << ground.output();
  Process edge(Edge());
  ASSERT_TRUE(edge.WaitForOutput("trying again", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("recording to", kPatience)) << edge.output();
  Connect();
  ASSERT_TRUE(edge.WaitForOutput("joined DDS domain", kPatience)) << edge.output();
  ASSERT_TRUE(ground.WaitForOutput("joined DDS domain", kPatience)) << ground.output();
  EXPECT_TRUE(ground.WaitForOutput("first depth frame", kPatience))
      << ground.output() << edge.output();
  ExpectToLeaveInTime(edge);
  ExpectToLeaveInTime(ground);
}

}  // namespace
}  // namespace isotherm::system_test
