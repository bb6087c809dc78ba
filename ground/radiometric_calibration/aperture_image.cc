#include "ground/radiometric_calibration/aperture_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "common/base/quantile.h"

namespace isotherm {
namespace {

/// Side of a patch. The scene's influence changes over tens of pixels.
constexpr int kPatchPixels = 8;
constexpr int kMinPatchPixels = 16;
/// The black body has to show as many inside the rim.
constexpr int kMinBodyPixels = 60;
/// Others as hot as the black body may have this fraction of its pixels.
constexpr double kMaxOther = 0.02;
/// So many pixels may be dead. Of a hole that is too hot for the range there are more.
constexpr double kMaxDead = 0.001;
/// Side of the square over which levels are averaged: not the noise of one pixel.
constexpr int kLevelPixels = 5;

cv::Mat View(const Image<float>& image) {
  // OpenCV's matrices do not know const; it is only read.
  return {image.height(), image.width(), CV_32F, const_cast<float*>(image.data())};
}

std::vector<std::uint32_t> PixelsWithoutValue(const Image<float>& celsius) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t i = 0; i < celsius.size(); ++i)
    if (std::isnan(celsius.pixels()[i])) pixels.push_back(static_cast<std::uint32_t>(i));
  return pixels;
}

/// Returns the median of the pixels with a value; 0 if none has one.
float MedianOf(const Image<float>& celsius) {
  std::vector<float> values;
  std::ranges::copy_if(celsius.pixels(), std::back_inserter(values),
                       [](float c) { return !std::isnan(c); });
  return values.empty() ? 0.0F : TakeMedian(values);
}

/// Pixels of `mask` whose distance from those without is more than the rim's margin, by patches.
std::vector<PixelPatch> Patches(const cv::Mat& mask, const std::vector<std::uint32_t>& dead) {
  // An image that is all of one kind has no rim.
  cv::Mat distance(mask.size(), CV_32F, cv::Scalar(2.0 * kRimMargin_px));
  if (cv::countNonZero(mask) < static_cast<int>(mask.total()))
    cv::distanceTransform(mask, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  std::map<std::pair<int, int>, PixelPatch> by_place;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x)
      if (distance.at<float>(y, x) > static_cast<float>(kRimMargin_px) &&
          !std::ranges::binary_search(dead, static_cast<std::uint32_t>(y * mask.cols + x)))
        by_place[{y / kPatchPixels, x / kPatchPixels}].push_back(
            static_cast<std::uint32_t>(y * mask.cols + x));
  std::vector<PixelPatch> patches;
  PixelPatch rest;  // Of a small hole there may be nothing but parts of patches.
  for (auto& [place, patch] : by_place) {
    if (patch.size() >= kMinPatchPixels) {
      patches.push_back(std::move(patch));
    } else {
      rest.insert(rest.end(), patch.begin(), patch.end());
    }
  }
  if (rest.size() >= kMinPatchPixels && patches.empty()) patches.push_back(std::move(rest));
  return patches;
}

std::size_t PixelsOf(const std::vector<PixelPatch>& patches) {
  std::size_t pixels = 0;
  for (const PixelPatch& patch : patches) pixels += patch.size();
  return pixels;
}

/// The connected part of `mask` with the most pixels; `others` gets the number of the rest.
cv::Mat Largest(const cv::Mat& mask, int& others) {
  cv::Mat labels, statistics, centroids;
  const int parts = cv::connectedComponentsWithStats(mask, labels, statistics, centroids);
  int largest = 0, most = 0, all = 0;
  for (int part = 1; part < parts; ++part) {
    const int pixels = statistics.at<int>(part, cv::CC_STAT_AREA);
    all += pixels;
    if (pixels > most) {
      most = pixels;
      largest = part;
    }
  }
  others = all - most;
  return labels == largest;
}

}  // namespace

