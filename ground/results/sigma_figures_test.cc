#include "ground/results/sigma_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace isotherm {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

constexpr double kRounding = 1e-9;  // Of figures around 100.

TEST(SigmaFiguresTest, WithoutPosesThereAreNone) { EXPECT_EQ(Figures({}), std::nullopt); }

TEST(SigmaFiguresTest, OnePoseIsAllThree) {
  const auto figures = Figures({{.translation_m = 0.002, .rotation_rad = 3.0 * kRadPerDeg}});
  ASSERT_TRUE(figures.has_value());
  EXPECT_THAT(figures->translation_mm, ElementsAre(2.0, 2.0, 2.0));
  EXPECT_THAT(figures->rotation_deg, ::testing::Each(DoubleNear(3.0, kRounding)));
}

TEST(SigmaFiguresTest, TranslationsAndRotationsAreRankedEachByThemselves) {
  // 0 to 100 mm in an order of no meaning (37 and 101 have no common factor), and 100 to 0 degrees.
  std::vector<PoseSigma> sigmas;
  for (int i = 0; i <= 100; ++i) {
    const int rank = i * 37 % 101;
    sigmas.push_back({.translation_m = 1e-3 * rank, .rotation_rad = (100 - rank) * kRadPerDeg});
  }
  const auto figures = Figures(sigmas);
  ASSERT_TRUE(figures.has_value());
  const auto p50_p95_max = ElementsAre(DoubleNear(50.0, kRounding), DoubleNear(95.0, kRounding),
                                       DoubleNear(100.0, kRounding));
  EXPECT_THAT(figures->translation_mm, p50_p95_max);
  EXPECT_THAT(figures->rotation_deg, p50_p95_max);
}

}  // namespace
}  // namespace isotherm
