// isotherm-edge on cameras, as a process: the genuine OpenNI2 library with a driver whose camera is
// unplugged, exchanged, crashes and hangs as a script says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "common/testing/temporary_directory.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/openni/testing/record_oni.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CamerasTest : public ::testing::Test {
 protected:
  Command Edge(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "--source", "cameras", "--set", "source.thermal_camera.enabled=false", "--domain",
        std::to_string(OwnDomain()),
        // The fake driver reads there what it shall do.
        "--set", "source.camera_sandbox.expert.read=\"" + folder_.path().string() + "\"", "--set",
        "source.camera_sandbox.expert.read=\"" + camera_.folder().string() + "\""};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {EdgeDaemon(), std::move(arguments), {"LD_LIBRARY_PATH=" FAKE_OPENNI}, {}};
  }
  std::vector<std::string> Record() const { return {"--record", file_.string()}; }

  /// Ends the daemon and checks that each frame is accounted for.
  FrameCountersText End(Process& edge) {
    edge.Signal(SIGTERM);
    EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
    const FrameCountersText recorded = CountersOf(edge.output(), Sensor::kDepth, "recorded");
    const FrameCountersText published = CountersOf(edge.output(), Sensor::kDepth, "published");
    EXPECT_TRUE(recorded.Closes()) << edge.output();
    EXPECT_TRUE(published.Closes()) << edge.output();
    const RecordingContent content = ReadRecording(file_);
    EXPECT_TRUE(content.complete);
    EXPECT_EQ(static_cast<long>(content.depth.size()), recorded.done);
    EXPECT_TRUE(std::is_sorted(
        content.depth.begin(), content.depth.end(),
        [](const StoredFrame& a, const StoredFrame& b) { return a.capture_time < b.capture_time; }))
        << "capture times rise with the frame numbers";
    return recorded;
  }
  static constexpr const char* kWorking = "depth camera: working";
  static constexpr const char* kLost = "depth camera: lost";

  const ::isotherm::testing::TemporaryDirectory folder_;
  FakeDepthCamera camera_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
};

TEST_F(CamerasTest, RecordsAndPublishesWhatTheCameraSees) {
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience)) << edge.output();
  const FrameCountersText counters = End(edge);
  EXPECT_GT(counters.done, 0);
  const RecordingContent content = ReadRecording(file_);
  ASSERT_FALSE(content.depth.empty());
  ASSERT_EQ(content.depth[0].pixels.size(), 640U * 480U);
  EXPECT_EQ(content.depth[0].pixels[100 * 640 + 200], FakePlaneMillimetres(200, 100));
  EXPECT_THAT(edge.output(), HasSubstr("nominal"));
  EXPECT_THAT(edge.output(), HasSubstr("serial=FAKE-1 mode=640x480@30"));
  EXPECT_THAT(edge.output(), HasSubstr("depth    camera failed 0 times, stamped"));
}

TEST_F(CamerasTest, F01ACameraThatIsUnpluggedIsLostAndF02UsedAgainWhenItIsBack) {
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience)) << edge.output();
  for (int time = 1; time <= 2; ++time) {
    camera_.Plug(false);
    ASSERT_TRUE(edge.WaitForOutput(kLost, kPatience, time)) << edge.output();
    camera_.Plug(true);
    ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience, time + 1)) << edge.output();
  }
  End(edge);
  EXPECT_THAT(edge.output(), HasSubstr("it was unplugged"));
  EXPECT_THAT(edge.output(), HasSubstr("depth    camera failed 2 times"));
}

TEST_F(CamerasTest, F03AnotherCameraInItsPlaceIsNotUsed) {
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience)) << edge.output();
  camera_.Plug(false);
  ASSERT_TRUE(edge.WaitForOutput(kLost, kPatience)) << edge.output();
  camera_.script.serial = "FAKE-2";
  camera_.Plug(true);
  ASSERT_TRUE(edge.WaitForOutput("serial number \"FAKE-2\" is not used", kPatience))
      << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(0.0)));
  camera_.Plug(false);
  camera_.script.serial = "FAKE-1";
  camera_.Plug(true);
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience, 2)) << edge.output();
  End(edge);
}

TEST_F(CamerasTest, F11BadFramesAreCountedAndTenInARowOpenTheCameraAgain) {
  camera_.script.faults[40] = {FakeDepthFault::kShort, 1'000'000, 0};
  camera_.Apply();
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput("10 bad frames in a row", kPatience)) << edge.output();
  camera_.script.faults.clear();
  camera_.Apply();
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience, 2)) << edge.output();
  EXPECT_GE(End(edge).rejected, 10);
}

TEST_F(CamerasTest, F13ACoveredCameraIsBlind) {
  const std::filesystem::path dark = folder_.path() / "dark.raw";
  std::ofstream(dark, std::ios::binary) << std::string(640 * 480 * 2, '\0');
  camera_.script.pixels = dark;
  camera_.Apply();
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput("depth camera: blind", kPatience)) << edge.output();
  EXPECT_GT(End(edge).done, 0) << "blind frames are recorded";
}

TEST_F(CamerasTest, F14ALibraryThatCrashesTakesOnlyItsOwnProcessDown) {
  camera_.script.faults[40].fault = FakeDepthFault::kCrash;
  camera_.Apply();
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput("ended by signal 11", kPatience)) << edge.output();
  camera_.script.faults.clear();
  camera_.Apply();
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience, 2)) << edge.output();
  End(edge);
}

