#include "ground/calibration/thermal_selection.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace isotherm {
namespace {

/// The number takes the place of the time.
StampedThermal Frame(std::uint64_t number) {
  StampedThermal frame;
  frame.time = CaptureTime(Nanoseconds(number));
  return frame;
}

std::uint64_t NumberOf(const StampedThermal& frame) {
  return static_cast<std::uint64_t>(frame.time.time_since_epoch().count());
}

TEST(ThermalSelectionTest, AShortScanIsKeptWhole) {
  ThermalSelection selection(10);
  for (std::uint64_t i = 0; i < 10; ++i) selection.Add(Frame(i), 1.0);
  ASSERT_EQ(selection.frames().size(), 10U);
  for (std::uint64_t i = 0; i < 10; ++i) EXPECT_EQ(NumberOf(selection.frames()[i]), i);
}

TEST(ThermalSelectionTest, ALongScanIsCoveredEvenlyWithABoundedNumber) {
  for (const std::size_t most : {10U, 11U}) {
    for (const std::uint64_t length : {11U, 25U, 100U, 1000U, 7777U}) {
      ThermalSelection selection(most);
      for (std::uint64_t i = 0; i < length; ++i) selection.Add(Frame(i), 1.0);
      const std::vector<StampedThermal> frames = selection.frames();
      ASSERT_LE(frames.size(), most);
      ASSERT_GE(frames.size(), most / 2);
      // Of equally fast ones the first stays, so gaps are powers of two, all the same.
      const std::uint64_t gap = NumberOf(frames[1]) - NumberOf(frames[0]);
      EXPECT_EQ(NumberOf(frames.front()), 0U);
      for (std::size_t i = 1; i < frames.size(); ++i) {
        EXPECT_EQ(NumberOf(frames[i]), i * gap) << most << " of " << length;
      }
      EXPECT_LE(length - NumberOf(frames.back()), 2 * gap);
    }
  }
}

TEST(ThermalSelectionTest, OfNeighboursTheFasterIsKept) {
  ThermalSelection selection(8);
  constexpr std::uint64_t kFrames = 64;
  // Every sixteenth moves, faster each time.
  for (std::uint64_t i = 0; i < kFrames; ++i)
    selection.Add(Frame(i), i % 16 == 5 ? static_cast<double>(i) : 0.0);
  std::size_t moving = 0;
  for (const StampedThermal& frame : selection.frames())
    moving += NumberOf(frame) % 16 == 5 ? 1 : 0;
  EXPECT_EQ(moving, kFrames / 16);
}

}  // namespace
}  // namespace isotherm
