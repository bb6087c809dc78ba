// isotherm-edge as a black box on an emulated thermal camera: the genuine libusb in the daemon,
// and a USB bus in this process whose camera misbehaves as a script says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "common/codec/codec.h"
#include "common/testing/temporary_directory.h"
#ifdef FAKE_OPENNI
#include "edge/openni/testing/fake_depth_camera.h"
#endif
#include "edge/source/missed_frames.h"
#include "edge/thermal_camera/testing/emulated_lepton.h"
#include "edge/thermal_camera/testing/emulated_seek.h"
#include "edge/usb/testing/emulated_bus.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRefused = 69;  // EX_UNAVAILABLE of sysexits.h.

class ThermalDaemonTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = EmulatedBus::Missing()) GTEST_SKIP() << *reason;
    bus_.emplace();
    bus_->ExpectChild();
  }

  Command Edge(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "--source", "cameras", "--set", "source.depth_camera.enabled=false",
        // Where a fake depth camera reads what it shall do.
        "--set", "source.camera_sandbox.expert.read=\"" + folder_.path().string() + "\"", "--set",
        // The emulated bus answers for /dev itself, also to those who only want to name it.
        "source.camera_sandbox.expert.enabled=false", "--record", file_.string(), "--domain",
        std::to_string(OwnDomain())};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {EdgeDaemon(), std::move(arguments), {}, {}};
  }

  /// Ends the daemon and checks that each frame is accounted for.
  FrameCountersText End(Process& edge) {
    edge.Signal(SIGTERM);
    EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
    const FrameCountersText counters = CountersOf(edge.output(), Sensor::kThermal, "recorded");
    EXPECT_GT(counters.captured, 0) << edge.output();
    EXPECT_TRUE(counters.Closes()) << edge.output();
    const RecordingContent content = ReadRecording(file_);
    EXPECT_TRUE(content.complete);
    EXPECT_EQ(static_cast<long>(content.thermal.size()), counters.done);
    return counters;
  }

  /// Every thermal frame says that it holds counts, and none that it is valid.
  void ExpectRecordedCounts() const {
    const auto reader = RecordingReader::Open(file_);
    ASSERT_TRUE(reader.has_value()) << reader.error().message();
    int frames = 0;
    while (true) {
      const auto item = (*reader)->Next();
      ASSERT_TRUE(item.has_value()) << item.error().message();
      if (!*item) break;
      const auto* thermal = std::get_if<RecordedThermal>(&**item);
      if (thermal == nullptr) continue;
      ++frames;
      EXPECT_EQ(thermal->frame.image.encoding, Encoding::kCounts16);
      EXPECT_FALSE(thermal->frame.valid);
      const auto counts = Decode(thermal->frame.image);
      ASSERT_TRUE(counts.has_value());
      // Within the emulated ramp, or the shutter against itself.
      EXPECT_GE(counts->At(100, 50), kSeekMiddle);
      EXPECT_LE(counts->At(100, 50), kSeekMiddle + 100 + EmulatedSeek::kNoise);
    }
    EXPECT_GT(frames, 0);
  }
  static Finished Nuc() {
    return RunToEnd({Tool(), {"nuc", "--now", "--domain", std::to_string(OwnDomain())}, {}, {}},
                    kPatience);
  }
  /// No image may be valid that repeats the one before more than three times in a row.
  void ExpectFrozenFramesAreInvalid() const {
    const auto recording = RecordingReader::Open(file_);
    ASSERT_TRUE(recording.has_value());
    int repeats = 0;
    int frozen = 0;
    std::vector<std::uint8_t> last;
    while (true) {
      const Result<std::optional<RecordedItem>> item = (*recording)->Next();
      ASSERT_TRUE(item.has_value());
      if (!*item) break;
      const auto* thermal = std::get_if<RecordedThermal>(&**item);
      if (thermal == nullptr) continue;
      repeats = thermal->frame.image.payload == last ? repeats + 1 : 0;
      last = thermal->frame.image.payload;
      if (repeats == 0) continue;
      ++frozen;
      EXPECT_FALSE(thermal->frame.valid) << "frame " << thermal->frame.header.frame_number;
    }
    EXPECT_GE(frozen, 10) << "two seconds of them";
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
  std::optional<EmulatedBus> bus_;
};

