#include "ground/camera_calibration/target_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "ground/camera_calibration/grid_growth.h"

namespace isotherm {
namespace {

using Pattern = CalibrationTarget::Pattern;
using Contrast = CalibrationTarget::Contrast;

/// The image as 8-bit grey between two of its quantiles, NaN as the lower one, enlarged.
cv::Mat ToGrey(const Image<float>& image, double low_quantile, double high_quantile, int zoom) {
  std::vector<float> values;
  for (const float value : image.pixels())
    if (std::isfinite(value)) values.push_back(value);
  cv::Mat grey = cv::Mat::zeros(image.height(), image.width(), CV_8U);
  if (values.empty()) return grey;
  const auto quantile = [&](double q) {
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
  };
  const float low = quantile(low_quantile), high = quantile(high_quantile);
  const float scale = high > low ? 255.0F / (high - low) : 0.0F;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const float value = image.At(x, y);
      if (!std::isfinite(value)) continue;
      grey.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::clamp((value - low) * scale, 0.0F, 255.0F));
    }
  }
  if (zoom > 1) cv::resize(grey, grey, {}, zoom, zoom, cv::INTER_CUBIC);
  return grey;
}

cv::Ptr<cv::FeatureDetector> BlobDetector(bool bright, const cv::Size& size, int zoom) {
  cv::SimpleBlobDetector::Params params;
  const double area = static_cast<double>(size.width) * size.height;
  params.filterByColor = true;
  params.blobColor = bright ? 255 : 0;
  params.filterByArea = true;
  // Of holes five pixels wide.
  params.minArea = static_cast<float>(20.0 * zoom * zoom);
  params.maxArea = static_cast<float>(0.05 * area);
  params.filterByCircularity = false;
  params.filterByConvexity = true;
  params.minConvexity = 0.85F;
  params.filterByInertia = true;
  params.minInertiaRatio = 0.1F;
  params.minDistBetweenBlobs = 3.0F;
  params.thresholdStep = 8.0F;
  params.minThreshold = 16.0F;
  params.maxThreshold = 240.0F;
  params.minRepeatability = 2;
  return cv::SimpleBlobDetector::create(params);
}

std::vector<Eigen::Vector2d> ToEigen(const std::vector<cv::Point2f>& points, int zoom) {
  std::vector<Eigen::Vector2d> result;
  for (const cv::Point2f& p : points) {
    // Pixel centres are at integers in both images.
    result.emplace_back((p.x + 0.5) / zoom - 0.5, (p.y + 0.5) / zoom - 0.5);
  }
  return result;
}

/// Holds what a search for holes found.
struct HoleSearch {
  std::optional<std::vector<Eigen::Vector2d>> features;
  std::optional<GrownGrid> grid;  ///< The largest that is there, of whatever size.
};

/// OpenCV's own search, then ours, which also says what else is there.
HoleSearch FindHoles(const Image<float>& image, const CalibrationTarget& target, bool bright) {
  const int symmetry = target.pattern == Pattern::kAsymmetricCircles ? cv::CALIB_CB_ASYMMETRIC_GRID
                                                                     : cv::CALIB_CB_SYMMETRIC_GRID;
  // Small images are enlarged: the detector counts whole pixels.
  // Squares of a board in a thermal image are few pixels wide; OpenCV's finder needs some ten.
  constexpr int kSmallWidth = 500;
  const int zoom = image.width() <= kSmallWidth ? 2 : 1;
  const cv::Size size(target.columns, target.rows);
  HoleSearch search;
  // What is very bright or dark beside the target must not take up the range: several stretches.
  for (const auto& [low, high] :
       {std::pair(0.01, 0.99), std::pair(0.0, 1.0), std::pair(0.1, 0.9)}) {
    cv::Mat grey = ToGrey(image, low, high, zoom);
    // Noise makes blobs of its own.
    constexpr double kBlur_px = 0.8;
    cv::GaussianBlur(grey, grey, {}, kBlur_px * zoom);
    const auto blobs = BlobDetector(bright, grey.size(), zoom);
    std::vector<cv::KeyPoint> keypoints;
    blobs->detect(grey, keypoints);
    std::vector<cv::Point2f> places;
    for (const cv::KeyPoint& keypoint : keypoints) places.push_back(keypoint.pt);
    std::optional<GrownGrid> grid = GrowGrid(ToEigen(places, zoom), target);
    const bool whole = grid && grid->columns == target.columns && grid->rows == target.rows;
    const auto cells = [](const GrownGrid& g) { return g.columns * g.rows; };
    if (grid && (!search.grid || whole || cells(*grid) > cells(*search.grid)))
      search.grid = std::move(grid);
    if (search.grid && !search.grid->features.empty()) {
      search.features = search.grid->features;
      return search;
    }
    std::vector<cv::Point2f> centres;
    const bool larger =
        search.grid && search.grid->IsDense() && cells(*search.grid) > target.columns * target.rows;
    const bool mirrored = search.grid && search.grid->mirrored;
    if (!larger && !mirrored && cv::findCirclesGrid(grey, size, centres, symmetry, blobs)) {
      search.features = ToEigen(centres, zoom);
      return search;
    }
  }
  return search;
}

