#include "ground/subscriber/stream_receiver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "common/codec/codec.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

constexpr CaptureTime kArrival = CaptureTimeFromNanoseconds(1'000);

EncodedThermalFrame MakeFrame(std::uint64_t session, std::uint64_t number) {
  EncodedThermalFrame frame;
  frame.header.session = session;
  frame.header.frame_number = number;
  frame.image = {.encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
  frame.nuc_state = NucState::kIdle;
  frame.seconds_since_nuc = 4.5;
  frame.housekeeping.housing_celsius = 33.0F;
  frame.valid = true;
  return frame;
}

EncodedThermalFrame At(std::uint64_t session, std::uint64_t number, Nanoseconds time) {
  EncodedThermalFrame frame = MakeFrame(session, number);
  frame.header.capture_time = CaptureTimeFromNanoseconds(time.count());
  return frame;
}

class StreamReceiverTest : public ::testing::Test {
 protected:
  bool Add(EncodedThermalFrame frame) {
    const bool good = receiver_.Add(std::move(frame), kArrival, now_);
    receiver_.DeliverDue(now_);
    return good;
  }
  static std::vector<std::uint64_t> Numbers(const std::vector<ReceivedThermal>& items) {
    std::vector<std::uint64_t> numbers;
    for (const auto& item : items) numbers.push_back(item.frame->header.frame_number);
    return numbers;
  }

  static constexpr Nanoseconds kInterval = 100ms;
  void AddRecorded(std::uint64_t session, const std::vector<std::uint64_t>& numbers) {
    std::vector<RecordedNumbers::Frame> frames;
    for (const std::uint64_t number : numbers)
      frames.push_back({number, CaptureTimeFromNanoseconds((kInterval * number).count())});
    receiver_.AddRecorded(session, frames, now_);
  }
  static std::vector<std::pair<std::uint64_t, std::uint64_t>> Ranges(
      const std::vector<FrameRange>& holes) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
    for (const FrameRange& hole : holes) ranges.emplace_back(hole.first, hole.last);
    return ranges;
  }

  RefusalCounter refusals_;
  std::vector<ReceivedThermal> delivered_;
  std::vector<ReceivedThermal> late_;
  StreamReceiver<ReceivedThermal> receiver_{
      "thermal", 200ms, &refusals_,
      [this](ReceivedThermal item) { delivered_.push_back(std::move(item)); },
      [this](ReceivedThermal item) { late_.push_back(std::move(item)); }};
  SteadyTime now_{1h};
};

TEST_F(StreamReceiverTest, FrameIsUnpackedWithAllThatBelongsToIt) {
  EXPECT_TRUE(Add(MakeFrame(1, 0)));
  ASSERT_EQ(delivered_.size(), 1U);
  const ThermalFrame& frame = *delivered_[0].frame;
  EXPECT_THAT(frame.temperature_raw.pixels(), ElementsAre(0x0201, 0x0403));
  EXPECT_EQ(frame.nuc_state, NucState::kIdle);
  EXPECT_EQ(frame.seconds_since_nuc, 4.5);
  EXPECT_EQ(frame.housekeeping.housing_celsius, 33.0F);
  EXPECT_TRUE(frame.valid);
  EXPECT_EQ(delivered_[0].encoded->image.payload.size(), 4U);
  EXPECT_EQ(delivered_[0].arrival, kArrival);
}

TEST_F(StreamReceiverTest, CountsAreNeverTakenForTemperatures) {
  EncodedThermalFrame counts = MakeFrame(1, 0);  // It even says that it is valid.
  counts.image.encoding = Encoding::kCounts16;
  EXPECT_TRUE(Add(counts));
  ASSERT_EQ(delivered_.size(), 1U);
  EXPECT_TRUE(delivered_[0].frame->temperature_raw.empty());
  EXPECT_FALSE(delivered_[0].frame->valid);
  EXPECT_EQ(delivered_[0].encoded->image.payload, counts.image.payload);  // For the recording.
}

TEST_F(StreamReceiverTest, F20DuplicateIsDeliveredOnce) {
  EXPECT_TRUE(Add(MakeFrame(1, 0)));
  EXPECT_FALSE(Add(MakeFrame(1, 0)));
  EXPECT_EQ(delivered_.size(), 1U);
  EXPECT_EQ(receiver_.tally(1).duplicates, 1U);
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(StreamReceiverTest, F21LateFrameGoesTheOtherWay) {
  Add(MakeFrame(1, 1));
  now_ += 200ms;
  receiver_.DeliverDue(now_);
  EXPECT_TRUE(Add(MakeFrame(1, 0)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(1));
  EXPECT_THAT(Numbers(late_), ElementsAre(0));
  EXPECT_EQ(receiver_.tally(1).late, 1U);
  EXPECT_EQ(receiver_.tally(1).received, 2U);
}

TEST_F(StreamReceiverTest, F60UndecodablePayloadIsRefusedAndItsNumberStaysFree) {
  EncodedThermalFrame broken = MakeFrame(1, 0);
  broken.image.payload.pop_back();
  EXPECT_FALSE(Add(broken));
  EXPECT_EQ(refusals_.count(RefusalCause::kUndecodable), 1U);
  EXPECT_TRUE(Add(MakeFrame(1, 0)));
  EXPECT_EQ(delivered_.size(), 1U);
}

TEST_F(StreamReceiverTest, F60AnImageOfMorePixelsThanACameraHasIsRefused) {
  EncodedThermalFrame large = MakeFrame(1, 0);
  large.image.width = 1 << 12;
  large.image.height = (1 << 10) + 1;
  large.image.payload.resize(2 * (kMaxFramePixels + (std::size_t{1} << 12U)));
  EXPECT_FALSE(Add(large));
  EXPECT_EQ(refusals_.count(RefusalCause::kUndecodable), 1U);
}

TEST_F(StreamReceiverTest, F60UndecodableFrameDoesNotStartASession) {
  Add(MakeFrame(1, 0));
  EncodedThermalFrame broken = MakeFrame(2, 0);
  broken.image.payload.clear();
  EXPECT_FALSE(Add(broken));
  EXPECT_TRUE(Add(MakeFrame(1, 1)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 1));
}

TEST_F(StreamReceiverTest, F60FrameOfASessionThatIsOverIsRefused) {
  Add(MakeFrame(1, 0));
  Add(MakeFrame(2, 0));
  EXPECT_FALSE(Add(MakeFrame(1, 1)));
  EXPECT_EQ(refusals_.count(RefusalCause::kOtherSession), 1U);
  EXPECT_TRUE(Add(MakeFrame(2, 1))) << "the newer one goes on";
}

TEST_F(StreamReceiverTest, ANewSessionIsCountedFromZero) {
  Add(MakeFrame(11, 0));
  Add(MakeFrame(11, 1));
  Add(MakeFrame(7, 0));  // Numbers of sessions need not grow.
  EXPECT_EQ(receiver_.tally(11).received, 2U);
  EXPECT_EQ(receiver_.tally(7).received, 1U);
  EXPECT_EQ(receiver_.receipt(7).handled, 1U);
  EXPECT_EQ(receiver_.receipt(11).handled, 0U) << "the edge is told of the current one only";
}

TEST_F(StreamReceiverTest, OfASessionThatIsNotRememberedNothingIsCounted) {
  for (const std::uint64_t session : {1U, 2U, 3U}) Add(MakeFrame(session, 0));
  EXPECT_EQ(receiver_.tally(2).received, 1U);
  for (const std::uint64_t session : {1U, 77U}) {
    EXPECT_EQ(receiver_.tally(session).session, session);
    EXPECT_EQ(receiver_.tally(session).received, 0U) << session;
    EXPECT_EQ(receiver_.tally(session).next, 0U) << session;
  }
}

TEST_F(StreamReceiverTest, MemoryOfSessionsIsBounded) {
  for (std::uint64_t session = 0; session < 1000; ++session)
    EXPECT_TRUE(Add(MakeFrame(session, 0)));
  EXPECT_FALSE(Add(MakeFrame(998, 1)));
  EXPECT_TRUE(Add(MakeFrame(0, 1))) << "forgotten";
}

TEST_F(StreamReceiverTest, F60OneImpossibleNumberStopsNoneBehindIt) {
  Add(At(1, 0, 0ms));
  EXPECT_FALSE(Add(At(1, 5'600'000, 40ms)));
  for (std::uint64_t i = 1; i <= 500; ++i) {
    now_ += 40ms;
    EXPECT_TRUE(Add(At(1, i, i * 40ms)));
  }
  EXPECT_EQ(refusals_.count(RefusalCause::kImpossibleNumber), 1U);
  EXPECT_EQ(refusals_.total(), 1U);
  EXPECT_EQ(delivered_.size(), 501U);
  const StreamTally tally = receiver_.tally(1);
  EXPECT_EQ(tally.next, 501U);
  EXPECT_EQ(tally.refused[static_cast<std::size_t>(RefusalCause::kImpossibleNumber)], 1U);
}

TEST_F(StreamReceiverTest, F60OneFarFutureTimeStopsNoneBehindIt) {
  Add(At(1, 0, 0ms));
  EXPECT_FALSE(Add(At(1, 1, 24h)));  // Of an attacker, before the good one of this number.
  EXPECT_TRUE(Add(At(1, 1, 40ms)));
  EXPECT_TRUE(Add(At(1, 2, 80ms)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 1, 2));
  EXPECT_EQ(refusals_.count(RefusalCause::kImplausibleTime), 1U);
}

TEST_F(StreamReceiverTest, F23ARealJumpIsFollowedWithoutLoss) {
  Add(At(1, 0, 0ms));
  EXPECT_FALSE(Add(At(1, 5'600'000, 40ms)));
  EXPECT_FALSE(Add(At(1, 5'600'001, 80ms)));
  EXPECT_TRUE(Add(At(1, 5'600'002, 120ms)));
  EXPECT_TRUE(Add(At(1, 5'600'003, 160ms)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 5'600'000, 5'600'001, 5'600'002, 5'600'003));
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(StreamReceiverTest, AFrameThatFillsAHoleDoesNotContradictAJump) {
  Add(At(1, 0, 0ms));
  Add(At(1, 10, 400ms));
  now_ += 1s;
  receiver_.DeliverDue(now_);
  EXPECT_FALSE(Add(At(1, 5'600'000, 440ms)));
  EXPECT_TRUE(Add(At(1, 4, 160ms)));  // From the rig's recording.
  EXPECT_FALSE(Add(At(1, 5'600'001, 480ms)));
  EXPECT_TRUE(Add(At(1, 5'600'002, 520ms)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 10, 5'600'000, 5'600'001, 5'600'002));
  EXPECT_THAT(Numbers(late_), ElementsAre(4));
  EXPECT_TRUE(late_.front().is_late);
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(StreamReceiverTest, F23AWildFirstNumberDoesNotMakeAllOthersLate) {
  Add(At(1, 1ULL << 39U, 0ms));
  for (std::uint64_t i = 0; i < 10; ++i) Add(At(1, i, (i + 1) * 40ms));
  EXPECT_EQ(delivered_.size(), 11U);
  EXPECT_THAT(Numbers(late_), IsEmpty());
}

TEST_F(StreamReceiverTest, AJumpThatNothingConfirmsIsRefusedInTheEnd) {
  Add(At(1, 0, 0ms));
  Add(At(1, 1, 24h));
  now_ += StreamReceiver<ReceivedThermal>::kMaxPending;
  receiver_.DeliverDue(now_);
  EXPECT_EQ(refusals_.count(RefusalCause::kImplausibleTime), 1U);
  Add(At(1, 1, 24h));
  receiver_.DeliverAll();
  EXPECT_EQ(refusals_.count(RefusalCause::kImplausibleTime), 2U);
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0));
}

TEST_F(StreamReceiverTest, WhatWasRefusedBelongsToItsSession) {
  Add(MakeFrame(1, 0));
  refusals_.Add(RefusalCause::kOtherWriter, "");
  Add(MakeFrame(2, 0));
  EXPECT_EQ(receiver_.tally(1).refused[static_cast<std::size_t>(RefusalCause::kOtherWriter)], 1U);
  EXPECT_EQ(receiver_.tally(2).refused[static_cast<std::size_t>(RefusalCause::kOtherWriter)], 0U);
  EXPECT_EQ(receiver_.tally(1).received, 1U);
}

TEST_F(StreamReceiverTest, ANewSessionFirstDeliversWhatWaitedInTheOldOne) {
  Add(MakeFrame(1, 0));
  Add(MakeFrame(1, 2));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0));
  Add(MakeFrame(2, 0));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 2, 0));
  EXPECT_EQ(delivered_.back().frame->header.session, 2U);
}

