#include "edge/pipeline/edge_pipeline.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "edge/pipeline/testing/edge_pipeline_fixture.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

using std::chrono::seconds;

class EdgePipelineTest : public EdgePipelineFixture {
 protected:
  /// Returns what does not answer, so much later; empty = nothing.
  std::string StuckAfter(Nanoseconds time) const {
    return pipeline_->StuckIn(clock_.SteadyNow() + time).value_or("");
  }
  /// `what` does not answer for `limit` and counts as stuck beyond, until `release` is called.
  template <typename Release>
  void ExpectStuckBeyond(Nanoseconds limit, const std::string& what, Release release) {
    EXPECT_EQ(StuckAfter(limit), "");
    EXPECT_EQ(StuckAfter(limit + seconds(1)), what);
    release();
    EXPECT_TRUE(RunToTheEnd().ok());
    EXPECT_EQ(StuckAfter(limit + seconds(1)), "");
  }
  /// Captures one frame and waits until whoever gets it is at it. Only a failure waits this long.
  void CaptureOneUntilStuckIn(const std::string& what) {
    while (counters_.Get(Sensor::kDepth).captured == 0) std::this_thread::yield();
    ASSERT_TRUE(pipeline_->StopCapture(std::chrono::hours(1)));
    const auto deadline = std::chrono::steady_clock::now() + seconds(10);
    while (StuckAfter(std::chrono::hours(1)) != what) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "nobody sees that it is stuck";
      std::this_thread::yield();
    }
  }
};

TEST_F(EdgePipelineTest, FeedbackIsKeptAndRecordedWithTheScan) {
  Feedback feedback;
  feedback.frame_number = 3;
  publisher_.feedback = {{feedback, CaptureTime{}}, {feedback, CaptureTime{}}};
  Start("5*d");
  // A feedback that comes when the recording is closed already is not in it.
  while (!publisher_.handed_over()) std::this_thread::yield();
  EXPECT_TRUE(RunToTheEnd().ok());
  EXPECT_EQ(pipeline_->feedback().newest()->frame_number, 3U);
  EXPECT_EQ(pipeline_->feedback().latency().count, 2U);
  EXPECT_EQ(recording_.messages.size(), 2U);
}

TEST_F(EdgePipelineTest, ARigThatIsDescribedAnewIsRecordedWithTheScan) {
  Start("5*d");
  RigUpdate update;
  update.rig.emplace().thermal_serial = "T1";
  pipeline_->RecordRig(update);
  EXPECT_TRUE(RunToTheEnd().ok());
  ASSERT_EQ(recording_.rigs.size(), 1U);
  EXPECT_EQ(recording_.rigs[0].thermal_serial, "T1");
}

TEST_F(EdgePipelineTest, EveryFrameIsRecordedAndPublishedOnceAndInOrder) {
  Start("100*d 130*t 50*d");
  EXPECT_TRUE(RunToTheEnd().ok());
  ExpectBalancedCounters();
  EXPECT_EQ(recording_.depth_frames.size(), 150U);
  EXPECT_EQ(recording_.thermal_frames.size(), 130U);
  EXPECT_TRUE(recording_.closed);
  const std::vector<EncodedDepthFrame> depth = publisher_.depth();
  ASSERT_EQ(depth.size(), 150U);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    EXPECT_EQ(depth[i].header.frame_number, i);
    EXPECT_EQ(depth[i].header.session, kEdgeSession);
  }
}

TEST_F(EdgePipelineTest, F28FramesThatTheLinkHasNoRoomForAreRecordedAndLeftForLater) {
  options_.mutable_source()->set_rate(1);  // Whose frames come in their time.
  publisher_.leaves_all_of = Sensor::kThermal;
  Start("20*d 30*t");
  EXPECT_TRUE(RunToTheEnd().ok());
  ExpectBalancedCounters();
  EXPECT_EQ(recording_.thermal_frames.size(), 30U);
  EXPECT_EQ(publisher_.depth().size(), 20U);
  EXPECT_TRUE(publisher_.thermal().empty());
  EXPECT_EQ(counters_.Get(Sensor::kThermal).left_for_later, 30U);
}

TEST_F(EdgePipelineTest, F39ACameraThatIsStuckCostsTheRecordingNothing) {
  Start("3*d 2*t %");
  while (!camera_->hangs()) std::this_thread::yield();
  EXPECT_FALSE(pipeline_->StopCapture(milliseconds(1)));
  EXPECT_TRUE(pipeline_->StopRecording().ok());
  EXPECT_TRUE(recording_.closed);
  EXPECT_EQ(recording_.depth_frames.size(), 3U);
  EXPECT_EQ(recording_.thermal_frames.size(), 2U);
  EXPECT_TRUE(pipeline_->Stop().ok());
  EXPECT_EQ(publisher_.depth().size(), 3U);
  ExpectBalancedCounters();
  camera_->Release();
}

