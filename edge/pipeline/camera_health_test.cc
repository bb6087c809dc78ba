#include "edge/pipeline/camera_health.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// The percentiles in StageStats are as exact as this.
constexpr double kRelativeTolerance = 0.01;

class CameraHealthTest : public ::testing::Test {
 protected:
  CameraReport Depth() const { return health_.Get(Sensor::kDepth); }

  CameraHealth health_;
};

TEST_F(CameraHealthTest, BeforeAnythingIsKnownThereIsNoCamera) {
  EXPECT_EQ(Depth().state, CameraState::kNone);
  EXPECT_EQ(Depth().failures, 0U);
  EXPECT_TRUE(std::isnan(Depth().stamp_sigma_s));
  EXPECT_TRUE(std::isnan(Depth().stamping_p50_s));
  EXPECT_TRUE(std::isnan(Depth().stamping_p99_s));
}

TEST_F(CameraHealthTest, CountsHowOftenACameraWasLost) {
  for (const bool works : {true, false, true, false}) health_.SetWorks(Sensor::kDepth, works);
  EXPECT_EQ(Depth().state, CameraState::kLost);
  EXPECT_EQ(Depth().failures, 2U);
  health_.SetWorks(Sensor::kDepth, true);
  EXPECT_EQ(Depth().state, CameraState::kWorking);
  EXPECT_EQ(Depth().failures, 2U);
}

TEST_F(CameraHealthTest, ALostCameraIsLostAlsoIfItsLastImageShowedNothing) {
  health_.SetWorks(Sensor::kDepth, true);
  health_.SetBlind(Sensor::kDepth, true);
  EXPECT_EQ(Depth().state, CameraState::kBlind);
  EXPECT_EQ(Depth().failures, 0U) << "it works";
  health_.SetWorks(Sensor::kDepth, false);
  EXPECT_EQ(Depth().state, CameraState::kLost);
  health_.SetWorks(Sensor::kDepth, true);
  EXPECT_EQ(Depth().state, CameraState::kBlind) << "no image has shown anything since";
  health_.SetBlind(Sensor::kDepth, false);
  EXPECT_EQ(Depth().state, CameraState::kWorking);
}

TEST_F(CameraHealthTest, WhatOneCameraDoesIsNotSaidOfTheOther) {
  health_.SetWorks(Sensor::kThermal, false);
  health_.SetBlind(Sensor::kThermal, true);
  health_.NoteStamp(Sensor::kThermal, {.time = {}, .sigma = 1ms, .synchronised = false});
  health_.AddStamping(Sensor::kThermal, 1ms);
  EXPECT_EQ(Depth().state, CameraState::kNone);
  EXPECT_EQ(Depth().failures, 0U);
  EXPECT_EQ(Depth().unsynchronised_frames, 0U);
  EXPECT_TRUE(std::isnan(Depth().stamp_sigma_s));
  EXPECT_TRUE(std::isnan(Depth().stamping_p50_s));
  EXPECT_EQ(health_.Get(Sensor::kThermal).failures, 1U);
}

TEST_F(CameraHealthTest, SigmaIsTheNewestStampsAndStampsNotToBeTrustedAreCounted) {
  health_.NoteStamp(Sensor::kDepth, {.time = {}, .sigma = 5ms, .synchronised = false});
  health_.NoteStamp(Sensor::kDepth, {.time = {}, .sigma = 2ms, .synchronised = true});
  health_.NoteStamp(Sensor::kDepth, {.time = {}, .sigma = 300us, .synchronised = false});
  EXPECT_DOUBLE_EQ(Depth().stamp_sigma_s, 300e-6);
  EXPECT_EQ(Depth().unsynchronised_frames, 2U);
}

TEST_F(CameraHealthTest, TimeToStampIsReportedInSeconds) {
  for (int i = 1; i <= 100; ++i) health_.AddStamping(Sensor::kDepth, i * 1ms);
  EXPECT_NEAR(Depth().stamping_p50_s, 0.050, 0.050 * kRelativeTolerance);
  EXPECT_NEAR(Depth().stamping_p99_s, 0.099, 0.099 * kRelativeTolerance);
}

}  // namespace
}  // namespace isotherm
