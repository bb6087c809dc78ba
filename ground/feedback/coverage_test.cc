#include "ground/feedback/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

constexpr auto kGood = static_cast<std::uint8_t>(ConditionClass::kGood);
constexpr auto kAcceptable = static_cast<std::uint8_t>(ConditionClass::kAcceptable);
constexpr auto kBad = static_cast<std::uint8_t>(ConditionClass::kBad);

/// One row: `surface` pixels seen at `distance_m` and `angle_deg`, never measured, then `empty`
/// ones.
ViewMaps Row(int surface, int empty, double distance_m, double angle_deg) {
  ViewMaps view;
  view.Resize(surface + empty, 1);
  view.celsius.Fill(NAN);
  view.distance_class.Fill(kNeverMeasured);
  view.angle_class.Fill(kNeverMeasured);
  view.motion_class.Fill(kNeverMeasured);  // Unchecked.
  view.cos_view.Fill(NAN);
  view.distance_m.Fill(NAN);
  for (int x = 0; x < surface; ++x) {
    view.cos_view.At(x, 0) = static_cast<float>(std::cos(angle_deg * M_PI / 180.0));
    view.distance_m.At(x, 0) = static_cast<float>(distance_m);
  }
  return view;
}

ThermalOptions Limits() { return WithAnglesOfMaterial(ThermalOptions()); }

void Measure(ViewMaps& view, int x, std::uint8_t distance, std::uint8_t angle) {
  view.celsius.At(x, 0) = 20.0F;
  view.distance_class.At(x, 0) = distance;
  view.angle_class.At(x, 0) = angle;
}

TEST(CoverageTest, FractionsAreOfTheSurfaceAndAddUpToOne) {
  ViewMaps view = Row(8, 2, 0.5, 20.0);
  Measure(view, 0, kGood, kGood);
  Measure(view, 1, kGood, kGood);
  Measure(view, 2, kGood, kAcceptable);
  Measure(view, 3, kAcceptable, kAcceptable);
  Measure(view, 4, kAcceptable, kGood);
  Measure(view, 5, kBad, kGood);
  const CoverageSummary coverage = SummarizeCoverage(view, {}, Limits());
  EXPECT_DOUBLE_EQ(coverage.surface, 0.8);
  EXPECT_DOUBLE_EQ(coverage.good, 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.acceptable, 3.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.bad, 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.never_measured, 2.0 / 8.0);
}

TEST(CoverageTest, IsZeroWithoutASurface) {
  const CoverageSummary coverage = SummarizeCoverage(Row(0, 5, 0.5, 0.0), {}, Limits());
  EXPECT_EQ(coverage.surface, 0.0);
  EXPECT_EQ(coverage.never_measured, 0.0);
  EXPECT_EQ(SummarizeCoverage(ViewMaps(), {}, Limits()).surface, 0.0);
}

TEST(CoverageTest, WhatHindersIsSaidOfWhatIsNotYetGood) {
  ThermalOptions options;  // 0.30 to 0.60 m.
  options.mutable_angle()->set_min_deg(10);
  options.mutable_angle()->set_good_deg(40);
  const ThermalOptions limits = WithAnglesOfMaterial(options);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.61, 20.0), {}, limits).too_far, 1.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.59, 20.0), {}, limits).too_far, 0.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.29, 20.0), {}, limits).too_near, 1.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.50, 41.0), {}, limits).too_oblique, 1.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.50, 39.0), {}, limits).too_oblique, 0.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.50, 9.0), {}, limits).too_frontal, 1.0);
  EXPECT_EQ(SummarizeCoverage(Row(4, 0, 0.50, 11.0), {}, limits).too_frontal, 0.0);
  ViewMaps view = Row(4, 0, 0.61, 20.0);
  Measure(view, 0, kGood, kGood);
  Measure(view, 1, kAcceptable, kGood);
  EXPECT_DOUBLE_EQ(SummarizeCoverage(view, {}, limits).too_far, 3.0 / 4.0);
}

TEST(CoverageTest, MotionHindersWhereNothingElseDoes) {
  const ThermalOptions limits = Limits();  // Up to 0.5 px of smear are good.
  ViewMaps view = Row(6, 0, 0.5, 20.0);
  Measure(view, 0, kGood, kGood);
  view.distance_m.At(1, 0) = 0.7F;  // Too far.
  Image<float> smear_px(6, 1, 1.2F);
  smear_px.At(2, 0) = 0.4F;
  smear_px.At(3, 0) = NAN;  // The thermal camera does not see it.
  smear_px.At(4, 0) = 2.0F;
  const CoverageSummary coverage = SummarizeCoverage(view, smear_px, limits);
  EXPECT_DOUBLE_EQ(coverage.too_fast, 2.0 / 6.0);
  EXPECT_NEAR(coverage.smear_px, 1.6, 0.41);
  EXPECT_EQ(SummarizeCoverage(view, {}, limits).too_fast, 0.0) << "the motion is not known";
}

TEST(CoverageTest, WhatWasMeasuredWhileTheRigMovedTooFastIsNotGood) {
  ViewMaps view = Row(2, 0, 0.5, 20.0);
  Measure(view, 0, kGood, kGood);
  Measure(view, 1, kGood, kGood);
  view.motion_class.At(0, 0) = kGood;
  view.motion_class.At(1, 0) = kAcceptable;
  const CoverageSummary coverage = SummarizeCoverage(view, {}, Limits());
  EXPECT_DOUBLE_EQ(coverage.good, 0.5);
  EXPECT_DOUBLE_EQ(coverage.acceptable, 0.5);
}

}  // namespace
}  // namespace isotherm