double MeanOf(const PixelPatch& patch, const Image<float>& image) {
  double sum = 0.0;
  for (const std::uint32_t pixel : patch) sum += static_cast<double>(image.pixels()[pixel]);
  return sum / static_cast<double>(patch.size());
}

double MeanOf(const std::vector<PixelPatch>& patches, const Image<float>& image) {
  double sum = 0.0;
  for (const PixelPatch& patch : patches) sum += MeanOf(patch, image);
  return sum / static_cast<double>(patches.size());
}

Result<ApertureImage> FindAperture(Image<float> celsius, double body_celsius) {
  const std::vector<std::uint32_t> dead = PixelsWithoutValue(celsius);
  if (celsius.empty() ||
      static_cast<double>(dead.size()) > kMaxDead * static_cast<double>(celsius.size())) {
    return Err(FailedPrecondition(fmt::format(
        "{} pixels have no value: is the black body within the camera's range?", dead.size())));
  }
  cv::Mat shown = View(celsius).clone();
  cv::patchNaNs(shown, static_cast<double>(MedianOf(celsius)));
  cv::Mat around;
  cv::medianBlur(shown, around, kLevelPixels);
  // A single dead pixel of the hole is none of the plate's.
  for (const std::uint32_t pixel : dead) {
    const int y = static_cast<int>(pixel) / shown.cols, x = static_cast<int>(pixel) % shown.cols;
    shown.at<float>(y, x) = around.at<float>(y, x);
  }
  cv::Mat level;
  cv::blur(shown, level, {kLevelPixels, kLevelPixels});
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(level, &low, &high);
  ApertureImage image;
  const double contrast_k = high - low;
  const double uneven_k = std::max(kMaxUneven_k, kMaxUnevenFraction * std::abs(body_celsius));
  if (contrast_k > uneven_k && contrast_k < std::max(kMinContrast_k, 2.0 * uneven_k)) {
    return Err(FailedPrecondition(fmt::format(
        "temperatures differ by {:.1f} K, too much for a black body alone and too little for one "
        "behind a plate: let it fill the image, or be {:.0f} K from the plate's temperature",
        contrast_k, std::max(kMinContrast_k, 2.0 * uneven_k))));
  }
  if (contrast_k <= uneven_k) {
    const cv::Mat all(level.size(), CV_8U, cv::Scalar(255));
    image.body = Patches(all, dead);
    image.hole_radius_px = std::sqrt(static_cast<double>(level.total()) / std::numbers::pi);
    image.celsius = std::move(celsius);
    return image;
  }
  const bool body_is_colder = body_celsius < 0.5 * (low + high);
  const cv::Mat hot = shown > 0.5 * (low + high);
  const cv::Mat inside = body_is_colder ? cv::Mat(~hot) : hot;
  int others = 0;
  const cv::Mat hole = Largest(inside, others);
  const int pixels = cv::countNonZero(hole);
  if (others > kMaxOther * pixels) {
    return Err(FailedPrecondition(fmt::format(
        "beside the largest {0} part ({1} pixels) others have {2}: nothing but the plate with one "
        "hole and the black body behind it may be seen",
        body_is_colder ? "cold" : "hot", pixels, others)));
  }
  image.hole_radius_px = std::sqrt(pixels / std::numbers::pi);
  image.body = Patches(hole, dead);
  image.plate = Patches(~inside, dead);
  if (PixelsOf(image.body) < kMinBodyPixels) {
    return Err(FailedPrecondition(fmt::format(
        "a hole of {:.0f} px radius has too few pixels that are {:.0f} px from its rim: take a "
        "larger one or go nearer",
        image.hole_radius_px, kRimMargin_px)));
  }
  if (image.plate.empty()) {
    return Err(FailedPrecondition(
        "of the plate nothing is left beside the rim of the hole: take a smaller hole, or let the "
        "black body fill the image"));
  }
  image.celsius = std::move(celsius);
  return image;
}

}  // namespace isotherm
