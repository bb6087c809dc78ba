#include "ground/service/conclusion.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

constexpr double kDone = 0.9;

TEST(ConclusionTest, WhatIsStillToBeDoneIsSaidInParts) {
  const SurfaceAreas areas{.good_m2 = 0.5, .acceptable_m2 = 0.1, .bad_m2 = 0.1, .never_m2 = 0.3};
  EXPECT_EQ(ConclusionText({}, areas, kDone, "scan.mcap"),
            "next     measured well: 50 % of 1.00 m2, 90 % are asked for: go on with the 30 % that "
            "were never measured and the 10 % from a bad distance or angle\n");
}

TEST(ConclusionTest, AScanThatIsDoneSaysSo) {
  EXPECT_EQ(ConclusionText({}, {.good_m2 = 1.9, .bad_m2 = 0.1}, kDone, "scan.mcap"),
            "next     measured well: 95 % of 2.00 m2, as was asked for: the scan is done\n");
}

TEST(ConclusionTest, F48WhatWasLeftOutIsSaidWithTheCommandThatUsesIt) {
  const BehindCounts behind{.now = false, .thermal_frames = 764, .depth_frames = 0};
  const std::string words = "behind   764 thermal frames were left out to keep up: isotherm ";
  EXPECT_EQ(ConclusionText(behind, {}, kDone, "out/scan.mcap"),
            words + "reconstruct out/scan.mcap -o FOLDER uses them\n");
  EXPECT_EQ(ConclusionText(behind, {}, kDone, ""),
            words + "reconstruct RECORDING -o FOLDER uses them\n");
}

TEST(ConclusionTest, OfNoSurfaceThereIsNothingToSay) {
  EXPECT_EQ(ConclusionText({}, {}, kDone, "scan.mcap"), "");
}

}  // namespace
}  // namespace isotherm
