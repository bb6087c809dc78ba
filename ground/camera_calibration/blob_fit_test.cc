#include "ground/camera_calibration/blob_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr double kBackground = 100.0, kContrast = 35.0;

Polygon Ellipse(const Eigen::Vector2d& centre, double a, double b) {
  Polygon ellipse;
  constexpr int kPoints = 64;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    ellipse.emplace_back(centre + Eigen::Vector2d(a * std::cos(angle), b * std::sin(angle)));
  }
  return ellipse;
}

/// Filled on cells of a tenth of a pixel, blurred by sums over them: shares nothing with the fit.
Image<float> Render(const Polygon& polygon, double blur_px, double noise, double slope) {
  constexpr int kSide = 48, kFine = 10;
  Image<float> fine(kSide * kFine, kSide * kFine);
  Polygon scaled;
  for (const Eigen::Vector2d& p : polygon)
    scaled.emplace_back((p + Eigen::Vector2d(0.5, 0.5)) * kFine);
  Cover(scaled, fine);
  Image<float> image(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double cx = (x + 0.5) * kFine, cy = (y + 0.5) * kFine;
      const int reach = static_cast<int>(kFine * (0.5 + 4.0 * blur_px));
      double sum = 0.0, weights = 0.0;
      for (int j = -reach; j < reach; ++j) {
        for (int i = -reach; i < reach; ++i) {
          const int fx = static_cast<int>(cx) + i, fy = static_cast<int>(cy) + j;
          if (!fine.Contains(fx, fy)) continue;
          // A pixel's box, blurred: differences of error functions.
          const auto side = [&](double d) {
            const double s = std::sqrt(2.0) * blur_px * kFine;
            return std::erf((d + 0.5 * kFine) / s) - std::erf((d - 0.5 * kFine) / s);
          };
          const double weight = side(fx + 0.5 - cx) * side(fy + 0.5 - cy);
          weights += weight;
          sum += weight * static_cast<double>(fine.At(fx, fy));
        }
      }
      const auto counter = static_cast<std::uint64_t>(y * kSide + x);
      image.At(x, y) = static_cast<float>(kBackground + slope * x + kContrast * sum / weights +
                                          noise * static_cast<double>(NormalNoise(7, counter)));
    }
  }
  return image;
}

BlobModel ModelOf(const Polygon& outline, const Eigen::Vector2d& centre, double window) {
  BlobModel model;
  model.outline = outline;
  model.window = Ellipse(centre, window, window);
  return model;
}

const Eigen::Vector2d kCentre(23.31, 24.72);

TEST(BlobFitTest, ShiftOfABlurredEllipseIsFoundToAHundredthOfAPixel) {
  const Polygon outline = Ellipse(kCentre, 11.0, 8.0);
  const Image<float> image = Render(outline, 0.7, 0.05, 0.0);
  const Eigen::Vector2d wrong(0.83, -1.21);
  const auto fit = FitBlob(image, ModelOf(Ellipse(kCentre + wrong, 11.0, 8.0), kCentre, 15.0));
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR((fit->shift_px + wrong).norm(), 0.0, 0.01);
  EXPECT_NEAR(fit->contrast, kContrast, 0.2);
  EXPECT_NEAR(fit->scale, 1.0, 0.005);
}

TEST(BlobFitTest, ABackgroundThatRisesToASideMovesNothing) {
  const Polygon outline = Ellipse(kCentre, 10.0, 10.0);
  const auto fit = FitBlob(Render(outline, 0.6, 0.05, 0.5), ModelOf(outline, kCentre, 14.0));
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->shift_px.norm(), 0.0, 0.01);
}

TEST(BlobFitTest, UncertaintyIsThatOfTheNoise) {
  const Polygon outline = Ellipse(kCentre, 9.0, 9.0);
  const double noise = 2.0;
  const auto fit = FitBlob(Render(outline, 0.7, noise, 0.0), ModelOf(outline, kCentre, 13.0));
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->noise, noise, 0.3);
  // An edge of a blurred step tells its place within noise / contrast x sqrt(2 sqrt(pi) blur) per
  // root of its length in pixels; half of the rim counts for a direction.
  const double blur = std::hypot(0.7, 0.29);
  const double length = std::numbers::pi * 9.0;
  const double expected =
      noise / kContrast * std::sqrt(2.0 * std::sqrt(std::numbers::pi) * blur / length);
  EXPECT_NEAR(std::sqrt(fit->covariance(0, 0)) / expected, 1.0, 0.35);
  EXPECT_LT(fit->shift_px.norm(), 4.0 * std::sqrt(fit->covariance.trace()));
}

TEST(BlobFitTest, AHoleThatTheBorderCutsIsFoundIfItsSizeIsKnown) {
  const Eigen::Vector2d centre(4.2, 24.0);
  const Polygon outline = Ellipse(centre, 9.0, 9.0);
  BlobModel model = ModelOf(Ellipse(centre + Eigen::Vector2d(0.6, 0.0), 9.0, 9.0), centre, 13.0);
  model.known_scale = 1.0;
  const auto fit = FitBlob(Render(outline, 0.7, 0.05, 0.0), model);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->shift_px.x(), -0.6, 0.03);
  EXPECT_NEAR(fit->shift_px.y(), 0.0, 0.03);
}

TEST(BlobFitTest, ASpotOnTheBoardDoesNotPullTheHole) {
  const Polygon outline = Ellipse(kCentre, 10.0, 10.0);
  Image<float> image = Render(outline, 0.7, 0.2, 0.0);
  for (int y = 22; y < 26; ++y)
    for (int x = 35; x < 37; ++x) image.At(x, y) += 40.0F;
  const auto fit = FitBlob(image, ModelOf(outline, kCentre, 14.0));
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->shift_px.norm(), 0.0, 0.05);
}

TEST(BlobFitTest, NothingIsFoundWhereThereIsNothing) {
  const Image<float> flat(48, 48, std::nanf(""));
  EXPECT_FALSE(FitBlob(flat, ModelOf(Ellipse(kCentre, 9.0, 9.0), kCentre, 13.0)).has_value());
  const Image<float> image(48, 48, 1.0F);
  const Eigen::Vector2d outside(200.0, 200.0);
  EXPECT_FALSE(FitBlob(image, ModelOf(Ellipse(outside, 9.0, 9.0), outside, 13.0)).has_value());
}

}  // namespace
}  // namespace isotherm
