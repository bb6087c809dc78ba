#include "edge/publisher/published_stream.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class PublishedStreamTest : public ::testing::Test {
 protected:
  PublishedStreamTest() {
    for (const std::uint64_t number : {0, 1, 2, 10}) stream_.Note(number, TimeOf(number));
  }
  static CaptureTime TimeOf(std::uint64_t number) { return CaptureTime(1h + number * 33ms); }
  static Feedback About(std::uint64_t number) {
    Feedback feedback;
    feedback.frame_number = number;
    feedback.capture_time = TimeOf(number);
    return feedback;
  }
  std::optional<RefusalCause> CheckReceipt(std::uint64_t next, std::uint64_t received) const {
    return stream_.Check(StreamReceipt{.next = next, .handled = 0, .received = received});
  }

  PublishedStream stream_;
};

TEST_F(PublishedStreamTest, F60AReceiptCannotBeAheadOfWhatWasPublished) {
  EXPECT_EQ(CheckReceipt(11, 4), std::nullopt);
  EXPECT_EQ(CheckReceipt(0, 0), std::nullopt);
  EXPECT_EQ(CheckReceipt(12, 4), RefusalCause::kImpossibleNumber);
  EXPECT_EQ(CheckReceipt(11, 5), RefusalCause::kImpossibleNumber);
}

TEST_F(PublishedStreamTest, F60FeedbackIsAboutAPublishedFrameAndItsTime) {
  EXPECT_EQ(stream_.Check(About(2)), std::nullopt);
  EXPECT_EQ(stream_.Check(About(10)), std::nullopt);
  EXPECT_EQ(stream_.Check(About(5)), RefusalCause::kImpossibleNumber);
  EXPECT_EQ(stream_.Check(About(11)), RefusalCause::kImpossibleNumber);
  Feedback feedback = About(2);
  feedback.capture_time += 1h;
  EXPECT_EQ(stream_.Check(feedback), RefusalCause::kOutOfRange);
}

TEST_F(PublishedStreamTest, F60FeedbackOnAFrameOfLongAgoIsRefused) {
  for (std::uint64_t number = 11; number < 2000; ++number) stream_.Note(number, TimeOf(number));
  EXPECT_EQ(stream_.Check(About(2)), RefusalCause::kImpossibleNumber);
  EXPECT_EQ(stream_.Check(About(1500)), std::nullopt);
}

TEST_F(PublishedStreamTest, WhatWasSentAgainIsToldFromWhatWasNot) {
  stream_.NoteAgain(2);
  stream_.NoteAgain(7);  // It was left for later.
  EXPECT_TRUE(stream_.WasSentAgain(2));
  EXPECT_FALSE(stream_.WasSentAgain(1));
  EXPECT_FALSE(stream_.WasSentAgain(10));
  EXPECT_EQ(stream_.Check(About(2)), std::nullopt);
}

TEST_F(PublishedStreamTest, ANewSessionStartsFromNothing) {
  stream_.BeginSession(0);
  EXPECT_EQ(CheckReceipt(1, 0), RefusalCause::kImpossibleNumber);
  EXPECT_EQ(stream_.Check(About(2)), RefusalCause::kImpossibleNumber);
}

}  // namespace
}  // namespace isotherm
