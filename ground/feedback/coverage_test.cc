#include "ground/feedback/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/ground_options.pb.h"

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
  view.cos_view.Fill(NAN);
  view.distance_m.Fill(NAN);
  for (int x = 0; x < surface; ++x) {
    view.cos_view.At(x, 0) = static_cast<float>(std::cos(angle_deg * M_PI / 180.0));
    view.distance_m.At(x, 0) = static_cast<float>(distance_m);
  }
  return view;
}

void Measure(ViewMaps& view, int x, std::uint8_t distance, std::uint8_t angle) {
  view.celsius.At(x, 0) = 20.0F;
  view.distance_class.At(x, 0) = distance;
  view.angle_class.At(x, 0) = angle;
}

OperatorAdvice AdviceFor(const ViewMaps& view, const ScanSituation& situation = {}) {
  return AdviseOperator(SummarizeCoverage(view, ThermalOptions()), situation, ThermalOptions());
}

TEST(CoverageTest, SharesAreOfTheSurfaceAndAddUpToOne) {
  ViewMaps view = Row(8, 2, 0.5, 20.0);
  Measure(view, 0, kGood, kGood);
  Measure(view, 1, kGood, kGood);
  Measure(view, 2, kGood, kAcceptable);
  Measure(view, 3, kAcceptable, kAcceptable);
  Measure(view, 4, kAcceptable, kGood);
  Measure(view, 5, kBad, kGood);
  const CoverageSummary coverage = SummarizeCoverage(view, ThermalOptions());
  EXPECT_DOUBLE_EQ(coverage.surface, 0.8);
  EXPECT_DOUBLE_EQ(coverage.good, 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.acceptable, 3.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.bad, 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.never_measured, 2.0 / 8.0);
}

TEST(CoverageTest, IsZeroWithoutASurface) {
  const CoverageSummary coverage = SummarizeCoverage(Row(0, 5, 0.5, 0.0), ThermalOptions());
  EXPECT_EQ(coverage.surface, 0.0);
  EXPECT_EQ(coverage.never_measured, 0.0);
  EXPECT_EQ(SummarizeCoverage(ViewMaps(), ThermalOptions()).surface, 0.0);
}

TEST(AdviceTest, FollowsFromWhatHindersMost) {
  EXPECT_EQ(AdviceFor(Row(10, 0, 1.2, 20.0)).advice, AdviceKind::kCloser);
  EXPECT_EQ(AdviceFor(Row(10, 0, 0.2, 20.0)).advice, AdviceKind::kFarther);
  EXPECT_EQ(AdviceFor(Row(10, 0, 0.5, 75.0)).advice, AdviceKind::kLessOblique);
  EXPECT_EQ(AdviceFor(Row(10, 0, 0.5, 20.0)).advice, AdviceKind::kNone);
}

TEST(AdviceTest, SurfaceThatIsMeasuredWellNeedsNothing) {
  ViewMaps view = Row(10, 0, 1.2, 20.0);
  for (int x = 0; x < 9; ++x) Measure(view, x, kGood, kAcceptable);
  EXPECT_EQ(AdviceFor(view).advice, AdviceKind::kDone);
  EXPECT_NE(AdviceFor(view).reason.find("90 %"), std::string::npos);
}

TEST(AdviceTest, TrackingComesBeforeNucBeforeMotion) {
  const ViewMaps view = Row(10, 0, 1.2, 20.0);
  ScanSituation situation{.speed_m_s = 0.5, .max_speed_m_s = 0.3};
  EXPECT_EQ(AdviceFor(view, situation).advice, AdviceKind::kSlower);
  situation.nuc_running = true;
  EXPECT_EQ(AdviceFor(view, situation).advice, AdviceKind::kHoldForNuc);
  situation.tracking_lost = true;
  EXPECT_EQ(AdviceFor(view, situation).advice, AdviceKind::kGoBack);
}

TEST(AdviceTest, EveryAdviceButNoneGivesAReason) {
  EXPECT_TRUE(AdviceFor(Row(10, 0, 0.5, 20.0)).reason.empty());
  EXPECT_NE(AdviceFor(Row(10, 0, 1.2, 20.0)).reason.find("0.90 m"), std::string::npos);
  EXPECT_FALSE(AdviceFor(Row(0, 10, 0.5, 0.0)).reason.empty());
}

}  // namespace
}  // namespace isotherm
