#include "edge/frame_counters/frame_counters.h"

#include <gtest/gtest.h>

#include <thread>

namespace isotherm {
namespace {

class FrameCountersTest : public ::testing::Test {
 protected:
  SensorCounters Depth() const { return counters_.Get(Sensor::kDepth); }

  FrameCounters counters_;
};

TEST_F(FrameCountersTest, EachFateHasItsOwnCount) {
  std::uint64_t count = 0;
  for (const FrameFate fate :
       {FrameFate::kCaptured, FrameFate::kRejected, FrameFate::kLeftOut, FrameFate::kLostInCamera,
        FrameFate::kRecorded, FrameFate::kRecordQueueFull, FrameFate::kRecordFailed,
        FrameFate::kPublished, FrameFate::kPublishQueueFull, FrameFate::kPublishFailed}) {
    counters_.Count(Sensor::kDepth, fate, ++count);
  }
  EXPECT_EQ(Depth().captured, 1U);
  EXPECT_EQ(Depth().rejected, 2U);
  EXPECT_EQ(Depth().left_out, 3U);
  EXPECT_EQ(Depth().lost_in_camera, 4U);
  EXPECT_EQ(Depth().recorded, 5U);
  EXPECT_EQ(Depth().record_queue_full, 6U);
  EXPECT_EQ(Depth().record_failed, 7U);
  EXPECT_EQ(Depth().published, 8U);
  EXPECT_EQ(Depth().publish_queue_full, 9U);
  EXPECT_EQ(Depth().publish_failed, 10U);
  EXPECT_EQ(counters_.Get(Sensor::kThermal).captured, 0U) << "the other camera's";
}

TEST_F(FrameCountersTest, AFrameIsOnBothWaysUntilEachHasAnEnd) {
  counters_.Count(Sensor::kDepth, FrameFate::kCaptured, 3);
  EXPECT_EQ(Depth().OnTheWayToDisk(), 3);
  EXPECT_EQ(Depth().OnTheWayToGround(), 3);
  counters_.Count(Sensor::kDepth, FrameFate::kRecorded);
  counters_.Count(Sensor::kDepth, FrameFate::kRecordQueueFull);
  counters_.Count(Sensor::kDepth, FrameFate::kRecordFailed);
  EXPECT_EQ(Depth().OnTheWayToDisk(), 0);
  EXPECT_EQ(Depth().OnTheWayToGround(), 3);
  counters_.Count(Sensor::kDepth, FrameFate::kPublished);
  counters_.Count(Sensor::kDepth, FrameFate::kPublishQueueFull);
  counters_.Count(Sensor::kDepth, FrameFate::kPublishFailed);
  EXPECT_EQ(Depth().OnTheWayToGround(), 0);
}

TEST_F(FrameCountersTest, AFrameThatIsLeftForLaterIsNotOnTheWayUntilItIsSentAfterAll) {
  counters_.Count(Sensor::kDepth, FrameFate::kCaptured);
  counters_.Count(Sensor::kDepth, FrameFate::kLeftForLater);
  EXPECT_EQ(Depth().OnTheWayToGround(), 0);
  EXPECT_EQ(Depth().left_for_later, 1U);
  counters_.CountPublishedAfterAll(Sensor::kDepth);
  EXPECT_EQ(Depth().OnTheWayToGround(), 0);
  EXPECT_EQ(Depth().left_for_later, 0U);
  EXPECT_EQ(Depth().published, 1U);
}

TEST_F(FrameCountersTest, ARejectedFrameAndOneLeftOutGoNeitherWay) {
  for (const FrameFate fate : {FrameFate::kRejected, FrameFate::kLeftOut}) {
    counters_.Count(Sensor::kDepth, FrameFate::kCaptured);
    counters_.Count(Sensor::kDepth, fate);
    EXPECT_EQ(Depth().OnTheWayToDisk(), 0);
    EXPECT_EQ(Depth().OnTheWayToGround(), 0);
  }
}

TEST_F(FrameCountersTest, WhatTheCameraLostWasNeverCaptured) {
  counters_.Count(Sensor::kDepth, FrameFate::kLostInCamera, 5);
  EXPECT_EQ(Depth().captured, 0U);
  EXPECT_EQ(Depth().OnTheWayToDisk(), 0);
  EXPECT_EQ(Depth().OnTheWayToGround(), 0);
}

TEST_F(FrameCountersTest, ACountThatSomebodyElseKeepsReplacesTheOneBefore) {
  counters_.Set(Sensor::kDepth, FrameFate::kPublished, 8);
  counters_.Set(Sensor::kDepth, FrameFate::kPublished, 9);
  EXPECT_EQ(Depth().published, 9U);
}

TEST_F(FrameCountersTest, FramesThatMoveOnMeanwhileAreNeverFewerThanNone) {
  constexpr int kFrames = 100'000;
  const std::jthread line([this] {
    for (int frame = 0; frame < kFrames; ++frame) {
      counters_.Count(Sensor::kDepth, FrameFate::kCaptured);
      counters_.Count(Sensor::kDepth, FrameFate::kRecorded);
      counters_.Count(Sensor::kDepth, FrameFate::kPublished);
    }
  });
  for (SensorCounters seen; seen.published < kFrames; seen = Depth()) {
    ASSERT_GE(seen.OnTheWayToDisk(), 0);
    ASSERT_GE(seen.OnTheWayToGround(), 0);
  }
}

TEST_F(FrameCountersTest, WhatIsPublishedAfterAllIsNoLongerDropped) {
  counters_.Count(Sensor::kDepth, FrameFate::kCaptured, 4);
  counters_.Count(Sensor::kDepth, FrameFate::kPublished);
  counters_.Count(Sensor::kDepth, FrameFate::kPublishQueueFull, 2);
  counters_.Count(Sensor::kDepth, FrameFate::kPublishFailed);
  for (std::uint64_t published = 2; published <= 4; ++published) {
    counters_.CountPublishedAfterAll(Sensor::kDepth);
    EXPECT_EQ(Depth().published, published);
    EXPECT_EQ(Depth().OnTheWayToGround(), 0);
  }
  EXPECT_EQ(Depth().publish_queue_full + Depth().publish_failed, 0U);
  counters_.CountPublishedAfterAll(Sensor::kDepth);
  EXPECT_EQ(Depth().published, 4U) << "no more than were dropped";
}

}  // namespace
}  // namespace isotherm
