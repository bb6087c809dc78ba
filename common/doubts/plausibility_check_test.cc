#include "common/doubts/plausibility_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// `frames` stamps, the first at `start_s`, a thirtieth of a second apart.
std::vector<CaptureTime> Stamps(int frames, double start_s) {
  std::vector<CaptureTime> times;
  for (int i = 0; i < frames; ++i)
    times.push_back(CaptureTime(FromSeconds(start_s) + i * FromSeconds(1.0 / 30.0)));
  return times;
}

TEST(PlausibilityCheckTest, AScanIsAssessedByItsStampsAndByFewOfItsFrames) {
  PlausibilityCheck check((Rig()));
  int looked_at = 0;
  for (const CaptureTime time : Stamps(1000, 100.0)) {
    if (!check.AddDepth(time)) continue;
    ++looked_at;
    check.LookAtDepth(Image<std::uint16_t>(64, 48, 900), 1000.0);
  }
  EXPECT_EQ(looked_at, 10) << "frames 1, 2, 4 ... 512";
  for (const CaptureTime time : Stamps(1000, 100.05)) {
    if (check.AddThermal(time))
      check.LookAtThermal(Image<std::uint16_t>(38, 28, 2300), kCentikelvin);
  }
  EXPECT_EQ(check.MedianDepthRaw(), 900.0);
  EXPECT_THAT(check.Find(), ElementsAre(HasSubstr("as centi-degrees Celsius they would be 23.0")));
}

TEST(PlausibilityCheckTest, TheCalibratedDelayCountsForTheOverlap) {
  Rig rig;
  rig.thermal_delay_s = -0.9;
  PlausibilityCheck check(rig);
  for (const CaptureTime time : Stamps(30, 100.0)) check.AddDepth(time);
  for (const CaptureTime time : Stamps(30, 100.9)) check.AddThermal(time);
  EXPECT_THAT(check.Find(), IsEmpty());
}

}  // namespace
}  // namespace isotherm
