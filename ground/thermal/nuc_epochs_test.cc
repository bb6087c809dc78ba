#include "ground/thermal/nuc_epochs.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

class NucEpochsTest : public ::testing::Test {
 protected:
  NucAge Next(bool valid, std::optional<double> seconds = std::nullopt,
              float housing_celsius = kUnknown_celsius) {
    ThermalFrame frame;
    frame.housekeeping.housing_celsius = housing_celsius;
    frame.valid = valid;
    frame.seconds_since_nuc = seconds;
    frame.header.capture_time = CaptureTime{} + FromSeconds(0.1 * number_++);
    return epochs_.Follow(frame);
  }
  NucEpochs epochs_;
  int number_ = 0;
};

TEST_F(NucEpochsTest, AShutterThatClosesForSeveralFramesIsOneNuc) {
  EXPECT_EQ(Next(true).epoch, 0);
  const NucAge second = Next(true);
  EXPECT_FALSE(second.seconds_since) << "none seen";
  EXPECT_NEAR(second.seconds_followed, 0.1, 1e-9);
  for (int i = 0; i < 4; ++i) Next(false);
  const NucAge after = Next(true);
  EXPECT_EQ(after.epoch, 1);
  EXPECT_NEAR(*after.seconds_since, 0.1, 1e-9) << "since the last frame that was not valid";
  EXPECT_NEAR(*Next(true).seconds_since, 0.2, 1e-9);
  Next(false);
  EXPECT_EQ(Next(true).epoch, 2);
}

TEST_F(NucEpochsTest, TheCamerasOwnCountShowsANucBetweenFrames) {
  EXPECT_EQ(Next(true, 100.0).epoch, 0);
  EXPECT_EQ(*Next(true, 100.1).seconds_since, 100.1);
  EXPECT_EQ(Next(true, 0.7).epoch, 1);
}

TEST_F(NucEpochsTest, ACountThatFallsWhileTheShutterIsClosedIsNotASecondNuc) {
  Next(true, 100.0);
  Next(false, 100.1);
  Next(false, 0.0);
  EXPECT_EQ(Next(true, 0.6).epoch, 1);
  EXPECT_EQ(Next(true, 0.7).epoch, 1);
}

TEST_F(NucEpochsTest, AScanThatStartsWithAClosedShutterStartsInItsFirstEpoch) {
  Next(false);
  EXPECT_EQ(Next(true).epoch, 0);
}

TEST_F(NucEpochsTest, TheHousingsChangeIsCountedFromTheFirstFrameAfterEachNuc) {
  EXPECT_FALSE(Next(true, 100.0).housing_change_k) << "not told";
  EXPECT_EQ(Next(true, 100.1, 30.0F).housing_change_k, 0.0);
  EXPECT_EQ(Next(true, 100.2, 30.5F).housing_change_k, 0.5);
  EXPECT_FALSE(Next(true, 100.3).housing_change_k) << "told no longer";
  EXPECT_EQ(Next(true, 0.1, 31.0F).housing_change_k, 0.0) << "a NUC between frames";
  EXPECT_EQ(Next(true, 0.2, 30.75F).housing_change_k, -0.25);
  EXPECT_FALSE(Next(false, 0.3, 40.0F).housing_change_k) << "the shutter is closed";
  EXPECT_EQ(Next(true, 0.1, 32.0F).housing_change_k, 0.0);
}

}  // namespace
}  // namespace isotherm
