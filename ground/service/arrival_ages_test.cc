#include "ground/service/arrival_ages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr CaptureTime kCapture = CaptureTimeFromNanoseconds(1'000'000'000'000);

SessionClock Clock(double rig_minus_ground_s, double uncertainty_s, double steps_s = 0.0) {
  SessionClock clock;
  clock.offset = ClockOffset{rig_minus_ground_s, uncertainty_s};
  clock.rig.step_sum_s = steps_s;
  return clock;
}

TEST(ArrivalAgesTest, TheClocksDifferenceIsTakenOff) {
  ArrivalAges ages;
  // The rig is five seconds ahead: by its own clock a frame arrives before it was captured.
  ages.SetClock(Clock(5.0, 0.002));
  ages.Add(Sensor::kDepth, kCapture, kCapture - 5s + 30ms);
  ages.Add(Sensor::kThermal, kCapture, kCapture - 5s + 12ms);
  // Then its clock is set back by these; capture times go on as before.
  ages.SetClock(Clock(0.0, 0.001, -5.0));
  ages.Add(Sensor::kDepth, kCapture + 1s, kCapture + 1s - 5s + 30ms);
  const Json json = ages.Describe();
  EXPECT_EQ(json["depth"]["frames"], 2);
  EXPECT_THAT(json["depth"]["p50_ms"].get<double>(), DoubleNear(30.0, 0.2));
  EXPECT_THAT(json["depth"]["max_ms"].get<double>(), DoubleNear(30.0, 0.001));
  EXPECT_THAT(json["thermal"]["p99_ms"].get<double>(), DoubleNear(12.0, 0.1));
  EXPECT_EQ(json["uncertainty_ms"], 2.0) << "the worst that was used";
  EXPECT_THAT(ages.ToText(), HasSubstr("depth p50 30 ms, p99 30 ms; thermal 12, 12 ms; within 2"));
}

TEST(ArrivalAgesTest, WhatCannotBeComparedDoesNotCount) {
  ArrivalAges ages;
  ages.Add(Sensor::kDepth, kCapture, kCapture + 30ms);
  EXPECT_TRUE(ages.Describe().is_null());
  EXPECT_THAT(ages.ToText(), IsEmpty());
  ages.SetClock(Clock(0.0, 0.001));
  ages.Add(Sensor::kDepth, kCapture, kCapture + 30ms);
  ages.SetClock({});  // No echo has come for a while.
  ages.Add(Sensor::kDepth, kCapture, kCapture + 90ms);
  ages.SetClock(Clock(0.0, 0.001));
  ages.Add(Sensor::kDepth, kCapture, kCapture + 24h);  // A recording of yesterday is played.
  EXPECT_EQ(ages.Describe()["depth"]["frames"], 1);
}

}  // namespace
}  // namespace isotherm
