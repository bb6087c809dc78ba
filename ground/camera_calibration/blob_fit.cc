#include "ground/camera_calibration/blob_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace isotherm {
namespace {

/// Cells per pixel and direction of the predicted image: area and blur are computed on them.
constexpr int kCells = 2;
/// Two shifts, blur, scale, wall; then background and filling with their slopes.
constexpr int kBlur = 2, kScale = 3, kWall = 4, kShape = 5, kUnknowns = kShape + 6;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// Less blur than a pixel's own area makes cannot be told from none; with more the holes of a board
/// run into each other.
constexpr double kMinBlur_px = 0.15, kMaxBlur_px = 5.0;

struct WindowBox {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

WindowBox BoxOf(const Polygon& polygon, int image_width, int image_height) {
  Eigen::Vector2d low = polygon.front(), high = polygon.front();
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  WindowBox box;
  box.x0 = std::max(0, static_cast<int>(std::floor(low.x())));
  box.y0 = std::max(0, static_cast<int>(std::floor(low.y())));
  box.width = std::min(image_width - 1, static_cast<int>(std::ceil(high.x()))) - box.x0 + 1;
  box.height = std::min(image_height - 1, static_cast<int>(std::ceil(high.y()))) - box.y0 + 1;
  return box;
}

void BlurCells(double sigma, Image<float>& cells, Image<float>& scratch) {
  constexpr double kReach = 4.0;  // Standard deviations.
  const int radius = static_cast<int>(std::ceil(kReach * sigma));
  std::vector<float> weights(static_cast<std::size_t>(radius) + 1);
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i)
    sum += (i == 0 ? 1.0 : 2.0) * std::exp(-0.5 * i * i / (sigma * sigma));
  for (int i = 0; i <= radius; ++i)
    weights[static_cast<std::size_t>(i)] =
        static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma)) / sum);
  const int width = cells.width(), height = cells.height();
  scratch.Resize(width, height);
  for (int y = 0; y < height; ++y) {
    float* const out = scratch.Row(y).data();
    const float* const in = cells.Row(y).data();
    for (int x = 0; x < width; ++x) out[x] = weights[0] * in[x];
    for (int i = 1; i <= radius; ++i) {
      const float w = weights[static_cast<std::size_t>(i)];
      for (int x = 0; x + i < width; ++x) {
        out[x] += w * in[x + i];
        out[x + i] += w * in[x];
      }
    }
  }
  for (int y = 0; y < height; ++y) {
    float* const out = cells.Row(y).data();
    const float* const in = scratch.Row(y).data();
    for (int x = 0; x < width; ++x) out[x] = weights[0] * in[x];
    for (int i = 1; i <= radius; ++i) {
      const float w = weights[static_cast<std::size_t>(i)];
      for (const int other : {y - i, y + i}) {
        if (other < 0 || other >= height) continue;
        const float* const row = scratch.Row(other).data();
        for (int x = 0; x < width; ++x) out[x] += w * row[x];
      }
    }
  }
}

/// The predicted image of a hole: which part of a pixel is filled, and how that changes.
class Template {
 public:
  Template(const BlobModel& model, const WindowBox& box) : model_(model), box_(box) {
    centre_ = Centroid(model.outline);
  }

  /// Sets the outline's place, blur and size, and how much the wall looks like the filling.
  void Draw(const Eigen::Vector2d& shift, double blur_px, double scale, double wall_fill) {
    blur_px_ = blur_px;
    shifted_centre_ = centre_ + shift;
    // Room for the blur, so that no border is near the pixels that count.
    margin_ = static_cast<int>(std::ceil(4.0 * blur_px)) + 1;
    cells_.Resize(kCells * (box_.width + 2 * margin_), kCells * (box_.height + 2 * margin_));
    Fill(model_.outline, scale, cells_);
    if (!model_.rim.empty()) AddWall(scale, static_cast<float>(wall_fill));
    BlurCells(kCells * blur_px, cells_, scratch_);
  }