std::optional<std::vector<Eigen::Vector2d>> FindCorners(const Image<float>& image,
                                                        const CalibrationTarget& target) {
  constexpr int kSmallWidth = 500;
  const int zoom = image.width() <= kSmallWidth ? 2 : 1;
  for (const auto& [low, high] : {std::pair(0.01, 0.99), std::pair(0.0, 1.0)}) {
    const cv::Mat grey = ToGrey(image, low, high, zoom);
    std::vector<cv::Point2f> corners;
    if (cv::findChessboardCorners(grey, {target.columns, target.rows}, corners,
                                  cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE)) {
      return ToEigen(corners, zoom);
    }
  }
  return std::nullopt;
}

/// Brings the numbering to that of the board's front: along a row, then down the rows, clockwise in
/// the image. A target that looks the same turned by 180 degrees is taken upright.
Status Orient(const CalibrationTarget& target, std::vector<Eigen::Vector2d>& features) {
  const int last = target.features() - 1;
  const auto turned_clockwise = [&] {
    const Eigen::Vector2d right =
        features[static_cast<std::size_t>(target.columns - 1)] - features.front();
    const Eigen::Vector2d down =
        features[static_cast<std::size_t>(last - target.columns + 1)] - features.front();
    return right.x() * down.y() - right.y() * down.x() > 0.0;
  };
  if (!turned_clockwise()) {
    std::vector<Eigen::Vector2d> mirrored(features.size());
    for (int i = 0; i <= last; ++i) {
      const std::optional<int> other = target.Mirrored(i);
      if (!other) {
        return FailedPrecondition(
            "the image is mirrored: turn the mirroring of the camera or its driver off");
      }
      mirrored[static_cast<std::size_t>(*other)] = features[static_cast<std::size_t>(i)];
    }
    features = mirrored;
  }
  const Eigen::Vector2d across = features[static_cast<std::size_t>(last)] - features.front();
  if (target.IsAmbiguous() && across.x() + across.y() < 0.0)
    std::reverse(features.begin(), features.end());
  return OkStatus();
}

/// Where the features would be if the lens had no distortion: how far they are off tells whether
/// they were matched right.
double HomographyMisfit(const CalibrationTarget& target,
                        const std::vector<Eigen::Vector2d>& features) {
  std::vector<cv::Point2d> board, pixels;
  for (int i = 0; i < target.features(); ++i) {
    const Eigen::Vector2d xy = target.FeaturePosition(i) / target.square_m;
    board.emplace_back(xy.x(), xy.y());
    pixels.emplace_back(features[static_cast<std::size_t>(i)].x(),
                        features[static_cast<std::size_t>(i)].y());
  }
  const cv::Mat homography = cv::findHomography(board, pixels, 0);
  if (homography.empty()) return std::numeric_limits<double>::infinity();
  std::vector<cv::Point2d> mapped;
  cv::perspectiveTransform(board, mapped, homography);
  double worst = 0.0, spacing = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    worst = std::max(worst, std::hypot(mapped[i].x - pixels[i].x, mapped[i].y - pixels[i].y));
    if (i > 0)
      spacing = std::min(spacing,
                         std::hypot(pixels[i].x - pixels[i - 1].x, pixels[i].y - pixels[i - 1].y));
  }
  return worst / spacing;
}