/// A recording of yesterday, as fast as the ground takes it.
class ReplayLaneTest : public StreamReceiverTest {
 protected:
  ReplayLaneTest() { receiver_.SetReplay(true); }
  bool Add(std::uint64_t number, Nanoseconds time) {
    now_ += 1ms;
    const bool good = receiver_.Add(At(1, number, time), kToday, now_);
    receiver_.DeliverDue(now_);
    return good;
  }
  static constexpr CaptureTime kToday = CaptureTimeFromNanoseconds(Nanoseconds(24h).count());
};

TEST_F(ReplayLaneTest, AGapOfTheRecordingCostsNoFrame) {
  Add(0, 1s);
  Add(1, 1033ms);
  Add(2, 1h);
  Add(3, 1h + 33ms);
  Add(4, 2h);  // The last of the recording, after another gap.
  receiver_.DeliverAll();
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(ReplayLaneTest, ARecordingOfFewFramesIsAllGaps) {
  for (std::uint64_t i = 0; i < 5; ++i) Add(i, 1s + 2s * static_cast<int>(i));
  receiver_.DeliverAll();
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(refusals_.total(), 0U);
}

TEST_F(ReplayLaneTest, TheLastFrameOfAScanIsNotWaitedForLong) {
  Add(0, 1s);
  Add(1, 1h);
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0));
  now_ += StreamReceiver<ReceivedThermal>::kMaxPending;
  receiver_.DeliverDue(now_);
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 1));
}

