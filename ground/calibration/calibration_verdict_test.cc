#include "ground/calibration/calibration_verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

/// A scan that tells everything, by whose word nothing has moved.
Refinement Right() {
  Refinement refinement;
  refinement.shift = {.rms_px = 0.2, .sigma_px = 0.1};
  refinement.correction[kDelay] = 0.0005;
  refinement.covariance(kDelay, kDelay) = 0.0005 * 0.0005;
  refinement.held_out.improves = true;
  refinement.observed_directions = kPlacementParameters;
  refinement.epoch_offset = EpochOffset{0.1, 0.02};
  return refinement;
}

TEST(CalibrationVerdictTest, WhatIsWithinTheLimitsAgrees) {
  const CalibrationVerdict verdict = Assess(Right(), {});
  EXPECT_EQ(verdict.pose, CheckVerdict::kAgrees);
  EXPECT_EQ(verdict.delay, CheckVerdict::kAgrees);
  EXPECT_EQ(verdict.offset, CheckVerdict::kAgrees);
  EXPECT_FALSE(verdict.Moved());
}

TEST(CalibrationVerdictTest, EachPartMovesByItself) {
  Refinement refinement = Right();
  refinement.shift.rms_px = 0.6;
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kMoved);
  EXPECT_EQ(Assess(refinement, {}).delay, CheckVerdict::kAgrees);
  EXPECT_EQ(Assess(refinement, {.shift_px = 0.7}).pose, CheckVerdict::kAgrees);
  EXPECT_THAT(DescribePose(refinement, CheckVerdict::kMoved), HasSubstr("moved by 0.60 px"));
  refinement = Right();
  refinement.correction[kDelay] = -0.004;
  EXPECT_EQ(Assess(refinement, {}).delay, CheckVerdict::kMoved);
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kAgrees);
  refinement = Right();
  refinement.epoch_offset->kelvin = -1.1;
  EXPECT_EQ(Assess(refinement, {}).offset, CheckVerdict::kMoved);
  EXPECT_FALSE(Assess(refinement, {}).Moved()) << "its placement has not";
}

TEST(CalibrationVerdictTest, ADelayThatHasMovedIsIsBothLargeAndCertain) {
  const auto assess = [](double off_s, double sigma_s) {
    return Assess({.delay_s = off_s, .sigma_s = sigma_s}, 0.003);
  };
  EXPECT_EQ(assess(0.0029, 0.0001), CheckVerdict::kAgrees) << "too small to matter";
  EXPECT_EQ(assess(0.0031, 0.0001), CheckVerdict::kMoved);
  EXPECT_EQ(assess(-0.0031, 0.0001), CheckVerdict::kMoved);
  EXPECT_EQ(assess(0.0055, 0.0019), CheckVerdict::kAgrees) << "within three sigma";
  EXPECT_EQ(assess(0.0060, 0.0019), CheckVerdict::kMoved);
  EXPECT_EQ(assess(0.0100, 0.0060), CheckVerdict::kNotAssessed) << "agrees with nearly all";
  EXPECT_EQ(assess(0.0200, 0.0060), CheckVerdict::kMoved) << "but not with this";
}

TEST(CalibrationVerdictTest, WhatIsUncertainNeitherAgreesNorHasMoved) {
  Refinement refinement = Right();
  refinement.shift = {.rms_px = 1.5, .sigma_px = 1.1};
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kNotAssessed);
  refinement.shift.rms_px = 3.4;
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kMoved) << "but by so much it has";
  refinement.epoch_offset = EpochOffset{1.5, 0.6};
  EXPECT_EQ(Assess(refinement, {}).offset, CheckVerdict::kNotAssessed);
  refinement.epoch_offset.reset();
  EXPECT_EQ(Assess(refinement, {}).offset, CheckVerdict::kNotAssessed);
}

TEST(CalibrationVerdictTest, InfluenceIsTheSumOfBothFractions) {
  Refinement refinement = Right();
  refinement.correction[kNearInfluence] = 0.05;
  refinement.correction[kTotalInfluence] = -0.045;
  const auto set_sigma = [&](double sigma, double correlation) {
    refinement.covariance.block<2, 2>(kNearInfluence, kNearInfluence) << 1.0, correlation,
        correlation, 1.0;
    refinement.covariance.block<2, 2>(kNearInfluence, kNearInfluence) *= sigma * sigma;
  };
  set_sigma(0.05, -0.999);  // The sum's is 0.0022.
  EXPECT_EQ(Assess(refinement, {}).influence, CheckVerdict::kAgrees);
  EXPECT_EQ(Assess(refinement, {.influence = 0.004}).influence, CheckVerdict::kAgrees);
  refinement.correction[kTotalInfluence] = -0.035;
  EXPECT_EQ(Assess(refinement, {}).influence, CheckVerdict::kMoved);
  EXPECT_TRUE(Assess(refinement, {}).Moved());
  EXPECT_FALSE(Assess(refinement, {}).Agrees());
  EXPECT_THAT(DescribeInfluence(refinement, CheckVerdict::kMoved), HasSubstr("moved by +1.5 %"));
  set_sigma(0.05, 0.0);
  EXPECT_EQ(Assess(refinement, {}).influence, CheckVerdict::kNotAssessed);
  EXPECT_TRUE(Assess(refinement, {}).Agrees()) << "where it is not told, there is little of it";
}

TEST(CalibrationVerdictTest, WhatIsNoNumberIsNotTold) {
  Refinement refinement = Right();
  refinement.shift.sigma_px = NAN;
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kNotAssessed);
  refinement.shift = {.rms_px = NAN, .sigma_px = 0.1};
  EXPECT_EQ(Assess(refinement, {}).pose, CheckVerdict::kNotAssessed);
}

TEST(CalibrationVerdictTest, WhatImagesThatWereHeldOutRefuteHasNotMoved) {
  Refinement refinement = Right();
  refinement.shift.rms_px = 2.0;
  refinement.correction[kDelay] = 0.02;
  refinement.held_out.improves = false;
  const CalibrationVerdict verdict = Assess(refinement, {});
  EXPECT_EQ(verdict.pose, CheckVerdict::kRefuted);
  EXPECT_EQ(verdict.delay, CheckVerdict::kRefuted);
  EXPECT_THAT(DescribePose(refinement, verdict.pose), HasSubstr("do not agree better"));
}

}  // namespace
}  // namespace isotherm