  struct Value {
    double filled = 0.0;
    Eigen::Matrix<double, kShape, 1> slope;
  };
  /// At a pixel of the box.
  Value At(int x, int y) const {
    const int cx = kCells * (x + margin_), cy = kCells * (y + margin_);
    double sum = 0.0, right = 0.0, down = 0.0, curvature = 0.0;
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const auto cell = [&](int dx, int dy) {
          return static_cast<double>(cells_.At(cx + i + dx, cy + j + dy));
        };
        const double middle = cell(0, 0);
        sum += middle;
        right += cell(1, 0) - cell(-1, 0);
        down += cell(0, 1) - cell(0, -1);
        curvature += cell(1, 0) + cell(-1, 0) + cell(0, 1) + cell(0, -1) - 4.0 * middle;
      }
    }
    constexpr double kArea = kCells * kCells;
    const Eigen::Vector2d gradient(0.5 * kCells * right / kArea, 0.5 * kCells * down / kArea);
    const Eigen::Vector2d arm = Eigen::Vector2d(box_.x0 + x, box_.y0 + y) - shifted_centre_;
    Value value;
    value.filled = sum / kArea;
    // A Gaussian's derivative by its standard deviation is that times its Laplacian.
    value.slope << -gradient.x(), -gradient.y(), blur_px_ * kCells * kCells * curvature / kArea,
        -arm.dot(gradient), WallAt(cx, cy);
    return value;
  }
  const Eigen::Vector2d& centre() const { return centre_; }

 private:
  void Fill(const Polygon& polygon, double scale, Image<float>& cells) {
    const Eigen::Vector2d corner(box_.x0 - margin_ - 0.5, box_.y0 - margin_ - 0.5);
    polygon_.clear();
    for (const Eigen::Vector2d& p : polygon)
      polygon_.emplace_back(kCells * (shifted_centre_ + scale * (p - centre_) - corner));
    Cover(polygon_, cells);
  }
  void AddWall(double scale, float wall_fill) {
    wall_.Resize(cells_.width(), cells_.height());
    Fill(model_.rim, scale, wall_);
    for (std::size_t i = 0; i < wall_.size(); ++i) {
      wall_.pixels()[i] -= cells_.pixels()[i];
      cells_.pixels()[i] += wall_fill * wall_.pixels()[i];
    }
    if (model_.fit_wall) BlurCells(kCells * blur_px_, wall_, scratch_);
  }
  double WallAt(int cx, int cy) const {
    if (!model_.fit_wall || model_.rim.empty()) return 0.0;
    double sum = 0.0;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) sum += static_cast<double>(wall_.At(cx + i, cy + j));
    return sum / (kCells * kCells);
  }

  const BlobModel& model_;
  const WindowBox box_;
  Eigen::Vector2d centre_, shifted_centre_;
  double blur_px_ = 0.0;
  int margin_ = 0;
  Polygon polygon_;
  Image<float> cells_, wall_, scratch_;
};

struct Sample {
  int x, y;
  double value;
  double weight = 1.0;
};

std::vector<Sample> SamplesIn(const Image<float>& image, const Polygon& window,
                              const WindowBox& box) {
  Image<float> inside(box.width, box.height);
  Polygon local;
  for (const Eigen::Vector2d& p : window)
    local.emplace_back(p - Eigen::Vector2d(box.x0 - 0.5, box.y0 - 0.5));
  Cover(local, inside);
  std::vector<Sample> samples;
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      const float value = image.At(box.x0 + x, box.y0 + y);
      if (inside.At(x, y) > 0.5F && std::isfinite(value))
        samples.push_back({x, y, static_cast<double>(value)});
    }
  }
  return samples;
}

/// Gauss-Newton over all unknowns of one hole.
class BlobSolver {
 public:
  BlobSolver(const BlobModel& model, const WindowBox& box, std::vector<Sample> samples)
      : model_(model), box_(box), samples_(std::move(samples)), template_(model, box) {
    radius_px_ = std::sqrt(std::abs(SignedArea(model.outline)) / std::numbers::pi);
    unknowns_.setZero();
    unknowns_.head<kShape>() << model.shift_px.x(), model.shift_px.y(), model.blur_px,
        model.known_scale.value_or(model.scale), model.wall_fill;
  }

  std::optional<BlobFit> Solve() {
    if (!Begin()) return std::nullopt;
    // The bound is for fits that would never settle. 2e-4 px is a fiftieth of what an ideal image
    // of a hole tells (kFloor_px of feature_measurement.cc).
    constexpr int kMaxIterations = 25;
    constexpr double kConverged_px = 2e-4;
    for (int i = 0; i < kMaxIterations; ++i) {
      const Eigen::Vector2d before = unknowns_.head<2>();
      if (!Iterate()) return std::nullopt;
      if ((unknowns_.head<2>() - before).norm() < kConverged_px && i > 1) return Result();
    }
    return std::nullopt;
  }

 private:
  /// Background and filling from a first look; the shape is as predicted.
  bool Begin() {
    template_.Draw(unknowns_.head<2>(), unknowns_(kBlur), unknowns_(kScale), unknowns_(kWall));
    double inside = 0.0, outside = 0.0, sum_inside = 0.0, sum_outside = 0.0;
    for (const Sample& sample : samples_) {
      const double filled = template_.At(sample.x, sample.y).filled;
      inside += filled;
      outside += 1.0 - filled;
      sum_inside += filled * sample.value;
      sum_outside += (1.0 - filled) * sample.value;
    }
    // Fewer pixels than this tell no shape.
    constexpr double kMinPixels = 6.0;
    if (inside < kMinPixels || outside < kMinPixels) return false;
    unknowns_(kShape) = sum_outside / outside;
    unknowns_(kShape + 3) = sum_inside / inside;
    return true;
  }