TEST_F(CamerasTest, F14ALibraryThatHangsIsReplaced) {
  camera_.script.faults[40].fault = FakeDepthFault::kHang;
  camera_.Apply();
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput("its library hung for 2.0 s and was killed", kPatience))
      << edge.output();
  camera_.script.faults.clear();
  camera_.Apply();
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience, 2)) << edge.output();
  End(edge);
}

TEST_F(CamerasTest, F14TheCamerasProcessDoesNotOutliveTheDaemon) {
  Process edge(Edge(Record()));
  ASSERT_TRUE(edge.WaitForOutput(kWorking, kPatience)) << edge.output();
  const std::vector<pid_t> children = ChildrenOf(edge.pid());
  ASSERT_EQ(children.size(), 1U);
  edge.Signal(SIGKILL);
  ASSERT_TRUE(edge.WaitForExit(kPatience));
  const auto end = std::chrono::steady_clock::now() + kPatience;
  // A zombie that nobody has collected yet has no memory map.
  const std::filesystem::path maps = "/proc/" + std::to_string(children[0]) + "/maps";
  const auto runs = [&maps] {
    return !std::ifstream(maps).eof() && std::ifstream(maps).peek() > 0;
  };
  while (runs() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  EXPECT_FALSE(runs());
}

TEST_F(CamerasTest, AStallIsFoundInTheCamerasProcess) {
  camera_.script.faults[40].fault = FakeDepthFault::kStall;
  camera_.Apply();
  Process edge(Edge(
      {"--record", file_.string(), "--set", "source.depth_camera.expert.stall_timeout_s=0.5"}));
  ASSERT_TRUE(edge.WaitForOutput("no frame for 0.", kPatience)) << edge.output();
  End(edge);
}

TEST_F(CamerasTest, AnOniFileIsPlayedInAProcessOfItsOwnAndNoFrameOfItIsLost) {
  constexpr int kFrames = 40;
  const std::filesystem::path oni = folder_.path() / "scan.oni";
  const Status recorded_file = RecordOni(oni, kFrames);
  ASSERT_TRUE(recorded_file.ok()) << recorded_file.message();
  const Finished edge = RunToEnd(Edge({"--record", file_.string(), "--depth-camera", oni.string(),
                                       "--rate", "0", "--exit-at-end"}),
                                 kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("is confined to its camera"));
  EXPECT_THAT(edge.output, Not(HasSubstr("signal")));
  const FrameCountersText counters = CountersOf(edge.output, Sensor::kDepth, "recorded");
  EXPECT_TRUE(counters.Closes()) << edge.output;
  EXPECT_EQ(counters.done, counters.captured);
  const RecordingContent content = ReadRecording(file_);
  ASSERT_GE(content.depth.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < content.depth.size(); ++i) {
    EXPECT_EQ(content.depth[i].frame_number, i);
    ASSERT_EQ(content.depth[i].pixels.size(), 320U * 240U);
    EXPECT_EQ(content.depth[i].pixels[100 * 320 + 200], FakePlaneMillimetres(200, 100));
  }
}

TEST_F(CamerasTest, F11AnOniFileThatIsGarbageIsRefusedWithASentence) {
  const std::filesystem::path oni = folder_.path() / "garbage.oni";
  std::ofstream(oni, std::ios::binary) << "NI10" << std::string(100'000, '\xFF');
  const Finished edge = RunToEnd(Edge({"--record", file_.string(), "--depth-camera", oni.string(),
                                       "--rate", "0", "--exit-at-end"}),
                                 kPatience);
  EXPECT_GT(edge.status, 0) << edge.output;
  EXPECT_LT(edge.status, 128) << "ended by a signal: " << edge.output;
  EXPECT_THAT(edge.output, HasSubstr("depth camera"));
}

TEST_F(CamerasTest, TheListShowsTheCamera) {
  const Finished list =
      RunToEnd({EdgeDaemon(), {"--list-devices"}, {"LD_LIBRARY_PATH=" FAKE_OPENNI}, {}}, kPatience);
  EXPECT_EQ(list.status, 0);
  EXPECT_THAT(list.output, HasSubstr("openni2, Isotherm Fake Depth Camera, serial FAKE-1"));
  EXPECT_THAT(list.output, HasSubstr("640x480@30 1 mm"));
  EXPECT_THAT(list.output, HasSubstr("thermal cameras:"));
}

TEST_F(CamerasTest, WithoutAnyCameraAScriptIsTold) {
  camera_.Plug(false);
  const Finished edge = RunToEnd(Edge({"--exit-at-end"}), kPatience);
  EXPECT_EQ(edge.status, 69);
  EXPECT_THAT(edge.output, HasSubstr("no depth camera is connected"));
}

TEST_F(CamerasTest, AModeThatTheCameraLacksEndsTheStart) {
  const Finished edge =
      RunToEnd(Edge({"--set", "source.depth_camera.expert.rate_hz=25"}), kPatience);
  EXPECT_EQ(edge.status, 64);
  EXPECT_THAT(edge.output, HasSubstr("the camera has no mode 640x480@25 1 mm; it has 640x480@30"));
}

}  // namespace
}  // namespace isotherm::system_test