TEST_F(ThermalDaemonTest, F04UnpluggedInMidFrameTheScanGoesOnWhenItIsBack) {
  // Longer away than a service manager waits for a sign of life.
  bus_->Plug(std::make_shared<EmulatedLepton>("20*f unplug:11000 f"));
  NotifySocket manager(folder_.path());
  Command command = Edge();
  command.environment.insert(command.environment.end(),
                             {manager.environment(), "WATCHDOG_USEC=10000000"});
  Process edge(command);
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("serial=\"LEPTON-1\"", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("was unplugged", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: lost", kPatience)) << edge.output();
  EXPECT_LT(manager.LongestSilence("WATCHDOG=1", Seconds(10.5)), Seconds(10));
  EXPECT_TRUE(manager.WaitForText("STATUS=the thermal camera is lost", kPatience));
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience, 2)) << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(1.5)).has_value());
  const FrameCountersText counters = End(edge);
  EXPECT_GE(counters.done, 20 + 4) << edge.output();
  // The camera's counter stood still meanwhile: its frames must not be stamped as if it had gone
  // on.
  EXPECT_THAT(edge.output(), Not(HasSubstr("UNSYNCHRONISED")));
}

TEST_F(ThermalDaemonTest, F11DamagedFramesAreRefusedAndCounted) {
  bus_->Plug(std::make_shared<EmulatedLepton>("4*f f:short f f:head f f:error f f:lost f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("has no pixels", kPatience)) << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(2.5)).has_value());
  EXPECT_EQ(End(edge).rejected, 4) << edge.output();
}

TEST_F(ThermalDaemonTest, F09AFlippedBitOfTheFrameCounterCostsNoFrameAndNoNumbers) {
  const auto camera = std::make_shared<EmulatedLepton>("8*f f:flip f");
  bus_->Plug(camera);
  Process edge(Edge({"--set", "nuc.before_scan=false"}));
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience)) << edge.output();
  while (camera->frames() < 20) {
    ASSERT_FALSE(edge.WaitForExit(Seconds(0.1)).has_value()) << edge.output();
  }
  const FrameCountersText counters = End(edge);
  EXPECT_EQ(counters.done, counters.captured) << edge.output();
  const std::vector<StoredFrame> frames = ReadRecording(file_).thermal;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].frame_number, frames[i - 1].frame_number);
  }
  // A busy computer may lose some on the emulated bus; 2^24 / 3 would be the flipped bit.
  EXPECT_LT(frames.back().frame_number, frames.size() + MissedFrames::kMaxMissed);
}

TEST_F(ThermalDaemonTest, F05FrozenFramesAreNotValidAndTheCameraIsOpenedAgainAfterTwoSeconds) {
  bus_->Plug(std::make_shared<EmulatedLepton>("12*f 40*f:freeze f"));
  Process edge(Edge({"--set", "nuc.before_scan=false"}));
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("the image is frozen", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("sends the same image for 2.", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience, 2)) << edge.output();
  End(edge);
  ExpectFrozenFramesAreInvalid();
}

/// The same when the source is more patient than the policy of corrections: that one's order to
/// restart goes through the camera's thread.
TEST_F(ThermalDaemonTest, F05FrozenCameraIsRestartedByOrder) {
  bus_->Plug(std::make_shared<EmulatedLepton>("12*f 30*f:freeze f"));
  Process edge(Edge({"--set", "nuc.before_scan=false", "--set", "nuc.expert.frozen_restart_s=2",
                     "--set", "source.thermal_camera.expert.stall_timeout_s=60"}));
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("thermal frames are frozen", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("the thermal camera is restarted", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience, 2)) << edge.output();
  EXPECT_THAT(edge.output(), Not(HasSubstr("sends the same image")));
  End(edge);
  ExpectFrozenFramesAreInvalid();
}