/// A camera that shows the same largest value all over the board has lost what is brighter.
Status CheckSaturation(const Image<float>& image, const std::vector<Eigen::Vector2d>& features) {
  Eigen::Vector2d low = features.front(), high = features.front();
  for (const Eigen::Vector2d& p : features) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<float> values;
  for (int y = static_cast<int>(low.y()); y <= static_cast<int>(high.y()); ++y) {
    for (int x = static_cast<int>(low.x()); x <= static_cast<int>(high.x()); ++x)
      if (image.Contains(x, y) && std::isfinite(image.At(x, y))) values.push_back(image.At(x, y));
  }
  if (values.empty()) return OkStatus();
  const float largest = *std::max_element(values.begin(), values.end());
  if (largest <= 1.0F) return OkStatus();  // Fractions (BoardImage): 1 is no end of a range.
  const auto at_largest = std::count(values.begin(), values.end(), largest);
  // A sound image has few pixels at its largest value; where a fifth has it, the range cut it off.
  constexpr double kMaxPart = 0.2;
  if (static_cast<double>(at_largest) <= kMaxPart * static_cast<double>(values.size()))
    return OkStatus();
  return FailedPrecondition(
      fmt::format("the image is saturated ({:.0f} % of the target has its largest value): expose "
                  "less, or choose "
                  "a wider range",
                  100.0 * static_cast<double>(at_largest) / static_cast<double>(values.size())));
}

Status CheckValues(const Image<float>& image) {
  std::size_t bad = 0;
  for (const float value : image.pixels()) bad += std::isfinite(value) ? 0 : 1;
  // Half an image may still show a target; less is a wrong range rather than a few dead pixels.
  constexpr double kMaxBad = 0.5;
  if (static_cast<double>(bad) > kMaxBad * static_cast<double>(image.size())) {
    return FailedPrecondition(fmt::format(
        "{} of {} pixels have no value: take images in the camera's range", bad, image.size()));
  }
  return OkStatus();
}

/// Why no target was found, as far as what was found instead tells.
Status NotFoundBecause(const CalibrationTarget& target, const std::optional<GrownGrid>& other) {
  if (other && other->mirrored) {
    return FailedPrecondition(
        "the image is mirrored: turn the mirroring of the camera or its driver off");
  }
  // Fewer points in rows and columns are met by chance.
  constexpr int kManyPoints = 12;
  if (other && other->IsDense() && other->points >= kManyPoints &&
      (other->columns != target.columns || other->rows != target.rows)) {
    return NotFound(fmt::format(
        "found {} x {}, expected {} x {}: describe the target as it is, and show all of it",
        other->columns, other->rows, target.columns, target.rows));
  }
  return NotFound(fmt::format(
      "the {} x {} features were not found: the whole target must be in the image, sharp and with "
      "contrast",
      target.columns, target.rows));
}

}  // namespace

Result<DetectedTarget> DetectTarget(const Image<float>& image, const CalibrationTarget& target) {
  if (Status status = CheckValues(image); !status.ok()) return Err(status);
  DetectedTarget detected;
  std::optional<std::vector<Eigen::Vector2d>> found;
  std::optional<GrownGrid> other;
  if (target.pattern == Pattern::kChessboard) {
    found = FindCorners(image, target);
  } else {
    for (const bool bright : {true, false}) {
      if (found || target.contrast == (bright ? Contrast::kDark : Contrast::kBright)) continue;
      HoleSearch search = FindHoles(image, target, bright);
      found = std::move(search.features);
      if (search.grid &&
          (!other || search.grid->columns * search.grid->rows > other->columns * other->rows))
        other = std::move(search.grid);
      detected.holes_bright = bright;
    }
  }
  if (!found) return Err(NotFoundBecause(target, other));
  detected.features = std::move(*found);
  if (Status status = Orient(target, detected.features); !status.ok()) return Err(status);
  if (Status status = CheckSaturation(image, detected.features); !status.ok()) return Err(status);
  // Half of the distance between neighbours would be a wrong neighbour; strong lenses bend rows by
  // a fifth of it.
  constexpr double kMaxMisfit = 0.45;
  if (HomographyMisfit(target, detected.features) > kMaxMisfit) {
    return Err(FailedPrecondition(
        "what was found is no flat grid: take the target from the front, without reflections"));
  }
  return detected;
}

std::optional<double> FeatureScatter(const std::vector<Image<float>>& frames,
                                     const CalibrationTarget& target) {
  std::vector<std::vector<Eigen::Vector2d>> found;
  for (const Image<float>& frame : frames) {
    Result<DetectedTarget> detected = DetectTarget(frame, target);
    if (detected) found.push_back(std::move(detected->features));
  }
  constexpr std::size_t kMinFrames = 3;
  if (found.size() < kMinFrames) return std::nullopt;
  const auto count = static_cast<double>(found.size());
  double largest = 0.0;
  for (std::size_t feature = 0; feature < found.front().size(); ++feature) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& features : found) mean += features[feature] / count;
    double squares = 0.0;
    for (const auto& features : found) squares += (features[feature] - mean).squaredNorm();
    largest = std::max(largest, std::sqrt(squares / (count - 1.0)));
  }
  return largest;
}

}  // namespace isotherm
