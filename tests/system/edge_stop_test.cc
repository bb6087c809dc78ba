// isotherm-edge told to leave while everything that it has to end hangs: the camera's library, the
// disk and the middleware. Takes root, for a network of its own whose interface goes down.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/system/edge_failure.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kIp = "/usr/sbin/ip";
/// The edge promises to be gone so soon after the signal, whatever hangs (stop_limits::kMaxStop and
/// what a busy computer adds); the service manager kills it two seconds later.
constexpr Seconds kMaxStop{8.0};
/// As kCameras and kDisk of stop_limits, the disk has until 5.25 s after the signal.
constexpr Seconds kDiskAnswersAfter{4.5};

class EdgeStopTest : public EdgeFailureTest {
 protected:
  void SetUp() override {
    const bool may = geteuid() == 0 && std::filesystem::exists(kIp) && Ip({"netns", "add", name_});
    if (!may) GTEST_SKIP() << "no network of its own: network namespaces take root and iproute2";
    ASSERT_TRUE(InNetwork({"link", "add", "near", "type", "veth", "peer", "name", "far"}));
    ASSERT_TRUE(InNetwork({"addr", "add", "10.77.0.1/24", "dev", "near"}));
    for (const char* end : {"near", "far"}) ASSERT_TRUE(InNetwork({"link", "set", end, "up"}));
    std::ofstream(profile_) << "<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
                               "name=\"near\"/></Interfaces></General></Domain></CycloneDDS>";
    std::ofstream(stuck_).put('\n');
  }
  ~EdgeStopTest() override { Ip({"netns", "del", name_}); }

  static bool Ip(std::vector<std::string> arguments) {
    return RunToEnd({kIp, std::move(arguments), {}, {}}, kPatience).status == 0;
  }
  bool InNetwork(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"-n", name_});
    return Ip(std::move(arguments));
  }
  /// An edge in that network, whose disk is stuck and whose camera's library can take it along.
  Command StuckEdge() const {
    Command edge =
        OnCameras({"--record", file_, "--set", "source.depth_camera.expert.own_process=false"});
    edge.arguments.insert(edge.arguments.begin(), {"netns", "exec", name_, edge.program.string()});
    edge.program = kIp;
    edge.environment.insert(edge.environment.end(),
                            {"CYCLONEDDS_URI=file://" + profile_.string(), "LD_PRELOAD=" STUCK_DISK,
                             "STUCK_DISK_NAME=copy", "STUCK_DISK_WHILE=" + stuck_.string()});
    return edge;
  }
  void MakeAllHang(Process& edge) {
    ASSERT_TRUE(WaitForSize(edge, stuck_.string() + ".reached", 0)) << edge.output();
    camera_.Plug(false);
    ASSERT_TRUE(edge.WaitForOutput("depth camera: lost", kPatience)) << edge.output();
    camera_.script.open_hangs = true;
    camera_.Plug(true);
    ASSERT_TRUE(WaitForSize(edge, camera_.hang_mark(), 0)) << edge.output();
    ASSERT_TRUE(InNetwork({"link", "set", "near", "down"}));
  }

  const std::string name_ = "iso-stop-" + std::to_string(getpid());
  const std::filesystem::path profile_ = folder_.path() / "profile.xml";
  const std::filesystem::path stuck_ = folder_.path() / "stuck";
};

TEST_F(EdgeStopTest, F38WithCameraDiskAndLinkStuckAtOnceItIsGoneWithinTheOneDeadline) {
  Process edge(StuckEdge());
  ASSERT_NO_FATAL_FAILURE(MakeAllHang(edge));
  ExpectToLeave(edge, 73, kMaxStop);
  EXPECT_THAT(edge.output(), HasSubstr("a camera did not end within"));
  EXPECT_THAT(edge.output(), HasSubstr("the disk did not end within"));
  EXPECT_THAT(edge.output(), HasSubstr("= published")) << "the counters are told all the same";
}

TEST_F(EdgeStopTest, F38StagesThatTakeAllTheirTimeDoNotAddUpAndTheRecordingIsComplete) {
  Process edge(StuckEdge());
  ASSERT_NO_FATAL_FAILURE(MakeAllHang(edge));
  const std::jthread disk([this] {
    std::this_thread::sleep_for(kDiskAnswersAfter);  // It is what this disk does.
    std::filesystem::remove(stuck_);
  });
  EXPECT_GT(ExpectToLeave(edge, 0, kMaxStop).took, kDiskAnswersAfter) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("a camera did not end within 0.4 s"))
      << "the middleware, which uses what the camera does, neither";
  EXPECT_TRUE(ReadRecording(file_).complete);
}

}  // namespace
}  // namespace isotherm::system_test