TEST_F(ThermalDaemonTest, F08CorrectionThatNeverEndsIsReportedAndDoesNotEndTheScan) {
  const auto camera = std::make_shared<EmulatedLepton>("6*f f:nuc");
  bus_->Plug(camera);
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  // Within ten seconds: after nuc.expert.max_duration_s.
  ASSERT_TRUE(
      edge.WaitForOutput("the correction does not end: the shutter is closed for 5.", kPatience))
      << edge.output();
  EXPECT_GE(End(edge).done, 40) << edge.output();
  EXPECT_LE(camera->corrections(), 1) << "no order on top";
}

TEST_F(ThermalDaemonTest, AnOrderIsAnsweredWithWhatTheCameraSays) {
  const auto camera = std::make_shared<EmulatedLepton>("f");
  bus_->Plug(camera);
  Process edge(Edge({"--set", "nuc.before_scan=false"}));
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience)) << edge.output();
  const Finished done = Nuc();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_THAT(done.output, HasSubstr("edge: the camera has the order"));
  EXPECT_EQ(camera->corrections(), 1);
  EXPECT_TRUE(edge.WaitForOutput("shutter closed as ordered", kPatience)) << edge.output();
  End(edge);
}

TEST_F(ThermalDaemonTest, AnOrderThatTheCameraRefusesIsAnsweredWithItsWords) {
  const auto camera = std::make_shared<EmulatedLepton>("2*f stall f");
  bus_->Plug(camera);
  Process edge(Edge({"--set", "nuc.before_scan=false"}));
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience)) << edge.output();
  const Finished refused = Nuc();
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.output, AllOf(HasSubstr("edge failed: starting a correction"),
                                    HasSubstr("the device refuses (stall)")));
  EXPECT_EQ(camera->corrections(), 0);
  EXPECT_THAT(edge.output(), HasSubstr("correction refused (attempt 1 of 3)"));
  End(edge);
}

TEST_F(ThermalDaemonTest, ACameraThatTakesNoOrdersRefusesWithItsReason) {
  bus_->Plug(std::make_shared<EmulatedSeek>("f"));
  Process edge(Edge({"--set", "nuc.before_scan=true", "--set", "nuc.expert.min_interval_s=0.5"}));
  bus_->SetChild(edge.pid());
  // It closes its shutter when it starts, and that is the correction before the scan.
  ASSERT_TRUE(edge.WaitForOutput("shutter open after", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("NUC idle", kPatience)) << edge.output();
  const Finished refused = Nuc();
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.output,
              AllOf(HasSubstr("edge refuses: "), HasSubstr("closes its shutter when it sees fit")));
  End(edge);
}

TEST_F(ThermalDaemonTest, F03ACameraThatTheCalibrationIsNotOfIsNotUsed) {
  const std::filesystem::path rig = folder_.path() / "rig.textproto";
  std::ofstream(rig) << "thermal { width: 160 height: 120 fx: 150 fy: 150 cx: 79.5 cy: 59.5 }\n"
                     << "thermal_serial: \"LEPTON-1\"\n";
  bus_->Plug(std::make_shared<EmulatedLepton>("f", "LEPTON-2"));
  Process edge(Edge({"--rig", rig.string()}));
  bus_->SetChild(edge.pid());
  EXPECT_TRUE(
      edge.WaitForOutput("\"LEPTON-2\" is not used: the calibration is of \"LEPTON-1\"", kPatience))
      << edge.output();
  // Somebody may plug in the right one.
  EXPECT_FALSE(edge.WaitForExit(Seconds(1.5)).has_value());
  EXPECT_THAT(edge.output(), Not(HasSubstr("thermal camera: working")));
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
}

