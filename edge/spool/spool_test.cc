#include "edge/spool/spool.h"

#include <gtest/gtest.h>

#include "edge/spool/fake_recording_writer.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

EncodedFrame Depth(std::uint64_t number) {
  EncodedDepthFrame frame;
  frame.header.frame_number = number;
  return {frame, {}};
}

EncodedFrame Thermal(CaptureTime time, NucState state) {
  EncodedThermalFrame frame;
  frame.header.capture_time = time;
  frame.nuc_state = state;
  frame.nuc_source = NucSource::kInBand;
  return {frame, {}};
}

class SpoolTest : public testing::Test {
 protected:
  void Start(std::uint64_t room = UINT64_MAX) {
    spool_ = std::make_unique<Spool>(
        "scan.mcap", std::make_unique<FakeRecordingWriter>(recording_, room), account_);
  }

  FakeRecording recording_;
  FrameAccount account_;
  std::unique_ptr<Spool> spool_;
};

TEST_F(SpoolTest, WritesAndCounts) {
  Start();
  spool_->Add(Depth(0));
  spool_->Add(Depth(1));
  spool_->Add(Thermal({}, NucState::kIdle));
  EXPECT_TRUE(spool_->Close().ok());
  EXPECT_TRUE(recording_.closed);
  EXPECT_EQ(account_.Get(Sensor::kDepth).recorded, 2U);
  EXPECT_EQ(account_.Get(Sensor::kThermal).recorded, 1U);
}

TEST_F(SpoolTest, AFullDiskIsCountedExactlyAndReportedAtTheEnd) {
  constexpr std::uint64_t kRoom = 3;
  Start(kRoom);
  for (std::uint64_t i = 0; i < 10; ++i) spool_->Add(Depth(i));
  EXPECT_EQ(spool_->Close().code(), StatusCode::kIoError);
  EXPECT_TRUE(recording_.closed) << "what is good must stay readable";
  EXPECT_EQ(account_.Get(Sensor::kDepth).recorded, 3U);
  EXPECT_EQ(account_.Get(Sensor::kDepth).record_failed, 7U);
  EXPECT_EQ(recording_.writes_after_failure, 0) << "a full disk is not tried again for each frame";
}

TEST_F(SpoolTest, F15AStepOfTheClockIsRecordedOnceEvenIfItsFrameWasDropped) {
  Start();
  const auto add = [this](std::int64_t ms, Nanoseconds wall_minus_time) {
    EncodedFrame frame = Thermal(CaptureTime(milliseconds(ms)), NucState::kIdle);
    frame.wall_minus_time = wall_minus_time;
    spool_->Add(frame);
  };
  add(0, milliseconds(0));
  // The frame at 10 ms, the first after the step, did not get here.
  add(20, milliseconds(-3000));
  add(30, milliseconds(-3000));
  add(40, milliseconds(-2500));
  ASSERT_EQ(recording_.clock_steps.size(), 2U);
  EXPECT_EQ(recording_.clock_steps[0].time, CaptureTime(milliseconds(20)));
  EXPECT_EQ(recording_.clock_steps[0].step, milliseconds(-3000));
  EXPECT_EQ(recording_.clock_steps[0].wall_minus_time, milliseconds(-3000));
  EXPECT_EQ(recording_.clock_steps[1].step, milliseconds(500));
  EXPECT_EQ(recording_.clock_steps[1].wall_minus_time, milliseconds(-2500));
}

TEST_F(SpoolTest, AShutterEventIsRecordedWhenTheShutterOpens) {
  Start();
  const CaptureTime start{std::chrono::seconds(100)};
  spool_->Add(Thermal(start, NucState::kIdle));
  spool_->Add(Thermal(start + milliseconds(25), NucState::kInProgress));
  spool_->Add(Thermal(start + milliseconds(50), NucState::kInProgress));
  EXPECT_TRUE(recording_.nuc_events.empty());
  spool_->Add(Thermal(start + milliseconds(75), NucState::kSettling));
  spool_->Add(Thermal(start + milliseconds(100), NucState::kSettling));
  ASSERT_EQ(recording_.nuc_events.size(), 1U);
  EXPECT_EQ(recording_.nuc_events[0].start, start + milliseconds(25));
  EXPECT_EQ(recording_.nuc_events[0].end, start + milliseconds(75));
  EXPECT_EQ(recording_.nuc_events[0].source, NucSource::kInBand);
}

TEST_F(SpoolTest, FeedbackLiesAtTheTimeOfItsDepthFrameWithItsPicture) {
  Start();
  Feedback feedback;
  feedback.capture_time = CaptureTime{std::chrono::seconds(100)};
  spool_->Add(feedback, feedback.capture_time + milliseconds(70));
  feedback.picture = {1, 2, 3};
  spool_->Add(feedback, feedback.capture_time + milliseconds(170));
  ASSERT_EQ(recording_.messages.size(), 3U);
  EXPECT_EQ(recording_.messages[0].first, "/feedback");
  EXPECT_EQ(recording_.messages[0].second, feedback.capture_time);
  EXPECT_EQ(recording_.messages[1].first, "/feedback");
  EXPECT_EQ(recording_.messages[2].first, "/feedback/picture");
}

TEST_F(SpoolTest, F60FeedbackOnOlderFramesDoesNotGoBackInTheRecording) {
  Start();
  const CaptureTime newest{std::chrono::seconds(100)};
  spool_->Add(Thermal(newest, NucState::kIdle));
  Feedback feedback;
  for (const int behind_s : {30, 1, 20}) {
    feedback.capture_time = newest - std::chrono::seconds(behind_s);
    spool_->Add(feedback, newest);
  }
  ASSERT_EQ(recording_.messages.size(), 3U);
  for (const auto& message : recording_.messages) EXPECT_EQ(message.second, newest);
}

TEST(SpoolPathTest, OffMeansNoFile) { EXPECT_EQ(SpoolPath("off", {}), std::nullopt); }

TEST(SpoolPathTest, AFileIsTakenAsGiven) { EXPECT_EQ(SpoolPath("a/b.mcap", {}), "a/b.mcap"); }

TEST(SpoolPathTest, AFolderGetsAFileNamedByStartTime) {
  const CaptureTime now{std::chrono::seconds(1'700'000'000)};
  EXPECT_EQ(SpoolPath("scans/", now), "scans/edge-20231114-221320.mcap");
  EXPECT_EQ(SpoolPath("/tmp", now), "/tmp/edge-20231114-221320.mcap");
}

}  // namespace
}  // namespace isotherm
