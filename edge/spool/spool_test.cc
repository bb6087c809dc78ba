#include "edge/spool/spool.h"

#include <gtest/gtest.h>

#include <deque>
#include <numeric>

#include "edge/options/edge_options.pb.h"
#include "edge/spool/testing/fake_recording_writer.h"

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

constexpr std::uint64_t kMb = 1'000'000;
constexpr Nanoseconds kLongerThanAnyBackOff = std::chrono::seconds(6);

/// A disk on which each file has the room that the test gives it.
class SpoolTest : public testing::Test {
 protected:
  void Start(std::uint64_t room = UINT64_MAX) {
    room_ = room;
    spool_ = std::make_unique<Spool>(SpoolParts{[this] { return NextFile(); },
                                                [this] { return free_bytes_; },
                                                options_,
                                                clock_,
                                                counters_,
                                                {},
                                                nullptr,
                                                [this] { return older_bytes_ + OwnBytes(); },
                                                [this] { return Deletable(); },
                                                [this] { return MakeRoom(); }});
    spool_->Tend(false);
  }
  Result<RecordingFile> NextFile() {
    ++tries_;
    if (!disk_works_) return Err(IoError("the disk is not there"));
    files_.emplace_back();
    return RecordingFile{std::filesystem::path(testing::TempDir()) / "not-there.mcap",
                         std::make_unique<FakeRecordingWriter>(files_.back(), room_)};
  }
  std::uint64_t OwnBytes() const {
    std::uint64_t bytes = 0;
    for (const FakeRecording& file : files_) bytes += file.bytes;
    return bytes;
  }
  std::uint64_t Deletable() const {
    return std::accumulate(fetched_.begin(), fetched_.end(), std::uint64_t{0});
  }
  /// Older recordings go from the front.
  std::optional<DeletedRecording> MakeRoom() {
    if (fetched_.empty()) return std::nullopt;
    const std::uint64_t bytes = fetched_.front();
    fetched_.pop_front();
    older_bytes_ -= bytes;
    if (deleting_frees_) free_bytes_ = *free_bytes_ + bytes;
    return DeletedRecording{"older.mcap", bytes};
  }
  /// At 5 MB/s.
  void RecordFor(int seconds) {
    for (int i = 0; i < seconds; ++i) {
      clock_.Advance(std::chrono::seconds(1));
      files_.back().bytes += 5 * kMb;
      Record(0);
    }
  }
  /// As the spool's thread does it.
  void Record(std::uint64_t number) {
    spool_->Add(Depth(number));
    spool_->Tend(false);
  }
  FakeRecording& recording() { return files_.front(); }
  SensorCounters depth() const { return counters_.Get(Sensor::kDepth); }

  SpoolOptions options_;
  FakeClock clock_;
  std::uint64_t room_ = UINT64_MAX;
  Result<std::uint64_t> free_bytes_ = 1'000'000 * kMb;
  std::uint64_t older_bytes_ = 0;
  std::deque<std::uint64_t> fetched_;  ///< Sizes of older recordings that may be deleted.
  bool deleting_frees_ = true;
  bool disk_works_ = true;
  int tries_ = 0;
  std::deque<FakeRecording> files_;
  FrameCounters counters_;
  std::unique_ptr<Spool> spool_;
};

TEST_F(SpoolTest, WritesAndCounts) {
  Start();
  spool_->Add(Depth(0));
  spool_->Add(Depth(1));
  spool_->Add(Thermal({}, NucState::kIdle));
  EXPECT_TRUE(spool_->Close().ok());
  EXPECT_TRUE(recording().closed);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, 2U);
  EXPECT_EQ(counters_.Get(Sensor::kThermal).recorded, 1U);
}

