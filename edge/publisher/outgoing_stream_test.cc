#include "edge/publisher/outgoing_stream.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class OutgoingStreamTest : public ::testing::Test {
 protected:
  void Publish(std::uint64_t number) {
    stream_.sent().Note(number, CaptureTime{});
    stream_.OnPublished(number);
  }
  /// The ground says that it has received all frames below `next`.
  std::optional<RefusalCause> Check(std::uint64_t next, std::uint64_t received) const {
    return stream_.sent().Check(StreamReceipt{.next = next, .received = received});
  }

  OutgoingStream stream_{2, 10s};
  SteadyTime now_{1h};
};

TEST_F(OutgoingStreamTest, CountsWhatWasPublishedAndTheHighestNumber) {
  for (const std::uint64_t number : {0, 1, 7}) Publish(number);
  EXPECT_EQ(stream_.counts().published, 3U);
  EXPECT_EQ(stream_.counts().next_frame_number, 8U);
  EXPECT_EQ(stream_.counts().failed, 0U);
}

TEST_F(OutgoingStreamTest, AFrameThatFailedIsNotPublishedAndTakesNoRoom) {
  Publish(0);
  stream_.sent().Note(1, CaptureTime{});
  stream_.OnFailed();
  EXPECT_EQ(stream_.counts().published, 1U);
  EXPECT_EQ(stream_.counts().failed, 1U);
  EXPECT_EQ(stream_.counts().next_frame_number, 1U) << "the ground must not be told to wait for it";
  EXPECT_TRUE(stream_.window().HasRoom());
  Publish(2);
  EXPECT_FALSE(stream_.window().HasRoom()) << "two are under way";
}

TEST_F(OutgoingStreamTest, AFrameFromTheRecordingCountsOnceAndMayBeReceivedAgain) {
  for (const std::uint64_t number : {0, 3}) Publish(number);
  stream_.sent().NoteAgain(1);
  EXPECT_TRUE(stream_.OnBackfilled(1)) << "it had been dropped before the link";
  EXPECT_EQ(stream_.counts().published, 3U);
  stream_.sent().NoteAgain(3);
  EXPECT_FALSE(stream_.OnBackfilled(3)) << "the link had lost it";
  EXPECT_EQ(stream_.counts().published, 3U);
  EXPECT_EQ(stream_.counts().next_frame_number, 4U);
  EXPECT_EQ(Check(4, 3), std::nullopt);
  EXPECT_EQ(Check(5, 3), RefusalCause::kImpossibleNumber) << "nobody sent it";
  stream_.BeginSession({});
  stream_.sent().NoteAgain(3);
  EXPECT_TRUE(stream_.OnBackfilled(3));
  EXPECT_EQ(Check(4, 1), std::nullopt) << "nothing else was published: the network came late";
}

TEST_F(OutgoingStreamTest, ANewSessionKnowsNothingOfTheOneBefore) {
  for (const std::uint64_t number : {0, 1, 2}) Publish(number);
  stream_.OnFailed();
  ASSERT_FALSE(stream_.window().HasRoom());
  ASSERT_EQ(Check(3, 3), std::nullopt);
  stream_.BeginSession({});
  EXPECT_EQ(stream_.counts().published, 0U);
  EXPECT_EQ(stream_.counts().failed, 0U);
  EXPECT_EQ(stream_.counts().next_frame_number, 0U);
  EXPECT_TRUE(stream_.window().HasRoom());
  EXPECT_EQ(Check(3, 3), RefusalCause::kImpossibleNumber);
}

