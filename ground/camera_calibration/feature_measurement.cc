#include "ground/camera_calibration/feature_measurement.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "ground/camera_calibration/blob_fit.h"

namespace isotherm {
namespace {

using Pattern = CalibrationTarget::Pattern;

/// An image of a hole tells its place no better, pixels: lenses are not ideal, nor are holes.
constexpr double kFloor_px = 0.01;
/// Corners of a chessboard, refined by OpenCV. Not measured.
constexpr double kCornerSigma_px = 0.05;

double NeighbourDistance(const CalibrationTarget& target) {
  return target.pattern == Pattern::kAsymmetricCircles ? std::numbers::sqrt2 * target.square_m
                                                       : target.square_m;
}

/// Points on the rim of a hole of this size around its centre, on the board.
std::vector<Eigen::Vector2d> Rim(const CalibrationTarget& target, double size_m) {
  constexpr int kPoints = 48;
  std::vector<Eigen::Vector2d> rim;
  if (target.pattern == Pattern::kSquareHoles) {
    constexpr int kPerSide = kPoints / 4;
    for (int side = 0; side < 4; ++side) {
      const Eigen::Rotation2Dd rotation(0.5 * std::numbers::pi * side);
      for (int i = 0; i < kPerSide; ++i)
        rim.emplace_back(rotation *
                         Eigen::Vector2d(0.5 * size_m, size_m * (i / double{kPerSide} - 0.5)));
    }
    return rim;
  }
  // The polygon has the area of the circle.
  constexpr double kStep = 2.0 * std::numbers::pi / kPoints;
  const double radius_m = 0.5 * size_m * std::sqrt(kStep / std::sin(kStep));
  for (int i = 0; i < kPoints; ++i)
    rim.emplace_back(radius_m * Eigen::Vector2d(std::cos(i * kStep), std::sin(i * kStep)));
  return rim;
}

Polygon Project(const std::vector<Eigen::Vector2d>& rim, double behind_m, const BundleState& state,
                const CalibrationTarget& target, int camera, int view, int feature) {
  Polygon polygon;
  for (const Eigen::Vector2d& offset : rim) {
    polygon.push_back(ProjectBoardPoint(state, target, camera, view, feature, offset, behind_m));
    if (!polygon.back().allFinite()) return {};
  }
  return polygon;
}

/// Bilinear; NaN outside.
double Interpolated(const Image<float>& image, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (!image.Contains(x, y) || !image.Contains(x + 1, y + 1))
    return std::numeric_limits<double>::quiet_NaN();
  const double right = p.x() - x, down = p.y() - y;
  const auto at = [&](int dx, int dy) { return static_cast<double>(image.At(x + dx, y + dy)); };
  return (1.0 - down) * ((1.0 - right) * at(0, 0) + right * at(1, 0)) +
         down * ((1.0 - right) * at(0, 1) + right * at(1, 1));
}

}  // namespace

std::optional<FeatureMeasurement> MeasureHole(const Image<float>& image, const BundleState& state,
                                              const CalibrationTarget& target,
                                              const HoleAppearance& hole, int camera, int view,
                                              int feature, const Eigen::Vector2d& near_px) {
  const Polygon front =
      Project(Rim(target, hole.diameter_m), 0.0, state, target, camera, view, feature);
  if (front.empty()) return std::nullopt;
  BlobModel model;
  model.outline = front;
  if (target.thickness_m > 0.0) {
    const Polygon back = Project(Rim(target, hole.diameter_m), target.thickness_m, state, target,
                                 camera, view, feature);
    if (back.empty()) return std::nullopt;
    model.outline = Intersect(front, back);
    model.rim = front;
    model.wall_fill = hole.wall_fill;
    model.fit_wall = !hole.wall_known;
  }
  // As much of the board as is this hole's own.
  constexpr double kOwn = 0.4;
  const double window_m =
      hole.diameter_m + 2.0 * kOwn * (NeighbourDistance(target) - hole.diameter_m);
  model.window = Project(Rim(target, window_m), 0.0, state, target, camera, view, feature);
  if (model.window.empty() || model.outline.size() < 3) return std::nullopt;
  model.shift_px = near_px - Centroid(model.outline);
  model.blur_px = hole.blur_px;
  if (hole.size_known) model.known_scale = 1.0;
  const std::optional<BlobFit> fit = FitBlob(image, model);
  if (!fit) return std::nullopt;
  FeatureMeasurement result;
  result.observation = {camera, view, feature, Eigen::Vector2d::Zero(), fit->covariance};
  result.observation.pixel =
      ProjectBoardPoint(state, target, camera, view, feature, Eigen::Vector2d::Zero(), 0.0) +
      fit->shift_px;
  result.observation.covariance.diagonal().array() += kFloor_px * kFloor_px;
  result.blur_px = fit->blur_px;
  result.scale = fit->scale;
  result.wall_fill = fit->wall_fill;
  result.wall_sigma = fit->wall_sigma;
  result.contrast = fit->contrast;
  result.noise = fit->noise;
  return result;
}

std::vector<FeatureMeasurement> MeasureCorners(const Image<float>& image,
                                               const std::vector<Eigen::Vector2d>& near_px,
                                               const CalibrationTarget& target, int camera,
                                               int view) {
  cv::Mat values(image.height(), image.width(), CV_32F);
  std::copy(image.pixels().begin(), image.pixels().end(), values.begin<float>());
  std::vector<cv::Point2f> corners;
  double spacing = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < near_px.size(); ++i) {
    corners.emplace_back(static_cast<float>(near_px[i].x()), static_cast<float>(near_px[i].y()));
    if (i % static_cast<std::size_t>(target.columns) != 0)
      spacing = std::min(spacing, (near_px[i] - near_px[i - 1]).norm());
  }
  // Of the spacing: a window that does not reach the next corner.
  constexpr double kOwn = 0.35;
  const int half = std::clamp(static_cast<int>(kOwn * spacing), 2, 12);
  cv::cornerSubPix(values, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
  std::vector<FeatureMeasurement> result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    FeatureMeasurement measurement;
    measurement.observation = {camera, view, static_cast<int>(i),
                               Eigen::Vector2d(corners[i].x, corners[i].y),
                               kCornerSigma_px * kCornerSigma_px * Eigen::Matrix2d::Identity()};
    result.push_back(measurement);
  }
  return result;
}

double GuessHoleSize(const Image<float>& image, const CalibrationTarget& target,
                     const std::vector<Eigen::Vector2d>& features) {
  std::vector<double> sizes;
  for (int i = 0; i + target.columns < target.features(); ++i) {
    const int other = i + target.columns;  // In the next row.
    const Eigen::Vector2d& from = features[static_cast<std::size_t>(i)];
    const Eigen::Vector2d& to = features[static_cast<std::size_t>(other)];
    const double distance_m = (target.FeaturePosition(other) - target.FeaturePosition(i)).norm();
    const double middle =
        0.5 * (Interpolated(image, from) + Interpolated(image, 0.5 * (from + to)));
    const bool above = Interpolated(image, from) > middle;
    constexpr int kSteps = 200;
    for (int step = 1; step < kSteps / 2; ++step) {
      const double part = step / double{kSteps};
      const double value = Interpolated(image, from + part * (to - from));
      if (!std::isfinite(value)) break;
      if ((value > middle) == above) continue;
      sizes.push_back(2.0 * part * distance_m);
      break;
    }
  }
  if (sizes.empty()) return 0.5 * NeighbourDistance(target);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace isotherm
