// isotherm-edge with a depth camera and a thermal one whose vendors' libraries, each in a process
// of its own, are fakes that crash and hang when they are told to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <string>
#include <vector>

#include "common/base/pause.h"
#include "common/testing/temporary_directory.h"
#include "common/time/clock.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/usb/testing/emulated_bus.h"
#include "tests/support/departure.h"
#include "tests/support/machine_load.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRefused = 69;  // EX_UNAVAILABLE of sysexits.h.
/// Until frames come again: failure F14. It is about 0.8 s where nothing else runs, 0.5 s of it the
/// wait before a camera is opened again.
constexpr double kBackAfterCrash_s = 2.0;
/// Until a lost camera is noticed: failure F01.
constexpr double kNoticed_s = 1.0;
/// How long a camera is away: longer than a service manager waits for a sign of life.
constexpr std::chrono::seconds kOutage{11};
/// Frames whose fate may not be seen in the recording's numbers: those under way at its end.
constexpr std::uint64_t kMaxUnderWay = 32;
constexpr double kDepthRate_hz = 30.0;
/// Until frames come from a camera that was plugged in again: failure F02.
constexpr double kBackAfterReplug_s = 5.0;
/// Ten times a frame's period and more: nothing but a busy computer.
constexpr double kUninterrupted_s = 0.5;
/// Until the daemon is gone when it is told to stop.
constexpr double kPromptly_s = 2.0;

/// As much of an Optris camera as one sees without the vendor's library: that it is plugged in.
class PluggedOptris final : public EmulatedDevice {
 public:
  EmulatedIdentity identity() const override {
    EmulatedIdentity identity;
    identity.vendor_id = 0x0403;
    identity.product_id = 0xde37;
    identity.product = "PI IMAGER";
    identity.serial = "12345";
    identity.configuration = {9, 2, 18, 0, 1, 1,    0, 0x80, 50,  // One interface
                              9, 4, 0,  0, 0, 0xFF, 0, 0,    0};  // without endpoints.
    return identity;
  }
  std::optional<std::vector<std::uint8_t>> Control(const UsbControl&, Bytes, std::size_t) override {
    return std::nullopt;
  }
  void SetAlternate(int, int) override {}
  EmulatedPacket Isochronous(std::uint8_t, Nanoseconds, std::size_t) override { return {}; }
  std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t, Nanoseconds, std::size_t) override {
    return std::nullopt;
  }
  std::optional<Unplugged> TakeUnplugged() override { return std::nullopt; }
};

class BothCamerasTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = EmulatedBus::Missing()) GTEST_SKIP() << *reason;
    bus_.emplace();
    // The process that uses the library looks whether the camera is there.
    bus_->FindChild([this]() -> std::optional<pid_t> {
      for (const pid_t child : ChildrenOf(edge_pid_)) {
        if (CommandLineOf(child).find("--camera-process\0thermal"s) != std::string::npos)
          return child;
      }
      return std::nullopt;
    });
    bus_->Plug(std::make_shared<PluggedOptris>());
    Script("");
  }

  /// Sets what the library does from its next opening on.
  void Script(const std::string& words) const {
    const std::filesystem::path next = config_.string() + ".next";
    std::ofstream(next) << words << "\n";
    std::filesystem::rename(next, config_);
  }
  Command Edge() const {
    return {EdgeDaemon(),
            {"--source", "cameras", "--record", file_.string(), "--domain",
             std::to_string(OwnDomain()), "--set", "source.thermal_camera.driver=OPTRIS_SDK",
             "--set", "source.thermal_camera.expert.optris_library=\"" FAKE_OPTRIS "\"", "--set",
             "source.thermal_camera.expert.optris_config=\"" + config_.string() + "\"", "--set",
             // The emulated bus answers for /dev itself, also to those who only want to name it.
             "source.camera_sandbox.expert.enabled=false", "--set", "nuc.before_scan=false"},
            {"LD_LIBRARY_PATH=" FAKE_OPENNI},
            {}};
  }
  /// A running edge with both cameras at work.
  void Start(Process& edge) {
    edge_pid_ = edge.pid();
    ASSERT_TRUE(edge.WaitForOutput("depth camera: working", kPatience)) << edge.output();
    working_since_ = clock_.SteadyNow();
    ASSERT_TRUE(edge.WaitForOutput(kThermalWorks, kPatience)) << edge.output();
  }
  static Finished Nuc() {
    return RunToEnd({Tool(), {"nuc", "--now", "--domain", std::to_string(OwnDomain())}, {}, {}},
                    kPatience);
  }
  RecordingContent End(Process& edge) {
    told_ = clock_.SteadyNow();
    edge.Signal(SIGTERM);
    EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal})
      EXPECT_TRUE(CountersOf(edge.output(), sensor, "recorded").Closes()) << edge.output();
    RecordingContent content = ReadRecording(file_);
    EXPECT_TRUE(content.complete);
    EXPECT_FALSE(content.depth.empty());
    return content;
  }
  /// The depth camera loses nothing because of the other one: each number is recorded or counted as
  /// lost, and none is lost unless others took the processors.
  void ExpectDepthLosesNothing(const std::vector<StoredFrame>& frames,
                               const std::string& output) const {
    const FrameCountersText counters = CountersOf(output, Sensor::kDepth, "recorded");
    const std::uint64_t missing = frames.back().frame_number + 1 - frames.size();
    const auto counted = static_cast<std::uint64_t>(counters.captured - counters.done +
                                                    LostInCamera(output, Sensor::kDepth));
    EXPECT_GE(counted, missing) << output;
    EXPECT_LE(counted, missing + kMaxUnderWay) << output;
    const double made = static_cast<double>(frames.back().frame_number + 1);
    EXPECT_LE(static_cast<double>(missing), load_.excused_fraction() * made)
        << load_.ToText() << output;
    // By the clock of the test: from when the camera was seen working to when the edge was told to
    // leave, a frame each 33 ms.
    EXPECT_GE(made + static_cast<double>(kMaxUnderWay),
              kDepthRate_hz * ToSeconds(told_ - working_since_))
        << "the camera stood still at the beginning or the end\n"
        << output;
  }
  /// The longest time without a frame, seconds.
  static double LongestGap_s(const std::vector<StoredFrame>& frames) {
    double longest_s = 0.0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      longest_s =
          std::max(longest_s, ToSeconds(frames[i].capture_time - frames[i - 1].capture_time));
    }
    return longest_s;
  }

  static constexpr const char* kThermalWorks = "thermal camera: working";

  const SystemClock clock_{};
  const MachineLoad load_;
  const ::isotherm::testing::TemporaryDirectory folder_;
  FakeDepthCamera depth_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
  const std::filesystem::path config_ = folder_.path() / "pi450.xml";
  std::atomic<pid_t> edge_pid_{0};
  SteadyTime working_since_{};  ///< The depth camera.
  SteadyTime told_{};           ///< To leave.
  std::optional<EmulatedBus> bus_;
};

TEST_F(BothCamerasTest, FramesOfBothAreRecordedWithWhatTheCamerasAre) {
  Process edge(Edge());
  Start(edge);
  const RecordingContent content = End(edge);
  ASSERT_FALSE(content.thermal.empty());
  ASSERT_EQ(content.thermal[0].pixels.size(), 12U);
  // (1250..1256 - 1000) / 10 degrees Celsius.
  EXPECT_GE(content.thermal[0].pixels[0], 27'315 + 2'500);
  EXPECT_LE(content.thermal[0].pixels[0], 27'315 + 2'560);
  EXPECT_THAT(edge.output(), HasSubstr("thermal camera optris-sdk opened"));
  EXPECT_THAT(edge.output(), HasSubstr("serial=\"12345\""));
  EXPECT_THAT(edge.output(), Not(HasSubstr("is not confined")));
  const auto recording = RecordingReader::Open(file_);
  ASSERT_TRUE(recording.has_value());
  const auto cameras = (*recording)->info().metadata.at("cameras");
  EXPECT_THAT(cameras.at("thermal"), HasSubstr("optris-sdk, "));
  EXPECT_EQ(cameras.at("thermal_serial"), "12345");
  EXPECT_THAT(cameras.at("thermal_mode"), HasSubstr("4x3@"));
  EXPECT_THAT(cameras.at("depth"), HasSubstr("openni2, "));
  EXPECT_EQ(cameras.at("depth_serial"), "FAKE-1");
}

TEST_F(BothCamerasTest, F01WithoutTheDepthCameraThermalIsRecordedOnAndF02ItComesBackIntoTheScan) {
  Process edge(Edge());
  Start(edge);
  const SteadyTime unplugged = clock_.SteadyNow();
  depth_.Plug(false);
  ASSERT_TRUE(edge.WaitForOutput("it was unplugged", kPatience)) << edge.output();
  EXPECT_LT(ToSeconds(clock_.SteadyNow() - unplugged), kNoticed_s);
  ASSERT_TRUE(edge.WaitForOutput("depth camera: lost", kPatience)) << edge.output();
  // Longer than any watchdog's patience.
  Pause({}, kOutage);
  const SteadyTime replugged = clock_.SteadyNow();
  depth_.Plug(true);
  ASSERT_TRUE(edge.WaitForOutput("depth camera: working", kPatience, 2)) << edge.output();
  EXPECT_LT(ToSeconds(clock_.SteadyNow() - replugged), kBackAfterReplug_s);
  const RecordingContent content = End(edge);
  EXPECT_GE(LongestGap_s(content.depth), ToSeconds(kOutage));
  EXPECT_LT(LongestGap_s(content.thermal), kUninterrupted_s);
  EXPECT_THAT(edge.output(), Not(HasSubstr("thermal camera: lost")));
  const std::string session = "session=";
  EXPECT_EQ(edge.output().find(session), edge.output().rfind(session)) << "one session";
}

