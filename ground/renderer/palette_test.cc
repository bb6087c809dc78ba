#include "ground/renderer/palette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ground/ground_options.pb.h"

namespace isotherm {
namespace {

struct Anchor {
  double share;
  int r, g, b;
};

// Moreland's published table of the map with 33 entries (the one plotting packages ship).
constexpr Anchor kPublished[] = {
    {0.0, 59, 76, 192},      {0.03125, 68, 90, 204},  {0.0625, 77, 104, 215},
    {0.125, 98, 130, 234},   {0.1875, 119, 154, 247}, {0.25, 141, 176, 254},
    {0.3125, 163, 194, 255}, {0.375, 184, 208, 249},  {0.4375, 204, 217, 238},
    {0.5, 221, 221, 221},    {0.5625, 236, 211, 197}, {0.625, 245, 196, 173},
    {0.6875, 247, 177, 148}, {0.75, 244, 154, 123},   {0.8125, 236, 127, 99},
    {0.875, 222, 96, 77},    {0.9375, 203, 62, 56},   {0.96875, 192, 40, 47},
    {1.0, 180, 4, 38},
};
constexpr int kRounding = 1;  // 8-bit steps: the published table was rounded after other constants.

TEST(CoolwarmTest, AgreesWithThePublishedTable) {
  for (const Anchor& anchor : kPublished) {
    const Rgb8 colour = CoolwarmColour(anchor.share);
    EXPECT_NEAR(colour.r, anchor.r, kRounding) << anchor.share;
    EXPECT_NEAR(colour.g, anchor.g, kRounding) << anchor.share;
    EXPECT_NEAR(colour.b, anchor.b, kRounding) << anchor.share;
  }
}

TEST(CoolwarmTest, HasNoJumpsBetweenNeighbouringEntries) {
  for (int i = 0; i < 1000; ++i) {
    const Rgb8 a = CoolwarmColour(i / 1000.0);
    const Rgb8 b = CoolwarmColour((i + 1) / 1000.0);
    EXPECT_LE(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 6) << i;
  }
}

TEST(ColourTableTest, EndsStandForEverythingOutside) {
  const ColourTable table{RendererOptions()};
  EXPECT_EQ(table.At(-3.0), (Rgb8{59, 76, 192}));
  EXPECT_EQ(table.At(7.0), (Rgb8{180, 4, 38}));
  EXPECT_EQ(table.At(std::numeric_limits<double>::infinity()), (Rgb8{180, 4, 38}));
  EXPECT_EQ(table.At(std::numeric_limits<double>::quiet_NaN()), (Rgb8{59, 76, 192}));
  EXPECT_EQ(table.At(0.5), (Rgb8{221, 221, 221}));
}

TEST(ColourTableTest, GreyIsLinear) {
  RendererOptions options;
  options.set_palette(GREY);
  const ColourTable table(options);
  EXPECT_EQ(table.At(0.2), (Rgb8{51, 51, 51}));
  EXPECT_EQ(table.At(1.0), (Rgb8{255, 255, 255}));
}

}  // namespace
}  // namespace isotherm