TEST_F(ReplayLaneTest, AWildFrameIsRefusedAndStopsNoneBehindIt) {
  Add(0, 1s);
  Add(1, 1h);
  Add(2, 1066ms);
  Add(3, 25h);  // In the future of whoever plays it.
  receiver_.DeliverAll();
  EXPECT_THAT(Numbers(delivered_), ElementsAre(0, 2));
  EXPECT_EQ(refusals_.count(RefusalCause::kImplausibleTime), 2U);
}

TEST_F(StreamReceiverTest, F32WhatIsRecordedAlreadyIsNotAskedForAndNotTakenAgain) {
  AddRecorded(7, {0, 1, 2, 5});  // Before the session's first frame.
  EXPECT_EQ(receiver_.receipt(7).next, 6U) << "also of a camera of which nothing more comes";
  EXPECT_EQ(receiver_.receipt(7).handled, 6U);
  EXPECT_TRUE(Add(At(7, 9, kInterval * 9)));
  EXPECT_THAT(Ranges(receiver_.receipt(7).holes), ElementsAre(Pair(3, 4), Pair(6, 8)));
  AddRecorded(7, {3, 4, 5, 9});
  EXPECT_THAT(Ranges(receiver_.receipt(7).holes), ElementsAre(Pair(6, 8)));
  EXPECT_EQ(receiver_.receipt(7).next, 10U);
  EXPECT_EQ(receiver_.receipt(7).received, 7U);
  EXPECT_EQ(receiver_.tally(7).recorded_before, 6U) << "the fifth twice, the ninth came";
  EXPECT_FALSE(Add(At(7, 4, kInterval * 4)));
  EXPECT_EQ(receiver_.tally(7).duplicates, 1U);
  now_ += 1s;
  receiver_.DeliverDue(now_);
  EXPECT_TRUE(Add(At(7, 6, kInterval * 6)));
  EXPECT_THAT(Numbers(delivered_), ElementsAre(9));
  EXPECT_THAT(Numbers(late_), ElementsAre(6));
}

