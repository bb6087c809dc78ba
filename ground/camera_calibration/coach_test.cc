#include "ground/camera_calibration/coach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ground/camera_calibration/simulated_session.h"

namespace isotherm {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(CalibrationCoachTest, UncertaintyShrinksAndLessIsMissingAsViewsCome) {
  TargetSession session;
  session.count = 16;
  session.seed = 12;
  ThreadPool pool(2);
  const CalibrationInput input = TakeViews(session, pool);
  CalibrationCoach coach(input.target, {"thermal"}, input.lenses);
  const std::size_t missing_at_start = coach.status().front().missing.size();
  std::vector<double> uncertainties;
  for (const CalibrationView& view : input.views) {
    coach.Add(0, view.images.front());
    if (const auto sigma = coach.status().front().uncertainty_px) uncertainties.push_back(*sigma);
  }
  const CoachStatus& status = coach.status().front();
  EXPECT_EQ(status.views, 16);
  EXPECT_EQ(status.refused, 0);
  // From the sixth view on.
  ASSERT_EQ(uncertainties.size(), 11U);
  // By their number alone, sixteen views are 0.61 times as uncertain as six.
  EXPECT_LT(uncertainties.back(), 0.61 * uncertainties.front());
  EXPECT_LT(status.missing.size(), missing_at_start);
  EXPECT_GT(status.zones[4], 0);
  EXPECT_GT(*status.max_uncertainty_px, *status.uncertainty_px);
  EXPECT_THAT(status.Line(), HasSubstr("thermal: 16 views, uncertain by 0."));
}

TEST(CalibrationCoachTest, ViewsOfTheMiddleAloneLeaveCornersAndTiltsMissing) {
  TargetSession session;
  session.count = 3;
  session.views = {
      .min_distance_m = 1.2, .max_distance_m = 1.3, .max_tilt_deg = 3.0, .border_px = 70.0};
  ThreadPool pool(2);
  const CalibrationInput input = TakeViews(session, pool);
  CalibrationCoach coach(input.target, {"thermal"}, input.lenses);
  for (const CalibrationView& view : input.views) coach.Add(0, view.images.front());
  const CoachStatus& status = coach.status().front();
  EXPECT_EQ(status.views, 3);
  EXPECT_FALSE(status.uncertainty_px.has_value());
  EXPECT_THAT(status.missing, Contains(HasSubstr("in the upper left corner")));
  EXPECT_THAT(status.missing, Contains(HasSubstr("its left side nearer")));
}

TEST(CalibrationCoachTest, ImagesWithoutTheTargetAreCountedWithTheReason) {
  CalibrationCoach coach(*ParseTarget("thesis-board"), {"thermal"}, {LensKind::kBrownConrady});
  coach.Add(0, Image<float>(382, 288, 30000.0F));
  EXPECT_EQ(coach.status().front().views, 0);
  EXPECT_EQ(coach.status().front().refused, 1);
  EXPECT_THAT(coach.status().front().last_refusal, HasSubstr("were not found"));
}

}  // namespace
}  // namespace isotherm
