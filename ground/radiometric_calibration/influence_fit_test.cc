#include "ground/radiometric_calibration/influence_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr int kColumns = 191, kRows = 144;

/// How a camera is simulated here: the model pixel by pixel, with the whole Gaussian, its weights
/// divided by their sum over the image.
struct Camera {
  SceneInfluence influence;
  double offset_k = 0.0, gain = 1.0;  ///< Make its readings wrong.
};

Image<float> NearMeans(const Image<float>& own, double sigma) {
  const auto along = [&](int length, const auto& value, int at) {
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < length; ++i) {
      const double weight = std::exp(-0.5 * (i - at) * (i - at) / (sigma * sigma));
      sum += weight * value(i);
      weights += weight;
    }
    return static_cast<float>(sum / weights);
  };
  Image<float> rows(kColumns, kRows), means(kColumns, kRows);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      rows.At(x, y) = along(
          kColumns, [&](int i) { return static_cast<double>(own.At(i, y)); }, x);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      means.At(x, y) = along(
          kRows, [&](int i) { return static_cast<double>(rows.At(x, i)); }, y);
  return means;
}

ApertureView Look(const Camera& camera, double radius, double disc_celsius, double plate_celsius,
                  int setting = 0) {
  Image<float> own(kColumns, kRows);
  double total = 0.0;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double inside = 1.0 / (1.0 + std::exp(2.0 * (std::hypot(x - 98.0, y - 70.0) - radius)));
      const double celsius = plate_celsius + inside * (disc_celsius - plate_celsius);
      own.At(x, y) = static_cast<float>(camera.offset_k + camera.gain * celsius);
      total += static_cast<double>(own.At(x, y)) / (kColumns * kRows);
    }
  const Image<float> near = NearMeans(own, camera.influence.near_sigma_px);
  std::mt19937 engine(static_cast<unsigned>(radius));
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (std::size_t i = 0; i < own.size(); ++i) {
    float& value = own.pixels()[i];
    value +=
        static_cast<float>(camera.influence.near_fraction) * (near.pixels()[i] - value) +
        static_cast<float>(camera.influence.total_fraction) * (static_cast<float>(total) - value) +
        noise(engine);
  }
  return {FindAperture(std::move(own), disc_celsius).value(), setting};
}

std::vector<ApertureView> LookThroughHoles(const Camera& camera, double disc_celsius,
                                           int setting = 0) {
  std::vector<ApertureView> views;
  // Plates become a little warmer with time.
  double plate_celsius = 24.0;
  for (const double radius : {13.0, 20.0, 32.0, 50.0})
    views.push_back(Look(camera, radius, disc_celsius, plate_celsius += 0.4, setting));
  return views;
}

constexpr SceneInfluence kTrue{
    .near_fraction = 0.05, .near_sigma_px = 30.0, .total_fraction = 0.03};

TEST(InfluenceFitTest, FractionsAndReachAreFound) {
  const Result<InfluenceReport> found = FitInfluence(LookThroughHoles({kTrue}, 120.0));
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->influence.near_fraction, kTrue.near_fraction, 0.001);
  EXPECT_NEAR(found->influence.near_sigma_px, kTrue.near_sigma_px, 1.5);
  EXPECT_NEAR(found->influence.total_fraction, kTrue.total_fraction, 0.001);
  EXPECT_GT(found->apart_before_k, 1.5);
  EXPECT_LT(found->apart_after_k, 0.1);
  EXPECT_EQ(found->views, 4);
  EXPECT_TRUE(found->IsKnown());
  EXPECT_LT(std::abs(found->influence.near_fraction - kTrue.near_fraction),
            4.0 * found->Sigma(0) + 1e-4);
}

/// The camera need not be right otherwise.
TEST(InfluenceFitTest, WrongReadingsDoNotMatter) {
  const Camera camera{kTrue, 3.0, 0.96};
  std::vector<ApertureView> views = LookThroughHoles(camera, 120.0);
  std::ranges::move(LookThroughHoles(camera, 70.0, 1), std::back_inserter(views));
  const Result<InfluenceReport> found = FitInfluence(views);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->influence.near_fraction, kTrue.near_fraction, 0.001);
  EXPECT_NEAR(found->influence.total_fraction, kTrue.total_fraction, 0.001);
  EXPECT_LT(found->apart_after_k, 0.1);
}

TEST(InfluenceFitTest, ACameraWithoutHasNone) {
  const Result<InfluenceReport> found = FitInfluence(LookThroughHoles({SceneInfluence{}}, 120.0));
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_LT(found->influence.Total(), 0.001);
  EXPECT_FALSE(found->IsKnown());
}

TEST(InfluenceFitTest, HolesThatAreTooMuchAlikeTellNothing) {
  const auto why = [](const std::vector<ApertureView>& views) {
    const Result<InfluenceReport> found = FitInfluence(views);
    return found ? std::string() : found.error().message();
  };
  std::vector<ApertureView> views = LookThroughHoles({kTrue}, 120.0);
  views.resize(2);
  EXPECT_THAT(why(views), HasSubstr("there are 2, the largest 1.5 times"));
  views.push_back(views.back());
  EXPECT_THAT(why(views), HasSubstr("there are 2")) << "one of them twice";
  views.push_back(Look({kTrue}, 500.0, 40.0, 24.0, 1));
  EXPECT_THAT(why(views), HasSubstr("there are 2")) << "another temperature";
  // Different holes, but each at a temperature of its own.
  views = LookThroughHoles({kTrue}, 120.0);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].setting = static_cast<int>(i);
  EXPECT_THAT(why(views), HasSubstr("there are 1"));
}

TEST(InfluenceFitTest, AnInfluenceThatIsNotThereMakesHolesReadApart) {
  const std::vector<ApertureView> views = LookThroughHoles({SceneInfluence{}}, 120.0);
  EXPECT_LT(ApartWithout({}, views), 0.05);
  EXPECT_GT(ApartWithout(kTrue, views), 1.0);
}

}  // namespace
}  // namespace isotherm
