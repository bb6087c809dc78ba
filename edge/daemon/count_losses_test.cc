#include "edge/daemon/count_losses.h"

#include <gtest/gtest.h>

#include <memory>

#include "edge/options/edge_options.pb.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

class CountLossesTest : public ::testing::Test {
 protected:
  /// Reads all that the script gives, as the daemon has it counted.
  void Play(std::string_view script) {
    SupervisedSource camera(
        std::make_unique<FakeSource>(script), FrameCheckOptions(), clock_,
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kRejected); });
    CountLosses(camera, counters_);
    ASSERT_TRUE(camera.Open().ok());
    for (;;) {
      const Result<SourceItem> item = camera.Read({});
      ASSERT_TRUE(item.has_value());
      if (std::holds_alternative<EndOfStream>(*item)) break;
    }
  }

  FakeClock clock_;
  FrameCounters counters_;
};

TEST_F(CountLossesTest, WhatTheCameraLostWasNotCaptured) {
  Play("2*d d:lost d");
  const SensorCounters depth = counters_.Get(Sensor::kDepth);
  EXPECT_EQ(depth.captured, 4U);
  EXPECT_EQ(depth.lost_in_camera, 3U);
  EXPECT_EQ(depth.left_out, 0U);
}

TEST_F(CountLossesTest, WhatTheEdgeDidNotTakeInTimeWasCapturedAndGoesNeitherWay) {
  Play("2*t t:left t");
  const SensorCounters thermal = counters_.Get(Sensor::kThermal);
  EXPECT_EQ(thermal.captured, 7U);
  EXPECT_EQ(thermal.left_out, 3U);
  EXPECT_EQ(thermal.lost_in_camera, 0U);
  EXPECT_EQ(thermal.OnTheWayToDisk(), 4);
  EXPECT_EQ(counters_.Get(Sensor::kDepth).captured, 0U);
}

}  // namespace
}  // namespace isotherm