TEST_F(EdgePipelineTest, F01WhatIsCollectedGoesToTheDiskWhenFramesStop) {
  Start("d %");
  while (!camera_->hangs()) std::this_thread::yield();
  const auto deadline = std::chrono::steady_clock::now() + seconds(10);
  while (recording_.flushes == 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_GE(recording_.flushes.load(), 1);
  camera_->Release();
  EXPECT_TRUE(RunToTheEnd().ok());
}

TEST_F(EdgePipelineTest, F39ASourceThatDoesNotAnswerForTenSecondsIsStuck) {
  Start("%", /*record=*/false);
  while (!camera_->hangs()) std::this_thread::yield();
  ExpectStuckBeyond(seconds(10), "the source of frames does not answer",
                    [this] { camera_->Release(); });
}

TEST_F(EdgePipelineTest, F39ADiskThatDoesNotAnswerForTenSecondsIsStuck) {
  std::promise<void> answer;
  recording_.before_frame = [answered = answer.get_future().share()] { answered.wait(); };
  Start("d");
  CaptureOneUntilStuckIn("the disk does not answer");
  ExpectStuckBeyond(seconds(10), "the disk does not answer", [&answer] { answer.set_value(); });
}

TEST_F(EdgePipelineTest, F39ALinkThatDoesNotAnswerForFifteenSecondsIsStuck) {
  publisher_.Hold();
  Start("d", /*record=*/false);
  CaptureOneUntilStuckIn("the network does not answer");
  ExpectStuckBeyond(seconds(15), "the network does not answer", [this] { publisher_.Release(); });
}

TEST_F(EdgePipelineTest, OdometryPosesAreRecordedAndPublishedWithTheNextFrame) {
  Start("d 3*p t 2*p d 4*p");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<ExternalOdometrySample> published = publisher_.external_odometry();
  ASSERT_EQ(published.size(), 5U) << "those behind the last frame tell nothing of any";
  for (std::size_t i = 0; i < published.size(); ++i) {
    EXPECT_EQ(published[i].session, kEdgeSession);
    EXPECT_EQ(published[i].number, i);
    EXPECT_EQ(published[i].pose.source, "fake");
  }
  EXPECT_EQ(published[4].pose.time, publisher_.depth().at(1).header.capture_time);
  EXPECT_EQ(recording_.external_odometry.size(), 5U);
}

TEST_F(EdgePipelineTest, PixelsSurviveTheCodec) {
  Start("d:holes t");
  EXPECT_TRUE(RunToTheEnd().ok());
  const Result<Image<std::uint16_t>> depth = Decode(publisher_.depth().at(0).image);
  ASSERT_TRUE(depth.has_value());
  EXPECT_EQ(depth->At(1, 0), FakeSource::kDepthRaw);
  EXPECT_EQ(depth->At(0, 0), kNoDepth);
  EXPECT_EQ(depth->At(2, 0), kNoDepthSaturated);
  const Result<Image<std::uint16_t>> thermal = Decode(publisher_.thermal().at(0).image);
  ASSERT_TRUE(thermal.has_value());
  EXPECT_EQ(*thermal, Image<std::uint16_t>(6, 4, FakeSource::kCentikelvin));
}

TEST_F(EdgePipelineTest, CountsAreRecordedAndPublishedAsCountsAndNeverValid) {
  counts_only_ = true;
  Start("d 2*t:hot");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<EncodedThermalFrame> published = publisher_.thermal();
  ASSERT_EQ(published.size(), 2U);
  for (const EncodedThermalFrame& frame : published) {
    EXPECT_EQ(frame.image.encoding, Encoding::kCounts16);
    EXPECT_FALSE(frame.valid);
    const Result<Image<std::uint16_t>> counts = Decode(frame.image);
    ASSERT_TRUE(counts.has_value());
    EXPECT_EQ(counts->At(0, 0), 65'535);  // Not masked: no temperatures.
    EXPECT_EQ(counts->At(2, 0), 100);
    EXPECT_TRUE(DecodeTemperatures(frame.image)->empty());
  }
  EXPECT_EQ(recording_.thermal_frames.size(), 2U);
}

TEST_F(EdgePipelineTest, TemperaturesArePublishedInTheScaleOfTheCamera) {
  thermal_scale_ = {0.02, 0.0};
  Start("d 2*t");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<EncodedThermalFrame> published = publisher_.thermal();
  ASSERT_EQ(published.size(), 2U);
  for (const EncodedThermalFrame& frame : published) {
    EXPECT_EQ(frame.image.encoding, Encoding::kScaledThermalStrips);
    EXPECT_EQ(frame.scale, thermal_scale_);
    const Result<Image<std::uint16_t>> pixels = DecodeTemperatures(frame.image);
    ASSERT_TRUE(pixels.has_value());
    EXPECT_EQ(pixels->At(0, 0), FakeSource::kCentikelvin);
  }
}

TEST_F(EdgePipelineTest, ThermalDelayIsTheOptionsPlusTheRigs) {
  rig_thermal_delay_s_ = 0.040;
  options_.mutable_timestamper()->mutable_expert()->set_thermal_delay_s(0.002);
  Start("d t");
  EXPECT_TRUE(RunToTheEnd().ok());
  EXPECT_EQ(publisher_.depth().at(0).header.capture_time, FakeSource::kFakeEpoch);
  EXPECT_EQ(publisher_.thermal().at(0).header.capture_time,
            FakeSource::kFakeEpoch + std::chrono::milliseconds(42));
}

TEST_F(EdgePipelineTest, F07FramesAroundAClosedShutterAreInvalid) {
  Start("2*t 4*t:shut 30*t");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<EncodedThermalFrame> thermal = publisher_.thermal();
  ASSERT_EQ(thermal.size(), 36U);
  for (std::size_t i = 0; i < thermal.size(); ++i) {
    // Frames every 25 ms, 0.5 s to settle: 4 + 20 of them are not to be trusted.
    EXPECT_EQ(thermal[i].valid, i < 2 || i >= 26) << i;
  }
  EXPECT_EQ(thermal[3].nuc_state, NucState::kInProgress);
  EXPECT_EQ(thermal[6].nuc_state, NucState::kSettling);
  EXPECT_EQ(recording_.nuc_events.size(), 1U);
}

TEST_F(EdgePipelineTest, F09StampsStayIncreasingAcrossACounterReset) {
  Start("20*d d:reset 20*d");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<EncodedDepthFrame> depth = publisher_.depth();
  ASSERT_EQ(depth.size(), 41U);
  for (std::size_t i = 1; i < depth.size(); ++i) {
    EXPECT_EQ(depth[i].header.capture_time - depth[i - 1].header.capture_time,
              std::chrono::microseconds(33'333));
  }
}

TEST_F(EdgePipelineTest, F11GarbageIsRejectedCountedAndGoesNowhere) {
  Start("3*d 2*d:empty 4*d:size 3*d");
  EXPECT_TRUE(RunToTheEnd().ok());
  ExpectBalancedCounters();
  const SensorCounters counters = counters_.Get(Sensor::kDepth);
  EXPECT_EQ(counters.captured, 12U);
  EXPECT_EQ(counters.rejected, 6U);
  EXPECT_EQ(counters.recorded, 6U);
  EXPECT_EQ(counters.published, 6U);
}

TEST_F(EdgePipelineTest, F12TemperaturesOutOfRangeLeaveAsNoValue) {
  Start("t:hot");
  EXPECT_TRUE(RunToTheEnd().ok());
  const Result<Image<std::uint16_t>> thermal = Decode(publisher_.thermal().at(0).image);
  ASSERT_TRUE(thermal.has_value());
  EXPECT_EQ(thermal->At(0, 0), 0);
  EXPECT_EQ(thermal->At(2, 0), 0);
  EXPECT_EQ(thermal->At(1, 0), FakeSource::kCentikelvin);
}

TEST_F(EdgePipelineTest, AFullDiskStopsTheRecordingOnly) {
  disk_room_ = 10;
  Start("60*d 60*t");
  EXPECT_EQ(RunToTheEnd().code(), StatusCode::kIoError);
  ExpectBalancedCounters();
  EXPECT_EQ(publisher_.depth().size(), 60U);
  EXPECT_EQ(publisher_.thermal().size(), 60U);
  EXPECT_EQ(recording_.depth_frames.size() + recording_.thermal_frames.size(), 10U);
  EXPECT_EQ(
      counters_.Get(Sensor::kDepth).record_failed + counters_.Get(Sensor::kThermal).record_failed,
      110U);
}

TEST_F(EdgePipelineTest, ABrokenLinkStopsThePublishingOnly) {
  publisher_.Break();
  Start("60*d");
  EXPECT_TRUE(RunToTheEnd().ok());
  ExpectBalancedCounters();
  EXPECT_EQ(recording_.depth_frames.size(), 60U);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).publish_failed, 60U);
}

TEST_F(EdgePipelineTest, LiveCaptureDoesNotWaitForASlowLink) {
  constexpr int kQueue = 5;
  options_.mutable_source()->set_rate(1);
  options_.mutable_link()->mutable_expert()->set_queue_frames(kQueue);
  options_.mutable_spool()->mutable_expert()->set_queue_frames(1000);
  publisher_.Hold();
  Start("300*d");
  // The source must come to its end although nothing is taken from the link.
  while (counters_.Get(Sensor::kDepth).recorded < 300) std::this_thread::yield();
  publisher_.Release();
  EXPECT_TRUE(RunToTheEnd().ok());
  ExpectBalancedCounters();
  const SensorCounters counters = counters_.Get(Sensor::kDepth);
  EXPECT_EQ(counters.recorded, 300U);
  EXPECT_GE(counters.publish_queue_full, 300U - kQueue - 2U);
  EXPECT_EQ(counters.published + counters.publish_queue_full, 300U);
  EXPECT_EQ(publisher_.depth().back().header.frame_number, 299U) << "the newest frames are kept";
}

TEST_F(EdgePipelineTest, UnpacedPlaybackWaitsInsteadOfDropping) {
  options_.mutable_link()->mutable_expert()->set_queue_frames(1);
  options_.mutable_spool()->mutable_expert()->set_queue_frames(1);
  Start("200*d 200*t");
  EXPECT_TRUE(RunToTheEnd().ok());
  EXPECT_EQ(publisher_.depth().size(), 200U);
  EXPECT_EQ(publisher_.thermal().size(), 200U);
}

TEST_F(EdgePipelineTest, F38StopEmptiesTheQueuesAndBalancesTheCounters) {
  publisher_.Hold();
  Start("100000*d");
  while (counters_.Get(Sensor::kDepth).captured < 20) std::this_thread::yield();
  EXPECT_TRUE(pipeline_->Stop().ok());
  ExpectBalancedCounters();
  EXPECT_TRUE(recording_.closed);
  EXPECT_LT(counters_.Get(Sensor::kDepth).captured, 100'000U);
  EXPECT_TRUE(pipeline_->Stop().ok()) << "a second stop changes nothing";
}

TEST_F(EdgePipelineTest, WithoutRecordingOnlyTheLinkCounts) {
  Start("10*d", false);
  EXPECT_TRUE(RunToTheEnd().ok());
  EXPECT_EQ(publisher_.depth().size(), 10U);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, 0U);
}

TEST_F(EdgePipelineTest, F07NucEventsAreRecorded) {
  Start("2*t 4*t:shut 30*t");
  EXPECT_TRUE(RunToTheEnd().ok());
  std::string log;
  for (const RecordedLog& line : recording_.log) log += line.level + " " + line.text + "\n";
  EXPECT_NE(log.find("info nuc: shutter closed, not ordered by us, known by its frames"),
            std::string::npos)
      << log;
  EXPECT_NE(log.find("info nuc: shutter open after 0.10 s"), std::string::npos) << log;
  ASSERT_EQ(recording_.nuc_events.size(), 1U);
  EXPECT_EQ(pipeline_->nuc().state, NucState::kIdle);
  EXPECT_EQ(pipeline_->nuc().closings_per_minute, 1U);
}

TEST_F(EdgePipelineTest, F05FrozenFramesAreNotFusedAndTheCameraIsOpenedAgain) {
  // 2.5 s of the same image; the fourth of it is known to be frozen.
  Start("10*t 100*t:same 60*t");
  // The supervised source waits before it opens the camera again.
  while (!pipeline_->finished()) {
    clock_.Advance(std::chrono::milliseconds(100));
    std::this_thread::yield();
  }
  EXPECT_TRUE(pipeline_->Stop().ok());
  const std::vector<EncodedThermalFrame> thermal = publisher_.thermal();
  for (std::size_t i = 0; i < thermal.size(); ++i) {
    // Then half a second to settle.
    EXPECT_EQ(thermal[i].valid, i < 12 || i >= 130) << i;
  }
  EXPECT_EQ(thermal[40].nuc_source, NucSource::kInferred);
  EXPECT_EQ(thermal[105].nuc_state, NucState::kError);
  EXPECT_EQ(camera_->opened(), 2);
  EXPECT_EQ(source_->reopened(), 1U);
}

}  // namespace
}  // namespace isotherm
