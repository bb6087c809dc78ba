#include "ground/feedback/tried_surface.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

const Eigen::Vector3d kPoint(0.302, -0.117, 0.5);
constexpr std::uint64_t kPiece = 7;

void Look(TriedSurface& tried, int looks, bool is_well = false) {
  for (int i = 0; i < looks; ++i) {
    tried.BeginLook();
    tried.Note(kPoint, kPiece, is_well);
    tried.Note(kPoint, kPiece, is_well);
  }
}

TEST(TriedSurfaceTest, WhatIsLookedAtAgainAndAgainWithoutEffectIsInVain) {
  TriedSurface tried;
  Look(tried, 4);
  EXPECT_FALSE(tried.IsVain(kPoint)) << "it may take a moment";
  EXPECT_EQ(tried.VainArea(kPiece), 0.0);
  Look(tried, 1);
  EXPECT_TRUE(tried.IsVain(kPoint));
  EXPECT_GT(tried.VainArea(kPiece), 1e-5);
  Look(tried, 10);
  EXPECT_LT(tried.VainArea(kPiece), 1e-3) << "it counts once";
  EXPECT_EQ(tried.VainArea(kPiece + 1), 0.0);
}

TEST(TriedSurfaceTest, OnceMeasuredWellItWasNotInVain) {
  TriedSurface tried;
  Look(tried, 6);
  Look(tried, 2, true);
  EXPECT_FALSE(tried.IsVain(kPoint));
  EXPECT_EQ(tried.VainArea(kPiece), 0.0);
}

TEST(TriedSurfaceTest, AtTheBorderOfWhatIsWellTheRestIsInVainAllTheSame) {
  TriedSurface tried;
  for (int i = 0; i < 5; ++i) {
    tried.BeginLook();
    tried.Note(kPoint, kPiece, true);
    tried.Note(kPoint, kPiece, false);
    tried.Note(kPoint, kPiece, true);
  }
  EXPECT_TRUE(tried.IsVain(kPoint));
}

TEST(TriedSurfaceTest, APlaceBesideItIsAnother) {
  TriedSurface tried;
  Look(tried, 6);
  EXPECT_FALSE(tried.IsVain(kPoint + Eigen::Vector3d(0.025, 0.0, 0.0)));
  EXPECT_FALSE(tried.IsVain(kPoint - Eigen::Vector3d(0.0, 0.025, 0.0)));
}

}  // namespace
}  // namespace isotherm
