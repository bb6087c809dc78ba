#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <numeric>
#include <thread>
#include <vector>

#include "common/base/processor_time.h"
#include "common/concurrency/bounded_queue.h"
#include "common/concurrency/latest_value.h"
#include "common/concurrency/thread_pool.h"

namespace isotherm {
namespace {

TEST(BoundedQueueTest, PopForGivesUpWhenNothingComesAndStillEmptiesAStoppedQueue) {
  BoundedQueue<int> queue(2, OverflowPolicy::kBlock);
  EXPECT_EQ(queue.PopFor(std::chrono::milliseconds(1), {}), std::nullopt);
  queue.Push(7, {});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(queue.PopFor(std::chrono::hours(1), stop.get_token()), 7);
  EXPECT_EQ(queue.PopFor(std::chrono::hours(1), stop.get_token()), std::nullopt);
}

TEST(BoundedQueueTest, DropOldestKeepsTheNewestAndCounts) {
  BoundedQueue<int> queue(2, OverflowPolicy::kDropOldest);
  const std::stop_source stop;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(queue.Push(i, stop.get_token()));
  EXPECT_EQ(queue.dropped(), 3U);
  EXPECT_EQ(queue.Pop(stop.get_token()), 3);
  EXPECT_EQ(queue.Pop(stop.get_token()), 4);
}

TEST(BoundedQueueTest, BlockingProducerLosesNothing) {
  BoundedQueue<int> queue(3, OverflowPolicy::kBlock);
  const std::stop_source stop;
  constexpr int kCount = 1000;
  std::jthread producer([&] {
    for (int i = 0; i < kCount; ++i) queue.Push(i, stop.get_token());
  });
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(queue.Pop(stop.get_token()), i);
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(BoundedQueueTest, StopWakesTheConsumerButLeavesWhatIsQueued) {
  BoundedQueue<int> queue(3, OverflowPolicy::kBlock);
  std::stop_source stop;
  queue.Push(7, stop.get_token());
  stop.request_stop();
  EXPECT_EQ(queue.Pop(stop.get_token()), 7);
  EXPECT_EQ(queue.Pop(stop.get_token()), std::nullopt);
}

TEST(BoundedQueueTest, StopWakesABlockedProducer) {
  BoundedQueue<int> queue(1, OverflowPolicy::kBlock);
  std::stop_source stop;
  queue.Push(1, stop.get_token());
  std::jthread stopper([&] { stop.request_stop(); });
  EXPECT_FALSE(queue.Push(2, stop.get_token()));
}

TEST(LatestValueTest, TakeEmptiesTheMailboxAndGetDoesNot) {
  LatestValue<int> mailbox;
  EXPECT_EQ(mailbox.Get(), std::nullopt);
  mailbox.Set(1);
  mailbox.Set(2);
  EXPECT_EQ(mailbox.Get(), 2);
  EXPECT_EQ(mailbox.Take(), 2);
  EXPECT_EQ(mailbox.Get(), std::nullopt);
}

/// All else in this process rests meanwhile, so its processor time is that of the loop.
TEST(ThreadPoolTest, WorkOfTheThreadsCountsForTheCaller) {
  ThreadPool pool(3);
  const auto process_s = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double process_before_s = process_s();
  const auto before = ThreadProcessorTime();
  pool.ParallelFor(30, [&](int) {
    const auto start = ThreadProcessorTime();
    while (ThreadProcessorTime() - start < std::chrono::milliseconds(5)) {
    }
  });
  const double counted_s = std::chrono::duration<double>(ThreadProcessorTime() - before).count();
  EXPECT_GE(counted_s, 0.149);
  EXPECT_NEAR(counted_s, process_s() - process_before_s, 0.02);
}

TEST(ThreadPoolTest, EachIndexIsVisitedOnceWhateverTheThreadCount) {
  for (int threads = 1; threads <= 4; ++threads) {
    ThreadPool pool(threads);
    for (int round = 0; round < 200; ++round) {
      std::vector<int> visits(97, 0);
      pool.ParallelFor(97, [&](int i) { ++visits[i]; });
      EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 97);
      EXPECT_EQ(*std::max_element(visits.begin(), visits.end()), 1);
    }
    pool.ParallelFor(0, [](int) { FAIL() << "no index to visit"; });
  }
}

}  // namespace
}  // namespace isotherm
