#include "common/simulation/depth_defects.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/frame/frame.h"

namespace isotherm {
namespace {

constexpr std::uint16_t kNear = 800;
constexpr std::uint16_t kFar = 1200;

/// A step in the middle of an image of 600 x 400.
Image<std::uint16_t> Step() {
  Image<std::uint16_t> image(600, 400, kNear);
  for (int y = 0; y < 400; ++y) std::fill(image.Row(y).begin() + 300, image.Row(y).end(), kFar);
  return image;
}

double EmptyFraction(const Image<std::uint16_t>& image) {
  return static_cast<double>(std::ranges::count(image.pixels(), kNoDepth)) /
         static_cast<double>(image.size());
}

TEST(DepthDefectsTest, HolesAreAsManyAsIsSaidAndTheRestIsAsItWas) {
  for (const auto& [defect, fraction] :
       {std::pair(DepthDefect::kNone, 0.0), std::pair(DepthDefect::kGrid, 0.64),
        std::pair(DepthDefect::kCoarseGrid, 0.64), std::pair(DepthDefect::kRandom, 0.60),
        std::pair(DepthDefect::kRows, 0.5), std::pair(DepthDefect::kColumns, 0.5)}) {
    Image<std::uint16_t> image = Step();
    AddDefect(defect, 7, image);
    EXPECT_NEAR(EmptyFraction(image), fraction, 0.003) << static_cast<int>(defect);
    const Image<std::uint16_t> before = Step();
    for (std::size_t i = 0; i < image.size(); ++i)
      ASSERT_TRUE(image.data()[i] == kNoDepth || image.data()[i] == before.data()[i]);
  }
}

TEST(DepthDefectsTest, EveryThirdRowAndColumnOfAGridIsEmpty) {
  Image<std::uint16_t> image = Step();
  AddDefect(DepthDefect::kGrid, 7, image);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (x % 3 == 2 || y % 3 == 2) {
        ASSERT_EQ(image.At(x, y), kNoDepth);
      }
    }
  }
}

TEST(DepthDefectsTest, FlyingPixelsLieBetweenTheSurfacesAtEdgesOnly) {
  Image<std::uint16_t> image = Step();
  AddDefect(DepthDefect::kFlyingPixels, 7, image);
  int flying = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::uint16_t surface = x < 300 ? kNear : kFar;
      ASSERT_TRUE(image.At(x, y) >= kNear && image.At(x, y) <= kFar);
      if (x != 299 && x != 300) {
        ASSERT_EQ(image.At(x, y), surface) << x << ", " << y;
      }
      flying += image.At(x, y) != surface ? 1 : 0;
    }
  }
  EXPECT_NEAR(flying, 0.3 * 800, 50);
}

TEST(DepthDefectsTest, TheSameStreamGivesTheSameHoles) {
  Image<std::uint16_t> first = Step(), again = Step(), other = Step();
  AddDefect(DepthDefect::kRandom, 7, first);
  AddDefect(DepthDefect::kRandom, 7, again);
  AddDefect(DepthDefect::kRandom, 8, other);
  EXPECT_TRUE(std::ranges::equal(first.pixels(), again.pixels()));
  EXPECT_FALSE(std::ranges::equal(first.pixels(), other.pixels()));
}

}  // namespace
}  // namespace isotherm
