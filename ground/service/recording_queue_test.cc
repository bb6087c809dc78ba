#include "ground/service/recording_queue.h"

#include <gtest/gtest.h>

#include <thread>

#include "ground/service/health.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kPatience = 60s;  // Far above anything measured.
constexpr std::chrono::nanoseconds kNow = 0ns;

SessionItem Frame(std::uint64_t number, std::size_t bytes = 1) {
  auto encoded = std::make_shared<EncodedDepthFrame>();
  encoded->header.frame_number = number;
  encoded->image.payload.resize(bytes);
  ReceivedDepth depth;
  depth.encoded = std::move(encoded);
  return depth;
}

/// The number of the next frame; nullopt if there is none.
std::optional<std::uint64_t> Next(RecordingQueue& queue) {
  std::optional<SessionItem> item;
  if (queue.Pop(kNow, {}, item) != RecordingQueue::Outcome::kItem) return std::nullopt;
  return std::get<ReceivedDepth>(*item).encoded->header.frame_number;
}

TEST(RecordingQueueTest, BoundedByItems) {
  RecordingQueue queue({.items = 2, .bytes = 100});
  EXPECT_TRUE(queue.Offer(Frame(0), kNow, {}));
  EXPECT_TRUE(queue.Offer(Frame(1), kNow, {}));
  EXPECT_FALSE(queue.Offer(Frame(2), kNow, {}));
  EXPECT_EQ(Next(queue), 0U);
  EXPECT_TRUE(queue.Offer(Frame(3), kNow, {}));
  EXPECT_EQ(Next(queue), 1U);
  EXPECT_EQ(Next(queue), 3U);
  EXPECT_EQ(Next(queue), std::nullopt);
}

TEST(RecordingQueueTest, BoundedByBytesButOneFrameAlwaysFits) {
  RecordingQueue queue({.items = 100, .bytes = 10});
  EXPECT_TRUE(queue.Offer(Frame(0, 50), kNow, {}));
  EXPECT_FALSE(queue.Offer(Frame(1), kNow, {}));
  EXPECT_EQ(Next(queue), 0U);
  EXPECT_TRUE(queue.Offer(Frame(2, 6), kNow, {}));
  EXPECT_TRUE(queue.Offer(Frame(3, 4), kNow, {}));
  EXPECT_FALSE(queue.Offer(Frame(4, 1), kNow, {}));
}

TEST(RecordingQueueTest, BeginningsAndEndsAreAlwaysTaken) {
  RecordingQueue queue({.items = 1, .bytes = 1});
  EXPECT_TRUE(queue.Offer(Frame(0), kNow, {}));
  queue.Push(SessionCounters());
  EXPECT_EQ(Next(queue), 0U);
  std::optional<SessionItem> item;
  ASSERT_EQ(queue.Pop(kNow, {}, item), RecordingQueue::Outcome::kItem);
  EXPECT_TRUE(std::holds_alternative<SessionCounters>(*item));
}

TEST(RecordingQueueTest, AProducerWithPatienceWaitsForRoom) {
  RecordingQueue queue({.items = 1, .bytes = 1});
  ASSERT_TRUE(queue.Offer(Frame(0), kNow, {}));
  std::jthread consumer([&] { EXPECT_EQ(Next(queue), 0U); });
  EXPECT_TRUE(queue.Offer(Frame(1), kPatience, {}));
}

TEST(RecordingQueueTest, F42AQueueThatDoesNotMoveIsWaitedForOnce) {
  RecordingQueue queue({.items = 1, .bytes = 1});
  ASSERT_TRUE(queue.Offer(Frame(0), kNow, {}));
  EXPECT_FALSE(queue.Offer(Frame(1), 1ms, {}));
  // Would not end in this test's life if it waited.
  EXPECT_FALSE(queue.Offer(Frame(2), std::chrono::hours(1), {}));
  EXPECT_EQ(Next(queue), 0U);
  EXPECT_TRUE(queue.Offer(Frame(3), kNow, {}));
}

TEST(RecordingQueueTest, StopEndsWaitingOnBothSides) {
  RecordingQueue queue({.items = 1, .bytes = 1});
  std::stop_source stop;
  stop.request_stop();
  ASSERT_TRUE(queue.Offer(Frame(0), kNow, {}));
  EXPECT_FALSE(queue.Offer(Frame(1), std::chrono::hours(1), stop.get_token()));
  std::optional<SessionItem> item;
  EXPECT_EQ(queue.Pop(kPatience, stop.get_token(), item), RecordingQueue::Outcome::kItem);
  EXPECT_EQ(queue.Pop(kPatience, stop.get_token(), item), RecordingQueue::Outcome::kEnd);
}

class HealthTest : public ::testing::Test {
 protected:
  Health health_{60s};
  SteadyTime now_{1h};
};

TEST_F(HealthTest, ThreadsThatWaitAreWell) {
  EXPECT_EQ(health_.Problem(now_), std::nullopt);
  health_.reconstruction.Busy(now_);
  health_.reconstruction.Idle();
  EXPECT_EQ(health_.Problem(now_ + 1h), std::nullopt);
}

TEST_F(HealthTest, F39AThreadThatHangsIsAProblemHoweverEmptyItsQueueIs) {
  health_.reconstruction.Busy(now_);
  EXPECT_EQ(health_.Problem(now_ + 10s), std::nullopt);
  EXPECT_EQ(health_.Problem(now_ + 11s), "the reconstruction has not gone on for 11 s");
  health_.reconstruction.Busy(now_ + 11s);
  EXPECT_EQ(health_.Problem(now_ + 12s), std::nullopt);
  health_.receive.Busy(now_);
  EXPECT_EQ(health_.Problem(now_ + 12s), "reception has not gone on for 12 s");
}

TEST_F(HealthTest, F39ADiskMayTakeLongerButNotForEver) {
  health_.recording.Busy(now_);
  health_.results.Busy(now_);
  EXPECT_EQ(health_.Problem(now_ + 60s), std::nullopt);
  EXPECT_EQ(health_.Problem(now_ + 61s),
            "the recording (is the disk stuck?) has not gone on for 61 s");
  health_.recording.Idle();
  EXPECT_EQ(health_.Problem(now_ + 61s),
            "writing results (is the disk stuck?) has not gone on for 61 s");
}

}  // namespace
}  // namespace isotherm
