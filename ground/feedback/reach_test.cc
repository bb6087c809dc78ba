#include "ground/feedback/reach.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

constexpr std::uint64_t kCell = 7;

LackingSurface Surface(double area_m2) {
  return {.cell = kCell, .position_map = {}, .normal_map = {}, .area_m2 = area_m2};
}

TEST(ReachTest, IsOutOfReachOnceAllOfItsViewsGainNothing) {
  Reach reach;
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.01));
  reach.Begin(Surface(0.01), 3);
  for (int view = 0; view < 3; ++view) {
    EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.01)) << "after " << view << " of 3 views";
    reach.Note(kCell, false);
  }
  EXPECT_TRUE(reach.IsOutOfReach(kCell, 0.01));
  EXPECT_FALSE(reach.IsOutOfReach(kCell + 1, 0.01)) << "another piece";
}

TEST(ReachTest, OneViewThatGainsIsEnough) {
  Reach reach;
  reach.Begin(Surface(0.01), 3);
  for (const bool gains : {false, true, false}) reach.Note(kCell, gains);
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.01));
}

TEST(ReachTest, APieceThatGrowsIsTriedAgain) {
  Reach reach;
  reach.Begin(Surface(0.01), 1);
  reach.Note(kCell, false);
  EXPECT_TRUE(reach.IsOutOfReach(kCell, 0.012));
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.02));
  reach.Begin(Surface(0.02), 1);
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.02)) << "its view is yet to be tried";
  reach.Note(kCell, true);
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.02));
}

TEST(ReachTest, ViewsThatWereNotAnnouncedAreNobodys) {
  Reach reach;
  reach.Note(kCell, false);
  EXPECT_FALSE(reach.IsOutOfReach(kCell, 0.0));
}

}  // namespace
}  // namespace isotherm
