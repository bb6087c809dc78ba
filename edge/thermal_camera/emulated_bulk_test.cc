// Cameras of the video class that stream over bulk transfers, and the smaller sister of the P3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "edge/thermal_camera/testing/camera_fixture.h"
#include "edge/thermal_camera/testing/emulated_p2pro.h"
#include "edge/thermal_camera/testing/emulated_p3.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr std::uint32_t kHeaderBytes = 12;
constexpr std::uint32_t kP2ProFrameBytes = 256 * 384 * 2;

class UvcBulkTest : public EmulatedCameraTest {
 protected:
  std::shared_ptr<EmulatedP2Pro> PlugBulk(std::string_view script, std::uint32_t payload_bytes) {
    auto camera = std::make_shared<EmulatedP2Pro>(script, payload_bytes);
    bus_->Plug(camera);
    return camera;
  }
  void ExpectGoodFrames(ThermalCameraSource& source, std::size_t count) {
    const std::vector<RawFrame> frames = ReadFrames(source, count);
    ASSERT_EQ(frames.size(), count) << failure_.message();
    for (const RawFrame& frame : frames) {
      ExpectRamp(frame, 1.0 / 64, EmulatedP2Pro::kFirstCount, EmulatedP2Pro::kNoise);
    }
    EXPECT_EQ(source.counts().incomplete, 0U);
    for (std::size_t i = 1; i < count; ++i) {
      EXPECT_EQ(frames[i].frame_number, frames[i - 1].frame_number + 1);
      EXPECT_GT(frames[i].arrival_steady, frames[i - 1].arrival_steady);
    }
  }
};

/// Payload sizes: smaller than a transfer; as large as ours; not of whole packets; a frame in parts
/// of which the last fills its transfer; a whole frame, which spans twelve transfers; beyond any.
constexpr std::uint32_t kPayloads[] = {
    3'072,    16'384, 10'000, kP2ProFrameBytes / 16 + kHeaderBytes, kP2ProFrameBytes + kHeaderBytes,
    4'000'000};

TEST_F(UvcBulkTest, FramesArriveWholeWhateverThePayloads) {
  for (const std::uint32_t payload_bytes : kPayloads) {
    SCOPED_TRACE(payload_bytes);
    const auto camera = PlugBulk("f", payload_bytes);
    const auto source = Open();
    ExpectGoodFrames(*source, 5);
    source->Close();
    bus_->Unplug();
  }
}

TEST_F(UvcBulkTest, PayloadThatFillsItsTransfersEndsWithOneWithoutBytes) {
  // The last payload of a frame has 32 KiB with its header: two transfers of ours, both full.
  constexpr std::uint32_t kLast = 32'768 - kHeaderBytes;
  const std::uint32_t payload_bytes = (kP2ProFrameBytes - kLast) / 4 + kHeaderBytes;
  ASSERT_EQ((payload_bytes - kHeaderBytes) * 4 + kLast, kP2ProFrameBytes);
  PlugBulk("f", payload_bytes);
  ExpectGoodFrames(*Open(), 5);
}

TEST_F(UvcBulkTest, StreamEndsWithTheSourceAndBeginsAgain) {
  const auto camera = PlugBulk("f", 16'384);
  const auto source = Open();
  ExpectGoodFrames(*source, 3);
  EXPECT_TRUE(camera->bulk_streaming());
  source->Close();
  EXPECT_FALSE(camera->bulk_streaming());
  ASSERT_TRUE(source->Open().ok());
  ExpectGoodFrames(*source, 3);
}

TEST_F(UvcBulkTest, F11DamagedFramesComeWithoutPixelsAndTheNextIsWhole) {
  for (const std::uint32_t payload_bytes : {16'384U, 40'000U, kP2ProFrameBytes + kHeaderBytes}) {
    for (const std::string fault : {"short", "head", "error", "lost"}) {
      // A frame in one payload that is lost leaves no trace.
      if (payload_bytes > kP2ProFrameBytes && fault == "lost") continue;
      SCOPED_TRACE(fault + " in payloads of " + std::to_string(payload_bytes));
      PlugBulk("2*f f:" + fault + " f", payload_bytes);
      const auto source = Open();
      const std::vector<RawFrame> frames = ReadFrames(*source, 5);
      ASSERT_EQ(frames.size(), 5U) << failure_.message();
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(frames[i].pixels.empty(), i == 2) << i;
      }
      EXPECT_EQ(source->counts().incomplete, 1U);
      source->Close();
      bus_->Unplug();
    }
  }
}