TEST_F(ThermalDaemonTest, TheRecordingSaysWhatTheCameraIs) {
  bus_->Plug(std::make_shared<EmulatedLepton>("f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience)) << edge.output();
  End(edge);
  const auto recording = RecordingReader::Open(file_);
  ASSERT_TRUE(recording.has_value());
  const auto cameras = (*recording)->info().metadata.at("cameras");
  EXPECT_THAT(cameras.at("thermal"), HasSubstr("lepton-uvc, "));
  EXPECT_EQ(cameras.at("thermal_serial"), "LEPTON-1");
  EXPECT_EQ(cameras.at("thermal_mode"), "160x120@8.7");
}

TEST_F(ThermalDaemonTest, F03AnotherSerialIsRefusedWithASentence) {
  bus_->Plug(std::make_shared<EmulatedLepton>("f", "LEPTON-2"));
  Process edge(Edge({"--set", "source.thermal_camera.serial=\"LEPTON-1\""}));
  bus_->SetChild(edge.pid());
  EXPECT_TRUE(edge.WaitForOutput("\"LEPTON-1\" is not connected", kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("lepton-uvc with serial \"LEPTON-2\" at 1-1"));
}

TEST_F(ThermalDaemonTest, CountsAreRecordedAsCountsAndF04UnpluggingIsSurvived) {
  bus_->Plug(std::make_shared<EmulatedSeek>("6*f unplug:700 3*f f:nuc f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("sends counts, not temperatures", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("the device is gone", kPatience)) << edge.output();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (edge.output().find("opened", edge.output().find("device is gone")) == std::string::npos &&
         std::chrono::steady_clock::now() < end) {
    ASSERT_FALSE(edge.WaitForExit(Seconds(0.1)).has_value()) << edge.output();
  }
  EXPECT_FALSE(edge.WaitForExit(Seconds(2.0)).has_value());
  EXPECT_GE(End(edge).done, 7 + 8) << edge.output();
  ExpectRecordedCounts();

  const Finished inspected = RunToEnd({Tool(), {"inspect", file_}, {}}, kPatience);
  EXPECT_EQ(inspected.status, 0);
  EXPECT_THAT(inspected.output, HasSubstr("counts (no temperatures)"));
  const std::filesystem::path image = folder_.path() / "counts.png";
  EXPECT_EQ(
      RunToEnd({Tool(), {"inspect", file_, "--render", "2", "-o", image}, {}}, kPatience).status,
      0);
  EXPECT_TRUE(std::filesystem::exists(image));
}

#ifdef FAKE_OPENNI
TEST_F(ThermalDaemonTest, GroundSaysThatThereAreCountsOnlyAndGeometryGoesOn) {
  FakeDepthCamera depth;
  bus_->Plug(std::make_shared<EmulatedSeek>("f"));
  Command ground_command{
      GroundService(),
      {"--once", "--domain", std::to_string(OwnDomain()), "--output", folder_.path() / "ground"},
      {},
      {}};
  const std::vector<std::string> quick = QuickScan();
  ground_command.arguments.insert(ground_command.arguments.end(), quick.begin(), quick.end());
  Process ground(ground_command);
  Command edge_command = Edge({"--set", "source.depth_camera.enabled=true"});
  edge_command.environment = {"LD_LIBRARY_PATH=" FAKE_OPENNI};
  Process edge(edge_command);
  bus_->SetChild(edge.pid());
  EXPECT_TRUE(ground.WaitForOutput("geometry goes on", kPatience)) << ground.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(1.0)).has_value());
  End(edge);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  const auto stats = ReadStats(folder_.path() / "ground");
  EXPECT_GT(NumberAt(stats, {"frames", "depth", "tracked"}), 0);
  EXPECT_EQ(NumberAt(stats, {"frames", "thermal", "fused"}), 0);
  EXPECT_EQ(NumberAt(stats, {"frames", "thermal", "left_out_by_reason", "counts"}),
            NumberAt(stats, {"frames", "thermal", "in"}));
}
#endif

TEST_F(ThermalDaemonTest, ListsConnectedCameras) {
  bus_->Plug(std::make_shared<EmulatedLepton>("f"));
  Process edge({EdgeDaemon(), {"--list-devices"}, {}, {}});
  bus_->SetChild(edge.pid());
  EXPECT_EQ(edge.WaitForExit(kPatience), 0);
  EXPECT_THAT(edge.output(), HasSubstr("lepton-uvc"));
  EXPECT_THAT(edge.output(), HasSubstr("LEPTON-1"));
}

}  // namespace
}  // namespace isotherm::system_test
