// Both daemons on a network of their own, whose interfaces come late or go down. Takes root, for
// network namespaces.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

constexpr const char* kIp = "/usr/sbin/ip";
/// The daemons promise to leave so soon after SIGTERM, and a loaded test computer adds the slack.
constexpr Seconds kTimeToLeave{2.0};
constexpr Seconds kSlack{5.0};

/// A computer: a network namespace that is connected to the other one by one interface.
struct Host {
  std::string name;       ///< Name of the namespace.
  std::string interface;  ///< Its end of the cable.
  std::string address;
};

class NetworkDownTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const bool may = geteuid() == 0 && std::filesystem::exists(kIp) &&
                     Ip({"netns", "add", edge_.name}) && Ip({"netns", "add", ground_.name});
    if (!may) GTEST_SKIP() << "no network of its own: network namespaces take root and iproute2";
    SimulateScan(scan_, 3.0);
  }
  ~NetworkDownTest() override {
    for (const Host& host : {edge_, ground_}) Ip({"netns", "del", host.name});
  }

  static bool Ip(std::vector<std::string> arguments) {
    return RunToEnd({kIp, std::move(arguments), {}, {}}, kPatience).status == 0;
  }
  /// Puts the cable in, which is what makes the interfaces appear.
  void Connect() {
    ASSERT_TRUE(Ip({"link", "add", edge_.interface, "netns", edge_.name, "type", "veth", "peer",
                    "name", ground_.interface, "netns", ground_.name}));
    for (const Host& host : {edge_, ground_}) {
      ASSERT_TRUE(
          Ip({"-n", host.name, "addr", "add", host.address + "/24", "dev", host.interface}));
      ASSERT_TRUE(Ip({"-n", host.name, "link", "set", host.interface, "up"}));
    }
  }
  static void Down(const Host& host) {
    ASSERT_TRUE(Ip({"-n", host.name, "link", "set", host.interface, "down"}));
  }

  /// The shipped profile with the interface chosen.
  std::string Profile(const Host& host) const {
    std::ostringstream text;
    text << std::ifstream(ISOTHERM_SOURCE_DIR "/deploy/cyclonedds-lan.xml").rdbuf();
    std::string profile = text.str();
    const std::string any = "autodetermine=\"true\"";
    const std::size_t at = profile.find(any);
    EXPECT_NE(at, std::string::npos);
    if (at != std::string::npos) profile.replace(at, any.size(), "name=\"" + host.interface + "\"");
    const std::filesystem::path path = folder_.path() / (host.name + ".xml");
    std::ofstream(path) << profile;
    return "CYCLONEDDS_URI=file://" + path.string();
  }
  Command On(const Host& host, const std::filesystem::path& program,
             const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"netns", "exec", host.name, program.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {kIp, std::move(arguments), {Profile(host)}, {}};
  }
  Command Edge() const {
    return On(edge_, EdgeDaemon(),
              {"--recording", scan_, "--set", "source.loops=0", "--record", copy_});
  }
  Command Ground() const {
    std::vector<std::string> arguments = {"--output", folder_.path() / "ground"};
    const std::vector<std::string> quick = QuickModel();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return On(ground_, GroundService(), arguments);
  }
  static void ExpectToLeaveInTime(Process& daemon) {
    const auto asked = std::chrono::steady_clock::now();
    daemon.Signal(SIGTERM);
    EXPECT_EQ(daemon.WaitForExit(kPatience), 0) << daemon.output();
    const Seconds took = std::chrono::steady_clock::now() - asked;
    EXPECT_LT(took, kTimeToLeave + kSlack) << daemon.output();
    RecordProperty("time_to_leave_s", std::to_string(took.count()));
  }

  const std::string id_ = std::to_string(getpid());
  const Host edge_{"iso-edge-" + id_, "ie" + id_, "10.77.0.1"};
  const Host ground_{"iso-ground-" + id_, "ig" + id_, "10.77.0.2"};
  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "scan.mcap";
  const std::filesystem::path copy_ = folder_.path() / "copy.mcap";
};

TEST_F(NetworkDownTest, F38WithTheirOwnInterfaceDownBothLeaveInTime) {
  Connect();
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge());
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience))
      << ground.output() << edge.output();
  Down(edge_);
  Down(ground_);
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
  // The cable is there, but nothing that one sends reaches the other.
  for (const Host& host : {edge_, ground_}) {
    ASSERT_TRUE(Ip({"-n", host.name, "neigh", "replace",
                    host.name == edge_.name ? ground_.address : edge_.address, "lladdr",
                    "02:00:00:00:00:01", "dev", host.interface, "nud", "permanent"}));
  }
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
