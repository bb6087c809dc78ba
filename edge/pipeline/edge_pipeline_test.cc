#include "edge/pipeline/edge_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "edge/options/edge_options.pb.h"
#include "edge/publisher/testing/fake_publisher.h"
#include "edge/source/supervised_source.h"
#include "edge/source/testing/fake_source.h"
#include "edge/spool/testing/fake_recording_writer.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kSession = 77;

class EdgePipelineTest : public testing::Test {
 protected:
  EdgePipelineTest() { options_.mutable_source()->set_rate(0); }

  void Start(std::string_view script, bool record = true) {
    auto camera = std::make_unique<FakeSource>(script);
    camera->control_answer = control_answer_;
    if (counts_only_) camera->DescribeThermal(true);
    camera->thermal_scale = thermal_scale_;
    camera_ = camera.get();
    source_ = std::make_unique<SupervisedSource>(
        std::move(camera), options_.frame_check(), clock_,
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kRejected); }, Nanoseconds(0));
    ASSERT_TRUE(source_->Open().ok());
    std::unique_ptr<Spool> spool;
    if (record) {
      spool = MakeFakeSpool(recording_, options_.spool(), clock_, counters_, disk_room_);
    }
    pipeline_ = std::make_unique<EdgePipeline>(
        options_, EdgeParts{.source = *source_,
                            .publisher = publisher_,
                            .counters = counters_,
                            .health = health_,
                            .clock = clock_,
                            .spool = std::move(spool),
                            .session = kSession,
                            .rig_thermal_delay_s = rig_thermal_delay_s_});
    pipeline_->StartReceiving();
    pipeline_->StartCapture();
  }
  std::vector<CommandResult> AwaitAnswers(std::size_t count) {
    while (publisher_.answers().size() < count) {
      pipeline_->AnswerCommands();
      std::this_thread::yield();
    }
    return publisher_.answers();
  }
  static CommandResult Find(const std::vector<CommandResult>& answers, std::uint64_t number) {
    const auto found = std::ranges::find(answers, number, &CommandResult::number);
    return found == answers.end() ? CommandResult{} : *found;
  }
  /// The test's own time limit is the bound.
  Status RunToTheEnd() {
    while (!pipeline_->finished()) std::this_thread::yield();
    return pipeline_->Stop();
  }
  void ExpectBalancedCounters() {
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const SensorCounters counters = counters_.Get(sensor);
      EXPECT_EQ(counters.OnTheWayToDisk(), 0);
      EXPECT_EQ(counters.OnTheWayToGround(), 0);
    }
  }

  EdgeOptions options_;
  FakeClock clock_;
  FakePublisher publisher_;
  FakeRecording recording_;
  std::uint64_t disk_room_ = UINT64_MAX;
  double rig_thermal_delay_s_ = 0.0;
  FrameCounters counters_;
  CameraHealth health_;
  Status control_answer_ = FailedPrecondition("no shutter");
  bool counts_only_ = false;
  RadiometricScale thermal_scale_;
  FakeSource* camera_ = nullptr;
  std::unique_ptr<SupervisedSource> source_;
  std::unique_ptr<EdgePipeline> pipeline_;
};

TEST_F(EdgePipelineTest, FeedbackIsKeptAndRecordedWithTheScan) {
  Feedback feedback;
  feedback.frame_number = 3;
  publisher_.feedback = {{feedback, CaptureTime{}}, {feedback, CaptureTime{}}};
  Start("5*d");
  EXPECT_TRUE(RunToTheEnd().ok());
  EXPECT_EQ(pipeline_->feedback().newest()->frame_number, 3U);
  EXPECT_EQ(pipeline_->feedback().latency().count, 2U);
  EXPECT_EQ(recording_.messages.size(), 2U);
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
    EXPECT_EQ(depth[i].header.session, kSession);
  }
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

