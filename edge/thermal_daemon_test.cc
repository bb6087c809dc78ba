// isotherm-edge as a black box on an emulated thermal camera: the genuine libusb in the daemon,
// and a USB bus in this process whose camera misbehaves as a script says.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <string>

#include "common/codec/codec.h"
#include "common/testing/temporary_directory.h"
#ifdef FAKE_OPENNI
#include "edge/openni/fake_depth_camera.h"
#endif
#include "edge/thermal_camera/testing/emulated_lepton.h"
#include "edge/thermal_camera/testing/emulated_seek.h"
#include "edge/usb/testing/emulated_bus.h"
#include "tests/system/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

/// The numbers of "thermal  captured 100 = recorded 99 + rejected 1 + queue full 0 + failed 0".
struct Account {
  long captured = -1, recorded = -1, rejected = -1, queue_full = -1, failed = -1;
};

Account AccountOf(const std::string& output) {
  Account account;
  for (std::size_t at = output.find("thermal  captured"); at != std::string::npos;
       at = output.find("thermal  captured", at + 1)) {
    if (std::sscanf(output.c_str() + at,
                    "thermal captured %ld = recorded %ld + rejected %ld + queue full %ld + "
                    "failed %ld",
                    &account.captured, &account.recorded, &account.rejected, &account.queue_full,
                    &account.failed) == 5) {
      return account;
    }
  }
  return {};
}

class ThermalDaemonTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = EmulatedBus::Missing()) GTEST_SKIP() << *reason;
    bus_.emplace();
    bus_->ExpectChild();
  }

  Command Edge(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"--source", "cameras",
                                          "--set",    "source.depth_camera.enabled=false",
                                          "--set",    "frame_check.retry_min_s=0.1",
                                          "--set",    "frame_check.retry_max_s=0.2",
                                          "--record", file_.string(),
                                          "--domain", std::to_string(TestDomain())};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {EdgeDaemon(), std::move(arguments), {}, {}};
  }

  /// Ends the daemon and checks that each frame is accounted for.
  Account End(Process& edge) {
    edge.Signal(SIGTERM);
    EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
    const Account account = AccountOf(edge.output());
    EXPECT_GT(account.captured, 0) << edge.output();
    EXPECT_EQ(account.captured,
              account.recorded + account.rejected + account.queue_full + account.failed);
    const RecordingContent content = ReadRecording(file_);
    EXPECT_TRUE(content.complete);
    EXPECT_EQ(static_cast<long>(content.thermal.size()), account.recorded);
    return account;
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
      EXPECT_EQ(thermal->frame.image.encoding, kCounts16);
      EXPECT_FALSE(thermal->frame.valid);
      const auto counts = Decode(thermal->frame.image);
      ASSERT_TRUE(counts.has_value());
      // Within the emulated ramp, or the shutter against itself.
      EXPECT_GE(counts->At(100, 50), kSeekMiddle);
      EXPECT_LE(counts->At(100, 50), kSeekMiddle + 100 + EmulatedSeek::kNoise);
    }
    EXPECT_GT(frames, 0);
  }

  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "scan.mcap";
  std::optional<EmulatedBus> bus_;
};

TEST_F(ThermalDaemonTest, F04UnpluggedInMidFrameTheScanGoesOnWhenItIsBack) {
  bus_->Plug(std::make_shared<EmulatedLepton>("8*f unplug:700 f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("serial=\"LEPTON-1\"", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("was unplugged", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("thermal camera: working", kPatience)) << edge.output();
  // The second opening, and frames after it.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (edge.output().find("opened", edge.output().find("was unplugged")) == std::string::npos &&
         std::chrono::steady_clock::now() < end) {
    ASSERT_FALSE(edge.WaitForExit(Seconds(0.1)).has_value()) << edge.output();
  }
  EXPECT_FALSE(edge.WaitForExit(Seconds(1.5)).has_value());
  const Account account = End(edge);
  EXPECT_GE(account.recorded, 8 + 4) << edge.output();
}

TEST_F(ThermalDaemonTest, F11DamagedFramesAreRefusedAndCounted) {
  bus_->Plug(std::make_shared<EmulatedLepton>("4*f f:short f f:head f f:error f f:lost f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("has no pixels", kPatience)) << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(2.5)).has_value());
  EXPECT_EQ(End(edge).rejected, 4) << edge.output();
}

TEST_F(ThermalDaemonTest, F05FrozenCameraIsOpenedAgain) {
  bus_->Plug(std::make_shared<EmulatedLepton>("6*f 40*f:freeze f"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("the picture is frozen", kPatience)) << edge.output();
  ASSERT_TRUE(edge.WaitForOutput("sends the same picture", kPatience)) << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(1.0)).has_value());
  End(edge);
}

TEST_F(ThermalDaemonTest, F08CorrectionThatNeverEndsDoesNotEndTheScan) {
  bus_->Plug(std::make_shared<EmulatedLepton>("6*f f:nuc"));
  Process edge(Edge());
  bus_->SetChild(edge.pid());
  ASSERT_TRUE(edge.WaitForOutput("serial=\"LEPTON-1\"", kPatience)) << edge.output();
  EXPECT_FALSE(edge.WaitForExit(Seconds(4.0)).has_value());
  EXPECT_GE(End(edge).recorded, 15) << edge.output();
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
  EXPECT_GE(End(edge).recorded, 7 + 8) << edge.output();
  ExpectRecordedCounts();

  const Finished inspected = RunToEnd({Tool(), {"inspect", file_}, {}}, kPatience);
  EXPECT_EQ(inspected.status, 0);
  EXPECT_THAT(inspected.output, HasSubstr("counts (no temperatures)"));
  const std::filesystem::path picture = folder_.path() / "counts.png";
  EXPECT_EQ(
      RunToEnd({Tool(), {"inspect", file_, "--render", "2", "-o", picture}, {}}, kPatience).status,
      0);
  EXPECT_TRUE(std::filesystem::exists(picture));
}

#ifdef FAKE_OPENNI
TEST_F(ThermalDaemonTest, GroundSaysThatThereAreCountsOnlyAndGeometryGoesOn) {
  FakeDepthCamera depth(folder_.path());
  bus_->Plug(std::make_shared<EmulatedSeek>("f"));
  Command ground_command{
      GroundService(),
      {"--once", "--domain", std::to_string(TestDomain()), "--output", folder_.path() / "ground"},
      {},
      {}};
  const std::vector<std::string> quick = QuickModel();
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