  bool Iterate() {
    template_.Draw(unknowns_.head<2>(), unknowns_(kBlur), unknowns_(kScale), unknowns_(kWall));
    normal_.setZero();
    Unknowns gradient = Unknowns::Zero();
    std::vector<double> sizes;
    for (Sample& sample : samples_) {
      Unknowns row;
      const double residual = Residual(sample, row);
      const double size = std::abs(residual);
      sample.weight = noise_ > 0.0 ? std::min(1.0, kRobust * noise_ / std::max(size, 1e-30)) : 1.0;
      normal_.noalias() += sample.weight * row * row.transpose();
      gradient += sample.weight * residual * row;
      sizes.push_back(size);
    }
    AddPriors(gradient);
    const Eigen::LDLT<Normal> ldlt(normal_);
    if (ldlt.info() != Eigen::Success || !ldlt.isPositive()) return false;
    Unknowns step = ldlt.solve(gradient);
    if (!step.allFinite()) return false;
    // Beyond a part of the hole the prediction says nothing about what is there.
    const double limit = 0.3 * radius_px_;
    const double length = step.head<2>().norm();
    if (length > limit) step *= limit / length;
    unknowns_ += step;
    unknowns_(kBlur) = std::clamp(unknowns_(kBlur), kMinBlur_px, kMaxBlur_px);
    unknowns_(kScale) = std::clamp(unknowns_(kScale), 0.3, 3.0);
    noise_ = 1.4826 * Median(sizes);
    return (unknowns_.head<2>() - model_.shift_px).norm() < 2.0 * radius_px_;
  }

  /// Seen minus predicted, and the prediction's derivatives.
  double Residual(const Sample& sample, Unknowns& row) const {
    const Template::Value value = template_.At(sample.x, sample.y);
    const Eigen::Vector2d place =
        (Eigen::Vector2d(box_.x0 + sample.x, box_.y0 + sample.y) - template_.centre()) / radius_px_;
    const Eigen::Vector3d basis(1.0, place.x(), place.y());
    const double background = basis.dot(unknowns_.segment<3>(kShape));
    const double filling = basis.dot(unknowns_.segment<3>(kShape + 3));
    row.head<kShape>() = (filling - background) * value.slope;
    row.segment<3>(kShape) = (1.0 - value.filled) * basis;
    row.segment<3>(kShape + 3) = value.filled * basis;
    return sample.value - (background + value.filled * (filling - background));
  }

  /// Keeps near what is known what the image does not tell.
  void AddPriors(Unknowns& gradient) {
    const double contrast = std::abs(unknowns_(kShape + 3) - unknowns_(kShape));
    const double unit = std::max(contrast * contrast, 1e-12);
    const auto keep = [&](int unknown, double weight, double at) {
      normal_(unknown, unknown) += weight * unit;
      gradient(unknown) += weight * unit * (at - unknowns_(unknown));
    };
    // Weights beside those of pixels, which are about 1. Weak: what a small image cannot tell stays
    // where it began, and what it can tell is hardly pulled. Not tuned.
    constexpr double kFixed = 1e9, kWeak = 0.05;
    keep(kBlur, kWeak, model_.blur_px);
    keep(kScale, model_.known_scale ? kFixed : kWeak, model_.known_scale.value_or(model_.scale));
    keep(kWall, model_.fit_wall ? kWeak : kFixed, model_.wall_fill);
  }

  static double Median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  std::optional<BlobFit> Result() const {
    BlobFit fit;
    fit.shift_px = unknowns_.head<2>();
    fit.blur_px = unknowns_(kBlur);
    fit.scale = unknowns_(kScale);
    fit.wall_fill = unknowns_(kWall);
    fit.contrast = unknowns_(kShape + 3) - unknowns_(kShape);
    fit.noise = noise_;
    const Normal inverse = normal_.ldlt().solve(Normal::Identity());
    fit.covariance = noise_ * noise_ * inverse.topLeftCorner<2, 2>();
    fit.wall_sigma = noise_ * std::sqrt(inverse(kWall, kWall));
    return fit;
  }

  /// Standard deviations beyond which a pixel counts less: the usual three.
  static constexpr double kRobust = 3.0;
  const BlobModel& model_;
  const WindowBox box_;
  std::vector<Sample> samples_;
  Template template_;
  double radius_px_ = 0.0;
  double noise_ = 0.0;
  Unknowns unknowns_;
  Normal normal_;
};

}  // namespace

std::optional<BlobFit> FitBlob(const Image<float>& image, const BlobModel& model) {
  constexpr std::size_t kMinSamples = 3 * kUnknowns;
  if (model.outline.size() < 3 || model.window.size() < 3) return std::nullopt;
  const WindowBox box = BoxOf(model.window, image.width(), image.height());
  if (box.width < 3 || box.height < 3) return std::nullopt;
  std::vector<Sample> samples = SamplesIn(image, model.window, box);
  if (samples.size() < kMinSamples) return std::nullopt;
  return BlobSolver(model, box, std::move(samples)).Solve();
}

}  // namespace isotherm
