// isotherm-edge as a process, when what it needs is missing or fails: cameras, network, a disk that
// hangs. The test plays the service manager.

#include "tests/system/edge_failure.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

TEST_F(EdgeFailureTest, F01F39WithoutItsCameraForLongItLivesOnAndTheRecordingIsOnTheDisk) {
  Process edge(OnCameras({"--record", file_}));
  ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience)) << edge.output();
  ASSERT_TRUE(WaitForSize(edge, file_, 100'000)) << edge.output();
  camera_.Plug(false);
  ASSERT_TRUE(edge.WaitForOutput("depth camera: lost", kPatience)) << edge.output();
  // With the shipped back-off.
  EXPECT_LT(manager_.LongestSilence(kFed, Seconds(15)), kWatchdogSec);
  EXPECT_TRUE(manager_.WaitForText("STATUS=the depth camera is lost", kPatience));
  EXPECT_EQ(edge.WaitForExit(Seconds(0)), std::nullopt) << edge.output();
  const RecordingContent meanwhile = ReadRecording(file_);
  EXPECT_FALSE(meanwhile.complete);
  ExpectToLeave(edge, 0);
  const RecordingContent content = ReadRecording(file_);
  EXPECT_TRUE(content.complete);
  EXPECT_EQ(meanwhile.depth.size(), content.depth.size()) << "the last frames waited for others";
  EXPECT_LE(Count(edge.output(), "opening it again"), 3) << edge.output();
}

TEST_F(EdgeFailureTest, F39WhenTheRecordingHangsTheWatchdogIsNotFedAndSigtermIsServed) {
  ASSERT_EQ(mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  // Opened, but never read: a disk that takes a little and then nothing.
  const int stuck = open((folder_.path() / "pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(stuck, 0);
  Process edge(Replay({"--record", folder_.path() / "pipe"}));
  ASSERT_TRUE(manager_.WaitFor(kFed, kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForSilence(kFed, kWatchdogSec, kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("the disk does not answer"));
  ExpectToLeave(edge, 73, kForTheDisk + kTimeToLeave);
  EXPECT_THAT(edge.output(), HasSubstr("= published")) << "the counters are told all the same";
  close(stuck);
}

TEST_F(EdgeFailureTest, F39WhenTheCamerasLibraryHangsInThisProcessTheWatchdogIsNotFed) {
  camera_.script.faults[30] = {FakeDepthFault::kStall};
  camera_.Apply();
  // Nothing else notices within this test.
  Process edge(OnCameras({"--set", "source.depth_camera.expert.stall_timeout_s=60", "--set",
                          "source.depth_camera.expert.own_process=false"}));
  ASSERT_TRUE(manager_.WaitFor(kFed, kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForSilence(kFed, kWatchdogSec, kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("sends nothing"));
}

TEST_F(EdgeFailureTest, F31ACameraThatIsNotThereAtTheStartIsWaitedFor) {
  camera_.Plug(false);
  Process edge(OnCameras({"--record", file_}));
  ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForText("STATUS=waiting for a camera", kPatience)) << edge.output();
  EXPECT_LT(manager_.LongestSilence(kFed, Seconds(8)), kWatchdogSec);
  EXPECT_EQ(Count(edge.output(), "waiting for it"), 1) << "not said at each try\n" << edge.output();
  EXPECT_FALSE(std::filesystem::exists(file_)) << "no empty file";
  camera_.Plug(true);
  ASSERT_TRUE(WaitForSize(edge, file_, 100'000)) << edge.output();
  ExpectToLeave(edge, 0);
  EXPECT_TRUE(ReadRecording(file_).complete);
}

TEST_F(EdgeFailureTest, F31AScriptIsToldAtOnceThatThereIsNoCamera) {
  camera_.Plug(false);
  EXPECT_EQ(RunToEnd(OnCameras({"--exit-at-end"}), kPatience).status, 69);
}

TEST_F(EdgeFailureTest, F38AStopWhileItWaitsForACameraIsServed) {
  camera_.Plug(false);
  Process edge(OnCameras({}));
  ASSERT_TRUE(manager_.WaitForText("STATUS=waiting for a camera", kPatience)) << edge.output();
  ExpectToLeave(edge, 0);
}

TEST_F(EdgeFailureTest, F38F39AnOpeningThatDoesNotComeBackIsNoSignOfLifeAndAStopIsServed) {
  camera_.Plug(false);
  Process edge(OnCameras({"--set", "source.depth_camera.expert.own_process=false"}));
  ASSERT_TRUE(manager_.WaitForText("STATUS=waiting for a camera", kPatience)) << edge.output();
  camera_.script.open_hangs = true;
  camera_.Plug(true);
  EXPECT_TRUE(manager_.WaitForSilence(kFed, kWatchdogSec, 2 * kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("has not come back from opening it"));
  // It leaves at that deadline, not before it, and says so (ExitDeadline::kTimeForLastWords).
  constexpr Seconds kForLastWords{0.3};
  ExpectToLeave(edge, 0, kForTheDisk + kForLastWords);
  EXPECT_THAT(edge.output(), HasSubstr("leaving without it"));
}

TEST_F(EdgeFailureTest, F31WithoutItsNetworkItRecordsAndSaysWhatIsMissing) {
  const std::filesystem::path profile = folder_.path() / "profile.xml";
  std::ofstream(profile) << "<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
                            "name=\"nowhere0\"/></Interfaces></General></Domain></CycloneDDS>";
  Command command = Replay({"--record", file_});
  command.environment.push_back("CYCLONEDDS_URI=file://" + profile.string());
  Process edge(command);
  ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForText("nowhere0", kPatience)) << edge.output();
  ASSERT_TRUE(WaitForSize(edge, file_, 100'000)) << edge.output();
  ExpectToLeave(edge, 0);
  EXPECT_LE(Count(edge.output(), "cannot join"), 1) << edge.output();
  const FrameCountersText recorded = CountersOf(edge.output(), Sensor::kDepth, "recorded");
  EXPECT_TRUE(recorded.Closes());
  EXPECT_EQ(recorded.done, recorded.captured);
  EXPECT_TRUE(CountersOf(edge.output(), Sensor::kDepth, "published").Closes());
  EXPECT_TRUE(ReadRecording(file_).complete);
  command.arguments.push_back("--exit-at-end");
  EXPECT_EQ(RunToEnd(command, kPatience).status, 69);
}

}  // namespace
}  // namespace isotherm::system_test