TEST_F(BothCamerasTest, F14ALibraryThatCrashesTakesOnlyItsProcessDownAndDepthLosesNothing) {
  Script("crash 30");
  Process edge(Edge());
  Start(edge);
  ASSERT_TRUE(edge.WaitForOutput("ended by signal 6", kPatience)) << edge.output();
  Script("");
  ASSERT_TRUE(edge.WaitForOutput(kThermalWorks, kPatience, 2)) << edge.output();
  const RecordingContent content = End(edge);
  ExpectDepthLosesNothing(content.depth, edge.output());
  if (load_.is_busy()) GTEST_SKIP() << load_.ToText() << ": all was assessed but times";
  EXPECT_LT(LongestGap_s(content.thermal), kBackAfterCrash_s);
}

TEST_F(BothCamerasTest, F14ALibraryThatHangsIsReplacedAndDepthLosesNothing) {
  Script("hang 30");
  Process edge(Edge());
  Start(edge);
  ASSERT_TRUE(edge.WaitForOutput("its library hung for 2.0 s and was killed", kPatience))
      << edge.output();
  Script("");
  ASSERT_TRUE(edge.WaitForOutput(kThermalWorks, kPatience, 2)) << edge.output();
  const RecordingContent content = End(edge);
  EXPECT_GE(LongestGap_s(content.thermal), 2.0);
  ExpectDepthLosesNothing(content.depth, edge.output());
  if (load_.is_busy()) GTEST_SKIP() << load_.ToText() << ": all was assessed but times";
  EXPECT_LT(LongestGap_s(content.thermal), 2.0 + kBackAfterCrash_s);
}

/// The kernel waits for a device in the process's name: nobody can end it.
TEST_F(BothCamerasTest, F38AStopIsPromptAlthoughACamerasProcessCannotBeEnded) {
  Process edge(Edge());
  Start(edge);
  pid_t camera = -1;
  for (const pid_t child : ChildrenOf(edge.pid())) {
    if (CommandLineOf(child).find("--camera-process\0depth"s) != std::string::npos) camera = child;
  }
  ASSERT_GT(camera, 0);
  // Only the process that traces another one can take its end.
  if (::ptrace(PTRACE_SEIZE, camera, nullptr, nullptr) != 0) {
    GTEST_SKIP() << "processes may not be traced here";
  }
  const Departure departure = Leave(edge, SIGTERM, kPatience);
  ::waitpid(camera, nullptr, __WALL);
  EXPECT_EQ(departure.status, 0) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("does not end although it was killed"));
  EXPECT_TRUE(ReadRecording(file_).complete);
  EXPECT_LT(departure.own().count(), kPromptly_s) << departure.ToText();
}

TEST_F(BothCamerasTest, AnOrderIsAnsweredWithWhatTheLibrarySays) {
  Process edge(Edge());
  Start(edge);
  const Finished done = Nuc();
  EXPECT_EQ(done.status, 0) << done.output;
  EXPECT_THAT(done.output, HasSubstr("edge: the camera has the order"));
  EXPECT_TRUE(edge.WaitForOutput("shutter closed as ordered", kPatience)) << edge.output();
  End(edge);
}

TEST_F(BothCamerasTest, AnOrderThatTheLibraryRefusesIsAnsweredWithItsWords) {
  Script("refuse");
  Process edge(Edge());
  Start(edge);
  const Finished refused = Nuc();
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.output, HasSubstr("edge failed: the Optris shutter refuses"));
  End(edge);
}

TEST_F(BothCamerasTest, F38AStopWhileALibraryOpensItsCameraIsPrompt) {
  Script("hang-at-open");
  Process edge(Edge());
  edge_pid_ = edge.pid();
  ASSERT_TRUE(edge.WaitForOutput("the library opens its camera", kPatience)) << edge.output();
  const Departure departure = Leave(edge, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, 0) << edge.output();
  EXPECT_LT(departure.own().count(), kPromptly_s) << departure.ToText();
}

}  // namespace
}  // namespace isotherm::system_test
