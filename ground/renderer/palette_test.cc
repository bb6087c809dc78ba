#include "ground/renderer/palette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

struct Anchor {
  double fraction;
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
    const Rgb8 colour = CoolwarmColour(anchor.fraction);
    EXPECT_NEAR(colour.r, anchor.r, kRounding) << anchor.fraction;
    EXPECT_NEAR(colour.g, anchor.g, kRounding) << anchor.fraction;
    EXPECT_NEAR(colour.b, anchor.b, kRounding) << anchor.fraction;
  }
}

// Entries of matplotlib's table (256 colours) between those that ours has: fraction = entry / 255.
constexpr Anchor kPublishedInferno[] = {
    {7 / 255.0, 3, 2, 16},       {37 / 255.0, 41, 11, 85},     {52 / 255.0, 67, 10, 104},
    {82 / 255.0, 116, 26, 110},  {128 / 255.0, 188, 55, 84},   {142 / 255.0, 207, 68, 70},
    {172 / 255.0, 239, 108, 36}, {192 / 255.0, 249, 142, 9},   {206 / 255.0, 252, 168, 13},
    {222 / 255.0, 249, 199, 47}, {243 / 255.0, 241, 239, 117}, {251 / 255.0, 246, 250, 150},
};
constexpr int kInterpolation = 3;  // 8-bit steps, as promised beside InfernoColour.

TEST(InfernoTest, AgreesWithThePublishedTableBetweenItsOwnEntries) {
  for (const Anchor& anchor : kPublishedInferno) {
    const Rgb8 colour = InfernoColour(anchor.fraction);
    EXPECT_NEAR(colour.r, anchor.r, kInterpolation) << anchor.fraction;
    EXPECT_NEAR(colour.g, anchor.g, kInterpolation) << anchor.fraction;
    EXPECT_NEAR(colour.b, anchor.b, kInterpolation) << anchor.fraction;
  }
  EXPECT_EQ(InfernoColour(0.0), (Rgb8{0, 0, 4}));
  EXPECT_EQ(InfernoColour(1.0), (Rgb8{252, 255, 164}));
}

TEST(IronTest, GoesFromBlackOverBlueVioletAndYellowToWhite) {
  EXPECT_EQ(IronColour(0.0), (Rgb8{0, 0, 0}));
  EXPECT_EQ(IronColour(0.25), (Rgb8{0, 0, 255}));
  // Red is full from 0.57 on; green 1.2 - 0.84, blue 1.84 - 1.2.
  EXPECT_EQ(IronColour(0.6), (Rgb8{255, 92, 163}));
  EXPECT_EQ(IronColour(0.92), (Rgb8{255, 255, 0}));
  EXPECT_EQ(IronColour(1.0), (Rgb8{255, 255, 255}));
}

TEST(RainbowTest, GoesFromBlueOverGreenToRed) {
  EXPECT_EQ(RainbowColour(0.0), (Rgb8{128, 0, 255}));
  EXPECT_EQ(RainbowColour(0.25), (Rgb8{0, 180, 236}));   // sin 45 deg, cos 22.5 deg.
  EXPECT_EQ(RainbowColour(0.5), (Rgb8{128, 255, 180}));  // cos 45 deg.
  EXPECT_EQ(RainbowColour(1.0), (Rgb8{255, 0, 0}));
}

/// Luma of ITU-R BT.601.
double Brightness(Rgb8 colour) { return 0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b; }

TEST(PaletteTest, BrightnessRisesWhereItIsSaidTo) {
  for (const Palette palette : {GREY, IRON, INFERNO}) {
    for (int i = 0; i < 100; ++i) {
      const double before = Brightness(PaletteColour(palette, i / 100.0));
      const double after = Brightness(PaletteColour(palette, (i + 1) / 100.0));
      // Iron's blue falls as its red rises: by up to half a step where channels are rounded.
      EXPECT_GT(after, before - 0.5) << PaletteName(palette) << " " << i;
    }
  }
}

TEST(PaletteTest, HasNoJumpsBetweenNeighbouringColours) {
  constexpr int kMaxStep = 13;  // Of three channels; iron's blue rises by 12.5 per permille.
  for (const Palette palette : {COOLWARM, GREY, IRON, RAINBOW, INFERNO}) {
    for (int i = 0; i < 1000; ++i) {
      const Rgb8 a = PaletteColour(palette, i / 1000.0);
      const Rgb8 b = PaletteColour(palette, (i + 1) / 1000.0);
      EXPECT_LE(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), kMaxStep)
          << PaletteName(palette) << " " << i;
    }
  }
}

TEST(PaletteTest, IsFoundByItsNameInAnyCase) {
  for (const Palette palette : {COOLWARM, GREY, IRON, RAINBOW, INFERNO}) {
    EXPECT_EQ(PaletteFromName(PaletteName(palette)), palette);
  }
  EXPECT_EQ(PaletteFromName("Inferno"), INFERNO);
  EXPECT_EQ(PaletteName(COOLWARM), "coolwarm");
  EXPECT_FALSE(PaletteFromName("jet"));
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
