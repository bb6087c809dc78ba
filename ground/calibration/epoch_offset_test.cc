#include "ground/calibration/epoch_offset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr double kNoise_k = 0.05;

/// Places on a square of 0.6 m that differ by `kelvin` and by noise.
std::vector<PlaceDifference> Places(std::uint8_t before, std::uint8_t after, double kelvin) {
  std::vector<PlaceDifference> places;
  const std::uint64_t stream = NoiseStream(7, before, after);
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column)
      places.push_back({before,
                        after,
                        {0.01 * column + 0.005, 0.01 * row + 0.005, 0.55},
                        kelvin + kNoise_k * NormalNoise(stream, places.size())});
  return places;
}

TEST(EpochOffsetTest, TheOffsetOfAllPlacesIsFound) {
  const auto offset = LargestEpochOffset(Places(0, 1, 1.3));
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->kelvin, 1.3, 0.01);
  EXPECT_LT(offset->sigma_k, 0.01);
}

TEST(EpochOffsetTest, APartThatGotWarmerDoesNotMakeAnOffset) {
  std::vector<PlaceDifference> places = Places(0, 1, 0.0);
  for (PlaceDifference& place : places) {
    if (place.p_world.x() < 0.2) place.kelvin += 30.0;
  }
  EXPECT_NEAR(LargestEpochOffset(places)->kelvin, 0.0, 0.05);
}

TEST(EpochOffsetTest, WherePartsOfTheSurfaceSayDifferentThingsTheOffsetIsUncertain) {
  std::vector<PlaceDifference> places = Places(0, 1, 0.0);
  for (PlaceDifference& place : places) place.kelvin += 4.0 * place.p_world.y();
  const auto offset = LargestEpochOffset(places);
  // Six rows of six parts, 0.4 K from one to the next: the median deviation is 0.6 to 0.8 K.
  EXPECT_GT(offset->sigma_k, 0.18);
  EXPECT_LT(offset->sigma_k, 0.25);
}

TEST(EpochOffsetTest, TheLargestOfSeveralNucsCounts) {
  std::vector<PlaceDifference> places = Places(0, 1, 0.2);
  for (const PlaceDifference& place : Places(1, 2, -0.9)) places.push_back(place);
  EXPECT_NEAR(LargestEpochOffset(places)->kelvin, -0.9, 0.01);
}

TEST(EpochOffsetTest, AFewPlacesSayNothing) {
  EXPECT_FALSE(LargestEpochOffset({}));
  std::vector<PlaceDifference> places = Places(0, 1, 1.0);
  std::erase_if(places, [](const PlaceDifference& place) {
    return place.p_world.y() > 0.1 || place.p_world.x() > 0.4;
  });
  EXPECT_FALSE(LargestEpochOffset(places)) << "four parts";
}

}  // namespace
}  // namespace isotherm
