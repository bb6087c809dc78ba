#include "edge/source/merge_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace isotherm {
namespace {

using std::chrono::milliseconds;

SourceItem FrameAt(Sensor sensor, int at_ms) {
  RawFrame frame;
  frame.sensor = sensor;
  frame.arrival_wall = CaptureTime(milliseconds(at_ms));
  return frame;
}

/// Arrival of the next frame, ms; -1: nothing yet; -2: the end.
std::int64_t PopArrival(MergeQueue& queue) {
  const SourceItem item = queue.Pop(Nanoseconds(0), {});
  if (std::holds_alternative<EndOfStream>(item)) return -2;
  const auto* frame = std::get_if<RawFrame>(&item);
  return frame ? frame->arrival_wall.time_since_epoch() / milliseconds(1) : -1;
}

class MergeQueueTest : public ::testing::Test {
 protected:
  MergeQueue Make(std::size_t capacity, OverflowPolicy policy = OverflowPolicy::kDropOldest) {
    return MergeQueue(2, capacity, policy, [this](Sensor sensor) {
      (sensor == Sensor::kDepth ? depth_dropped_ : thermal_dropped_) += 1;
    });
  }
  int depth_dropped_ = 0;
  int thermal_dropped_ = 0;
};

TEST_F(MergeQueueTest, WhatArrivedFirstComesFirst) {
  MergeQueue queue = Make(8);
  queue.Push(0, FrameAt(Sensor::kDepth, 10), {});
  queue.Push(0, FrameAt(Sensor::kDepth, 43), {});
  queue.Push(1, FrameAt(Sensor::kThermal, 5), {});
  queue.Push(1, FrameAt(Sensor::kThermal, 30), {});
  EXPECT_EQ(PopArrival(queue), 5);
  EXPECT_EQ(PopArrival(queue), 10);
  EXPECT_EQ(PopArrival(queue), 30);
  EXPECT_EQ(PopArrival(queue), 43);
  EXPECT_EQ(PopArrival(queue), -1);
}

TEST_F(MergeQueueTest, ACameraThatFloodsDropsItsOwnOldestOnly) {
  MergeQueue queue = Make(3);
  queue.Push(1, FrameAt(Sensor::kThermal, 0), {});
  for (int i = 1; i <= 5; ++i) queue.Push(0, FrameAt(Sensor::kDepth, i), {});
  EXPECT_EQ(depth_dropped_, 2);
  EXPECT_EQ(thermal_dropped_, 0);
  for (const int expected : {0, 3, 4, 5, -1}) EXPECT_EQ(PopArrival(queue), expected);
}

TEST_F(MergeQueueTest, TheEndIsTheEndOfAllCamerasAndOfAllFrames) {
  MergeQueue queue = Make(3);
  queue.Push(0, FrameAt(Sensor::kDepth, 1), {});
  queue.End(0);
  EXPECT_EQ(PopArrival(queue), 1);
  EXPECT_EQ(PopArrival(queue), -1) << "the other camera goes on";
  queue.Push(1, FrameAt(Sensor::kThermal, 2), {});
  queue.End(1);
  EXPECT_EQ(PopArrival(queue), 2);
  EXPECT_EQ(PopArrival(queue), -2);
}

TEST_F(MergeQueueTest, ABlockingQueueWaitsForRoomAndLosesNothingAtAStop) {
  MergeQueue queue = Make(2, OverflowPolicy::kBlock);
  std::jthread producer([&queue](const std::stop_token& stop) {
    for (int i = 0; i < 6; ++i) queue.Push(0, FrameAt(Sensor::kDepth, i), stop);
    queue.End(0);
  });
  for (int i = 0; i < 3; ++i) {
    const SourceItem item = queue.Pop(std::chrono::seconds(20), {});
    ASSERT_TRUE(std::holds_alternative<RawFrame>(item));
  }
  producer.request_stop();
  producer.join();
  for (const int expected : {3, 4, 5, -1}) EXPECT_EQ(PopArrival(queue), expected);
  EXPECT_EQ(depth_dropped_, 0);
}

}  // namespace
}  // namespace isotherm