TEST_F(SpoolTest, AFullDiskIsCountedExactlyAndReportedAtTheEnd) {
  constexpr std::uint64_t kRoom = 3;
  Start(kRoom);
  for (std::uint64_t i = 0; i < 10; ++i) spool_->Add(Depth(i));
  EXPECT_EQ(spool_->Close().code(), StatusCode::kIoError);
  EXPECT_TRUE(recording().closed) << "what is good must stay readable";
  EXPECT_EQ(counters_.Get(Sensor::kDepth).recorded, 3U);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).record_failed, 7U);
  EXPECT_EQ(recording().writes_after_failure, 0) << "a full disk is not tried again for each frame";
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
  ASSERT_EQ(recording().clock_steps.size(), 2U);
  EXPECT_EQ(recording().clock_steps[0].time, CaptureTime(milliseconds(20)));
  EXPECT_EQ(recording().clock_steps[0].step, milliseconds(-3000));
  EXPECT_EQ(recording().clock_steps[0].wall_minus_time, milliseconds(-3000));
  EXPECT_EQ(recording().clock_steps[1].step, milliseconds(500));
  EXPECT_EQ(recording().clock_steps[1].wall_minus_time, milliseconds(-2500));
}

TEST_F(SpoolTest, AShutterEventIsRecordedWhenTheShutterOpens) {
  Start();
  const CaptureTime start{std::chrono::seconds(100)};
  spool_->Add(Thermal(start, NucState::kIdle));
  spool_->Add(Thermal(start + milliseconds(25), NucState::kInProgress));
  spool_->Add(Thermal(start + milliseconds(50), NucState::kInProgress));
  EXPECT_TRUE(recording().nuc_events.empty());
  spool_->Add(Thermal(start + milliseconds(75), NucState::kSettling));
  spool_->Add(Thermal(start + milliseconds(100), NucState::kSettling));
  ASSERT_EQ(recording().nuc_events.size(), 1U);
  EXPECT_EQ(recording().nuc_events[0].start, start + milliseconds(25));
  EXPECT_EQ(recording().nuc_events[0].end, start + milliseconds(75));
  EXPECT_EQ(recording().nuc_events[0].source, NucSource::kInBand);
}

TEST_F(SpoolTest, FeedbackLiesAtTheTimeOfItsDepthFrameWithItsImage) {
  Start();
  Feedback feedback;
  feedback.capture_time = CaptureTime{std::chrono::seconds(100)};
  spool_->Add(feedback, feedback.capture_time + milliseconds(70));
  feedback.image = {1, 2, 3};
  spool_->Add(feedback, feedback.capture_time + milliseconds(170));
  ASSERT_EQ(recording().messages.size(), 3U);
  EXPECT_EQ(recording().messages[0].first, "/feedback");
  EXPECT_EQ(recording().messages[0].second, feedback.capture_time);
  EXPECT_EQ(recording().messages[1].first, "/feedback");
  EXPECT_EQ(recording().messages[2].first, "/feedback/image");
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
  ASSERT_EQ(recording().messages.size(), 3U);
  for (const auto& message : recording().messages) EXPECT_EQ(message.second, newest);
}