TEST_F(UvcBulkTest, F04UnpluggedInMidFrameFailsAtOnce) {
  PlugBulk("3*f unplug", 16'384);
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 3U);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("unplugged"));
}

class P1Test : public EmulatedCameraTest {};

TEST_F(P1Test, SizeFollowsFromTheProductAndNothingElse) {
  const auto camera = Plug<EmulatedP1>("5*f f:partial f");
  const auto devices = ListThermalCameras();
  ASSERT_TRUE(devices.has_value()) << devices.error().message();
  ASSERT_EQ(devices->size(), 1U);
  EXPECT_EQ(devices->front().driver, "p3-bulk");
  EXPECT_THAT(devices->front().modes.front(), HasSubstr("160x120"));
  const auto source = Open();
  EXPECT_EQ(source->cameras().front().width, 160);
  const std::vector<RawFrame> frames = ReadFrames(*source, 9);
  ASSERT_EQ(frames.size(), 9U) << failure_.message();
  std::vector<std::size_t> pieces;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].pixels.empty()) {
      pieces.push_back(i);
      continue;
    }
    EXPECT_EQ(frames[i].pixels.width(), 160);
    EXPECT_EQ(frames[i].pixels.height(), 120);
    ExpectRamp(frames[i], 1.0 / 64, EmulatedP1::kFirstCount, EmulatedP1::kNoise);
    // Where its metadata lie is not known: rows of zeroes are no correction.
    EXPECT_FALSE(frames[i].shutter_closed);
    EXPECT_FALSE(frames[i].camera_nuc.has_value());
  }
  // The piece; the whole frame behind it is good. A busy computer may lose frames, and counts them.
  const std::uint64_t lost = source->counts().lost;
  EXPECT_LE(lost, 1U);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_LE(pieces.front(), 5U);
  EXPECT_GE(pieces.front() + lost, 5U);
  const auto ticks = frames[1].device_ticks - frames[0].device_ticks;
  EXPECT_GE(ticks, milliseconds(40));
  EXPECT_LE(ticks, (lost + 1) * milliseconds(40));
  EXPECT_EQ(ticks % milliseconds(40), milliseconds(0));
  source->Close();
  EXPECT_EQ(camera->alternate(), 0);
}

TEST_F(P1Test, CorrectionIsInferredFromImagesThatStandStill) {
  // On a busy computer 0.8 s may last longer.
  options_.mutable_expert()->set_stall_timeout_s(30.0);
  Plug<EmulatedP1>("5*f 20*f:nuc f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 30);
  ASSERT_EQ(frames.size(), 30U) << failure_.message();
  EXPECT_EQ(source->counts().repeated, 2U);
  EXPECT_EQ(source->counts().frozen, 18U);
  EXPECT_EQ(frames[10].camera_nuc->state, NucState::kInProgress);
  EXPECT_EQ(frames[10].camera_nuc->source, NucSource::kInferred);
  EXPECT_FALSE(frames.back().shutter_closed);
}

TEST_F(P1Test, TakesOrdersAndItsGain) {
  const auto camera = Plug<EmulatedP1>("f");
  options_.set_gain(LOW_GAIN);
  const auto source = Open();
  EXPECT_EQ(camera->gain(), 0);
  EXPECT_THAT(source->cameras().front().settings, HasSubstr("gain low"));
  ASSERT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
  EXPECT_TRUE(source->Control(TriggerNuc{})->ok());
  EXPECT_EQ(camera->corrections(), 1);
}

}  // namespace
}  // namespace isotherm
