#include "ground/thermal/scene_influence_corrector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace isotherm {
namespace {

constexpr int kWidth = 382, kHeight = 288;
// What the thesis measured of a small disc of 120 °C in front of 24 °C: 7 K too little (fig. 5.8).
constexpr SceneInfluence kPi450{
    .near_fraction = 0.0387, .near_sigma_px = 40.0, .total_fraction = 0.0387};

/// A disc in the middle; a tenth of the image, at the right, has no value.
cv::Mat Disc(double radius_px, double inside_celsius, double outside_celsius) {
  cv::Mat celsius(kHeight, kWidth, CV_64F, cv::Scalar(outside_celsius));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (std::hypot(x - kWidth / 2, y - kHeight / 2) <= radius_px)
        celsius.at<double>(y, x) = inside_celsius;
    }
  }
  return celsius;
}

cv::Mat HasValue(int first_missing_column) {
  cv::Mat mask(kHeight, kWidth, CV_64F, cv::Scalar(1.0));
  mask.colRange(first_missing_column, kWidth).setTo(0.0);
  return mask;
}

/// The equation as it stands, by OpenCV, at full resolution.
cv::Mat WithInfluence(const cv::Mat& own, const cv::Mat& mask, const SceneInfluence& influence) {
  const auto blurred = [&](const cv::Mat& image) {
    cv::Mat out;
    cv::GaussianBlur(image, out, cv::Size(0, 0), influence.near_sigma_px, 0.0, cv::BORDER_CONSTANT);
    return out;
  };
  const cv::Mat near = blurred(own.mul(mask)) / blurred(mask);
  const double total = own.dot(mask) / cv::sum(mask)[0];
  return own * (1.0 - influence.near_fraction - influence.total_fraction) +
         influence.near_fraction * near + influence.total_fraction * total;
}

Image<float> ToImage(const cv::Mat& celsius, const cv::Mat& mask) {
  Image<float> image(kWidth, kHeight, NAN);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (mask.at<double>(y, x) > 0.0)
        image.At(x, y) = static_cast<float>(celsius.at<double>(y, x));
    }
  }
  return image;
}

/// The largest difference where there are values, kelvin.
double LargestError(const Image<float>& celsius, const cv::Mat& own, const cv::Mat& mask) {
  double largest = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (mask.at<double>(y, x) == 0.0) {
        EXPECT_TRUE(std::isnan(celsius.At(x, y)));
        continue;
      }
      largest =
          std::max(largest, std::abs(static_cast<double>(celsius.At(x, y)) - own.at<double>(y, x)));
    }
  }
  return largest;
}

TEST(SceneInfluenceCorrectorTest, OwnTemperaturesComeBack) {
  constexpr double kTolerance_k = 0.1;
  for (const int first_missing_column : {kWidth, 340}) {
    const cv::Mat mask = HasValue(first_missing_column);
    for (const double radius_px : {10.0, 40.0, 120.0}) {
      const cv::Mat own = Disc(radius_px, 120.0, 24.0);
      Image<float> image = ToImage(WithInfluence(own, mask, kPi450), mask);
      const double before_k = LargestError(image, own, mask);
      SceneInfluenceCorrector(kPi450, kWidth, kHeight).Correct(image);
      const double after_k = LargestError(image, own, mask);
      std::printf("disc of %.0f px: %.2f K off, corrected %.3f K\n", radius_px, before_k, after_k);
      EXPECT_GT(before_k, 3.0);
      EXPECT_LT(after_k, kTolerance_k);
    }
  }
}

TEST(SceneInfluenceCorrectorTest, TheLargestInfluenceThatIsAllowedIsTakenOutToo) {
  const cv::Mat mask = HasValue(kWidth);
  const cv::Mat own = Disc(40.0, 120.0, 24.0);
  for (const auto& [influence, tolerance_k] :
       {std::pair(SceneInfluence{.near_fraction = SceneInfluence::kMaxFraction,
       .near_sigma_px = 40.0,
       .total_fraction = SceneInfluence::kMaxFraction},
                  0.3),
        // Means of so few pixels are not smooth: a cell is as wide as they reach.
        std::pair(SceneInfluence{.near_fraction = 0.05,
        .near_sigma_px = SceneInfluence::kMinSigma_px,
        .total_fraction = 0.0},
                  0.4)}) {
    Image<float> image = ToImage(WithInfluence(own, mask, influence), mask);
    const double before_k = LargestError(image, own, mask);
    SceneInfluenceCorrector(influence, kWidth, kHeight).Correct(image);
    const double after_k = LargestError(image, own, mask);
    std::printf("%.2f K off, corrected %.3f K\n", before_k, after_k);
    EXPECT_LT(after_k, tolerance_k);
    EXPECT_GT(before_k, 3.0 * tolerance_k);
  }
}

TEST(SceneInfluenceCorrectorTest, AnImageOfLessThanACellIsCorrectedByItsMean) {
  Image<float> image(5, 3, 24.0F);
  image.At(2, 1) = 39.0F;  // Mean 25 °C.
  SceneInfluenceCorrector({.near_fraction = 0.0, .near_sigma_px = 40.0, .total_fraction = 0.2}, 5,
                          3)
      .Correct(image);
  EXPECT_NEAR(image.At(2, 1), 39.0 + 0.2 / 0.8 * 14.0, 1e-3);
  EXPECT_NEAR(image.At(0, 0), 24.0 - 0.2 / 0.8 * 1.0, 1e-3);
}

TEST(SceneInfluenceCorrectorTest, WithoutInfluenceNothingChanges) {
  const cv::Mat mask = HasValue(kWidth);
  const Image<float> measured = ToImage(Disc(40.0, 120.0, 24.0), mask);
  Image<float> image = measured;
  SceneInfluenceCorrector({}, kWidth, kHeight).Correct(image);
  EXPECT_EQ(image, measured);
}

TEST(SceneInfluenceCorrectorTest, AnImageWithoutValuesStaysSo) {
  Image<float> image(kWidth, kHeight, NAN);
  SceneInfluenceCorrector(kPi450, kWidth, kHeight).Correct(image);
  for (const float celsius : image.pixels()) ASSERT_TRUE(std::isnan(celsius));
}

}  // namespace
}  // namespace isotherm