TEST_F(SpoolTest, F43AfterAnErrorANewFileIsBegunAndTheLossIsCounted) {
  Start(3);
  for (std::uint64_t i = 0; i < 5; ++i) Record(i);
  EXPECT_TRUE(files_[0].closed) << "a file that failed is not written to again";
  EXPECT_NE(spool_->status().problem, "");
  room_ = UINT64_MAX;
  clock_.Advance(std::chrono::seconds(1));
  for (std::uint64_t i = 5; i < 9; ++i) Record(i);
  ASSERT_EQ(files_.size(), 2U);
  EXPECT_EQ(files_[0].depth_frames, (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(files_[1].depth_frames, (std::vector<std::uint64_t>{5, 6, 7, 8}));
  EXPECT_EQ(depth().recorded, 7U);
  EXPECT_EQ(depth().record_failed, 2U);
  clock_.Advance(std::chrono::seconds(4));
  Record(9);
  EXPECT_EQ(spool_->status().problem, "") << "the disk has proven itself";
  EXPECT_EQ(spool_->Close().code(), StatusCode::kIoError) << "the recording is not complete";
}

TEST_F(SpoolTest, F31ADiskThatIsNotThereIsWaitedForWithABackOff) {
  disk_works_ = false;
  Start();
  // Half a second, 1, 2, 4, 5, 5, ...
  for (int i = 0; i < 600; ++i) {
    Record(static_cast<std::uint64_t>(i));
    clock_.Advance(milliseconds(100));
  }
  EXPECT_GE(tries_, 13);
  EXPECT_LE(tries_, 16);
  EXPECT_EQ(depth().record_failed, 600U);
  EXPECT_EQ(spool_->status().brief, "NOT RECORDING: disk fails");
  disk_works_ = true;
  clock_.Advance(kLongerThanAnyBackOff);
  Record(600);
  EXPECT_EQ(depth().recorded, 1U);
}

TEST_F(SpoolTest, F43ADiskThatHasProvenItselfIsTriedAgainSoonWhenItFails) {
  disk_works_ = false;
  Start();
  for (int i = 0; i < 5; ++i) {
    clock_.Advance(kLongerThanAnyBackOff);
    Record(0);
  }
  disk_works_ = true;
  room_ = 2;
  clock_.Advance(kLongerThanAnyBackOff);
  Record(1);
  clock_.Advance(std::chrono::seconds(4));
  Record(2);
  EXPECT_EQ(spool_->status().problem, "");
  Record(3);
  ASSERT_NE(spool_->status().problem, "") << "the disk is full";
  clock_.Advance(milliseconds(500));
  Record(4);
  EXPECT_EQ(files_.size(), 2U);
}

TEST_F(SpoolTest, F41AtTheReserveTheFileIsEndedProperlyAndGoesOnWhenThereIsSpace) {
  Start();
  RecordFor(10);
  EXPECT_EQ(spool_->status().brief, "");
  free_bytes_ = 600 * kMb + 5 * 60 * 5 * kMb;  // The reserve is 120 s of 5 MB/s.
  RecordFor(1);
  EXPECT_EQ(spool_->status().brief, "disk full in 5 min");
  free_bytes_ = 599 * kMb;
  const std::uint64_t recorded = depth().recorded;
  RecordFor(10);
  EXPECT_TRUE(files_[0].closed);
  EXPECT_EQ(files_.size(), 1U);
  EXPECT_EQ(depth().recorded, recorded + 1) << "the frame that came before the look";
  EXPECT_EQ(depth().record_failed, 9U);
  EXPECT_EQ(spool_->status().brief, "NOT RECORDING: disk full");
  free_bytes_ = 5000 * kMb;
  RecordFor(2);
  ASSERT_EQ(files_.size(), 2U);
  EXPECT_GE(files_[1].depth_frames.size(), 1U);
}

TEST_F(SpoolTest, F41AtTheEndOfTheQuotaTheFileIsEndedProperly) {
  options_.set_quota_gb(1.0);
  older_bytes_ = 900 * kMb;
  fetched_ = {900 * kMb};  // Nobody has allowed to delete it.
  Start();
  RecordFor(10);
  EXPECT_EQ(spool_->status().brief, "quota used up in 0 min");
  EXPECT_FALSE(files_[0].closed);
  RecordFor(15);
  EXPECT_TRUE(files_[0].closed);
  EXPECT_LE(OwnBytes(), 130 * kMb);
  EXPECT_EQ(files_.size(), 1U);
  EXPECT_EQ(spool_->status().brief, "NOT RECORDING: quota used up");
  EXPECT_NE(spool_->status().problem.find("spool.quota_gb"), std::string::npos);
  older_bytes_ = 0;  // By hand.
  for (int i = 0; i < 20; ++i) {
    clock_.Advance(std::chrono::seconds(1));
    Record(0);
  }
  EXPECT_EQ(files_.size(), 2U);
}

TEST_F(SpoolTest, F41AQuotaThatIsUsedUpBeforehandGetsNoFrame) {
  options_.set_quota_gb(1.0);
  older_bytes_ = 1000 * kMb;
  Start();
  RecordFor(0);
  Record(0);
  EXPECT_EQ(files_.size(), 0U);
  EXPECT_EQ(depth().record_failed, 1U);
  EXPECT_TRUE(spool_->status().is_full);
}

TEST_F(SpoolTest, F41OlderRecordingsThatWereFetchedMakeRoom) {
  options_.set_when_full(DELETE_FETCHED);
  options_.set_quota_gb(2.0);
  older_bytes_ = 1900 * kMb;
  fetched_ = {100 * kMb, 300 * kMb, 300 * kMb};
  Start();
  RecordFor(30);
  EXPECT_EQ(fetched_.size(), 2U) << "one is enough by now";
  EXPECT_EQ(spool_->status().brief, "quota used up in 2 min") << "with what may be deleted";
  RecordFor(110);
  EXPECT_EQ(fetched_.size(), 0U);
  EXPECT_FALSE(files_[0].closed) << "the last one has room for a minute";
  EXPECT_EQ(depth().record_failed, 0U);
  RecordFor(100);
  EXPECT_EQ(files_.size(), 1U);
  EXPECT_TRUE(files_[0].closed) << "what was not fetched stays";
  EXPECT_LE(older_bytes_ + depth().recorded * 5 * kMb, 2020 * kMb);
}

TEST_F(SpoolTest, F41TheDisksReserveIsMadeRoomForAsWell) {
  options_.set_when_full(DELETE_FETCHED);
  fetched_ = {90 * kMb, 900 * kMb};
  older_bytes_ = 990 * kMb;
  Start();
  RecordFor(10);
  free_bytes_ = 599 * kMb;
  RecordFor(5);
  EXPECT_EQ(fetched_.size(), 1U);
  EXPECT_FALSE(files_[0].closed);
  EXPECT_EQ(depth().record_failed, 0U);
}

TEST_F(SpoolTest, F41WhereDeletingFreesNothingNotAllIsDeleted) {
  options_.set_when_full(DELETE_FETCHED);
  fetched_ = {90 * kMb, 90 * kMb, 90 * kMb, 90 * kMb};
  older_bytes_ = 360 * kMb;
  deleting_frees_ = false;
  Start();
  RecordFor(10);
  free_bytes_ = 599 * kMb;
  RecordFor(60);
  EXPECT_EQ(fetched_.size(), 3U);
  EXPECT_TRUE(files_[0].closed);
}

TEST_F(SpoolTest, F41AFreeSpaceThatIsNotKnownIsNoFullDisk) {
  free_bytes_ = Err(IoError("the free space is not known"));
  Start();
  for (std::uint64_t i = 0; i < 20; ++i) {
    clock_.Advance(std::chrono::seconds(1));
    files_.back().bytes += 5 * kMb;
    Record(i);
  }
  EXPECT_EQ(depth().recorded, 20U);
  EXPECT_EQ(spool_->status().brief, "free space of the disk not known");
  EXPECT_EQ(spool_->status().free_bytes, std::nullopt);
  free_bytes_ = 1'000'000 * kMb;
  clock_.Advance(std::chrono::seconds(1));
  Record(20);
  EXPECT_EQ(spool_->status().brief, "");
  EXPECT_EQ(spool_->status().free_bytes, 1'000'000 * kMb);
}

TEST_F(SpoolTest, AMessageThatCannotBeRecordedIsNotTheDisksFault) {
  Start();
  Record(0);
  files_[0].refuse_next = true;
  Record(1);
  Record(2);
  EXPECT_EQ(files_.size(), 1U);
  EXPECT_EQ(files_[0].depth_frames, (std::vector<std::uint64_t>{0, 2}));
  EXPECT_EQ(depth().record_failed, 1U);
}

TEST_F(SpoolTest, F01WhatIsCollectedGoesToTheDiskWhenFramesStop) {
  Start();
  Record(0);
  EXPECT_EQ(files_[0].flushes, 0);
  spool_->Tend(/*idle=*/true);
  EXPECT_EQ(files_[0].flushes, 1);
}

TEST_F(SpoolTest, EachFileSaysByHowMuchTheWallClockIsOff) {
  Start(1);
  EncodedFrame frame = Depth(0);
  frame.wall_minus_time = milliseconds(500);
  spool_->Add(frame);
  spool_->Add(frame);  // Fails.
  clock_.Advance(kLongerThanAnyBackOff);
  room_ = UINT64_MAX;
  spool_->Add(frame);
  ASSERT_EQ(files_.size(), 2U);
  ASSERT_EQ(files_[1].clock_steps.size(), 1U);
  EXPECT_EQ(files_[1].clock_steps[0].wall_minus_time, milliseconds(500));
}

}  // namespace
}  // namespace isotherm