TEST_F(OutgoingStreamTest, ASessionThatGoesOnKnowsWhatTheProcessBeforeMayHaveSent) {
  stream_.BeginSession({.frames = 90, .next_frame_number = 100, .number_limit = 130});
  EXPECT_EQ(stream_.counts().published, 90U);
  EXPECT_EQ(stream_.counts().next_frame_number, 100U);
  EXPECT_EQ(Check(105, 104), std::nullopt) << "some of them were not recorded";
  EXPECT_EQ(Check(131, 100), RefusalCause::kImpossibleNumber);
  stream_.sent().NoteAgain(40);
  EXPECT_FALSE(stream_.OnBackfilled(40)) << "it counts as published already";
  Publish(130);
  EXPECT_EQ(stream_.counts().published, 91U);
  // The ground has four frames that the recording does not have, and not all of what it has.
  stream_.OnReceipt({.next = 131, .handled = 100, .received = 80, .holes = {{104, 129}}}, now_);
  EXPECT_EQ(stream_.counts().published, 91U);
  stream_.OnReceipt({.next = 131, .handled = 131, .received = 95, .holes = {{104, 129}}}, now_);
  EXPECT_EQ(stream_.counts().published, 95U) << "94 of those before, and one";
  EXPECT_EQ(Check(131, 105), std::nullopt);
}

TEST_F(OutgoingStreamTest, AReaderIsNewForHalfASecond) {
  EXPECT_FALSE(stream_.HasNewReader(0, now_));
  EXPECT_TRUE(stream_.HasNewReader(1, now_));
  EXPECT_TRUE(stream_.HasNewReader(1, now_ + 500ms - 1ns));
  EXPECT_FALSE(stream_.HasNewReader(1, now_ + 500ms));
}

TEST_F(OutgoingStreamTest, ASecondReaderIsNewByItself) {
  stream_.HasNewReader(1, now_);
  EXPECT_FALSE(stream_.HasNewReader(1, now_ + 2s));
  EXPECT_TRUE(stream_.HasNewReader(2, now_ + 3s));
  EXPECT_FALSE(stream_.HasNewReader(2, now_ + 4s));
  EXPECT_FALSE(stream_.HasNewReader(1, now_ + 5s)) << "who is left was there before";
}

TEST_F(OutgoingStreamTest, AReaderThatHasLeftIsNotNew) {
  stream_.HasNewReader(1, now_);
  EXPECT_FALSE(stream_.HasNewReader(0, now_ + 1ms));
  EXPECT_TRUE(stream_.HasNewReader(1, now_ + 2s)) << "it is back";
}

TEST_F(OutgoingStreamTest, TheSuccessorOfAGroundThatLeftIsNewAlthoughTheNumberOfReadersIsTheSame) {
  stream_.HasNewReader(1, now_);
  ASSERT_FALSE(stream_.HasNewReader(1, now_ + 2s));
  stream_.ForgetReaders();
  EXPECT_TRUE(stream_.HasNewReader(1, now_ + 3s));
}

TEST_F(OutgoingStreamTest, F30ALinkThatIsMadeAnewKnowsEachFrameThatWasPublished) {
  stream_.BeginSession({.frames = 10, .next_frame_number = 10, .number_limit = 20});
  for (const std::uint64_t number : {20, 21, 24}) Publish(number);  // Two were left for later.
  const PublishedBefore so_far = stream_.so_far();
  OutgoingStream anew{2, 10s};
  anew.BeginSession(so_far);
  EXPECT_EQ(anew.counts().published, 13U);
  EXPECT_EQ(anew.counts().next_frame_number, 25U);
  EXPECT_EQ(anew.sent().Check(StreamReceipt{.next = 25, .received = 13}), std::nullopt);
  anew.sent().NoteAgain(22);
  EXPECT_TRUE(anew.OnBackfilled(22)) << "it had been left";
  EXPECT_FALSE(anew.OnBackfilled(24)) << "it had been published";
  EXPECT_FALSE(anew.OnBackfilled(9)) << "by the process before";
  // The ground has one of the process before that nobody recorded, and all of this one.
  anew.OnReceipt({.next = 25, .handled = 25, .received = 15, .holes = {{10, 18}, {23, 23}}}, now_);
  EXPECT_EQ(anew.counts().published, 15U);
}

}  // namespace
}  // namespace isotherm