TEST_F(EdgePipelineTest, OdometryPosesAreRecordedAndPublishedWithTheNextFrame) {
  Start("d 3*p t 2*p d 4*p");
  EXPECT_TRUE(RunToTheEnd().ok());
  const std::vector<ExternalOdometrySample> published = publisher_.external_odometry();
  ASSERT_EQ(published.size(), 5U) << "those behind the last frame tell nothing of any";
  for (std::size_t i = 0; i < published.size(); ++i) {
    EXPECT_EQ(published[i].session, kSession);
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
    EXPECT_EQ(frame.image.encoding, Encoding::kScaledThermalRans);
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

TEST_F(EdgePipelineTest, EveryCommandIsAnswered) {
  publisher_.commands = {{.number = 1, .kind = CommandKind::kTriggerNuc},
                         {.number = 2,
                          .kind = CommandKind::kSetPublishPolicy,
                          .publish_policy = PublishPolicy::kLossless},
                         {.number = 3, .kind = CommandKind::kStopScan}};
  Start("d");
  const std::vector<CommandResult> answers = AwaitAnswers(3);
  EXPECT_EQ(Find(answers, 1).outcome, CommandOutcome::kRefused) << "there is no thermal camera";
  EXPECT_FALSE(Find(answers, 1).text.empty());
  EXPECT_EQ(Find(answers, 2).outcome, CommandOutcome::kDone);
  EXPECT_EQ(publisher_.policy(), PublishPolicy::kLossless);
  EXPECT_EQ(Find(answers, 3).outcome, CommandOutcome::kRefused);
}

TEST_F(EdgePipelineTest, CommandsThatAreTooManyAreAnsweredToo) {
  constexpr std::uint64_t kCommands = 50;
  for (std::uint64_t i = 1; i <= kCommands; ++i)
    publisher_.commands.push_back({.number = i, .kind = CommandKind::kSetPublishPolicy});
  Start("1000000*t", false);
  const auto answers = AwaitAnswers(kCommands);
  EXPECT_TRUE(pipeline_->Stop().ok());
  for (std::uint64_t i = 1; i <= kCommands; ++i) {
    const CommandResult answer = Find(answers, i);
    EXPECT_TRUE(answer.outcome == CommandOutcome::kDone ||
                answer.text == "too many commands at once; send it again")
        << answer.text;
  }
}

TEST_F(EdgePipelineTest, ANucThatIsAskedForReachesTheCamera) {
  control_answer_ = OkStatus();
  publisher_.commands = {{.number = 1, .kind = CommandKind::kTriggerNuc}};
  // More than the test waits for; unpaced playback waits for the queues.
  Start("1000000*t", false);
  const CommandResult answer = Find(AwaitAnswers(1), 1);
  // Asked before the first frame came, or after.
  if (answer.outcome == CommandOutcome::kDone) {
    EXPECT_EQ(answer.text, "the camera has the order");
  } else {
    EXPECT_EQ(answer.text, "no thermal frame has come yet");
  }
  EXPECT_TRUE(pipeline_->Stop().ok());
  const auto triggers = std::ranges::count_if(camera_->controls, [](const CameraControl& control) {
    return std::holds_alternative<TriggerNuc>(control);
  });
  EXPECT_EQ(triggers > 0, answer.outcome == CommandOutcome::kDone);
}

TEST_F(EdgePipelineTest, WithoutACameraToCommandNucCommandsAreRefusedWithAReason) {
  options_.mutable_source()->set_kind(REPLAY);
  publisher_.commands = {
      {.number = 1, .kind = CommandKind::kTriggerNuc},
      {.number = 2, .kind = CommandKind::kHoldNuc, .hold_s = 5.0},
      {.number = 3, .kind = CommandKind::kSetNucPolicy, .nuc_policy = NucPolicy::kManual}};
  Start("1000000*t", false);
  for (const CommandResult& answer : AwaitAnswers(3)) {
    EXPECT_EQ(answer.outcome, CommandOutcome::kRefused);
    EXPECT_EQ(answer.text, "a recording is played: there is no shutter to command");
  }
  EXPECT_TRUE(pipeline_->Stop().ok());
  EXPECT_TRUE(camera_->controls.empty());
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