TEST_F(StreamReceiverTest, F32WhatComesFollowsTheLastRecordedFrame) {
  // Five minutes are recorded; the first frame that comes is one of the first that lack.
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t i = 1; i < 3000; ++i) numbers.push_back(i);
  AddRecorded(7, numbers);
  EXPECT_TRUE(Add(At(7, 0, kInterval * 0)));
  EXPECT_TRUE(Add(At(7, 3100, kInterval * 3100)));
  EXPECT_EQ(refusals_.total(), 0U);
  EXPECT_THAT(Numbers(late_), ElementsAre(0));
  receiver_.DeliverAll();
  EXPECT_THAT(Numbers(delivered_), ElementsAre(3100));
}

TEST_F(StreamReceiverTest, F32WhatIsRecordedOfASessionThatIsOverChangesNothing) {
  EXPECT_TRUE(Add(MakeFrame(7, 0)));
  EXPECT_TRUE(Add(MakeFrame(8, 2)));
  AddRecorded(7, {0, 1, 2});
  EXPECT_EQ(receiver_.receipt(8).received, 1U);
  EXPECT_EQ(receiver_.tally(8).recorded_before, 0U);
  EXPECT_EQ(receiver_.tally(7).received, 1U);
}

}  // namespace
}  // namespace isotherm
