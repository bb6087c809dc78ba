#include "ground/calibration/depth_consistency.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Depth that differs by more is another surface, or was not there.
constexpr double kMaxError = 0.03;
/// More oblique surfaces are as uncertain as their edges.
constexpr float kMinCosine = 0.6F;
/// A cell of which less shows surface tells nothing of itself, a frame with fewer cells nothing of
/// its pose.
constexpr double kMinShown = 0.15;
constexpr int kMinCells = 12;
/// Every so many pixels along either axis.
constexpr int kStride = 2;
/// So many cells must have been seen in at least half of the blocks.
constexpr int kMinSeen = 24;

struct CellMean {
  double error = 0.0;
  int pixels = 0;
};

using FrameCells = std::array<CellMean, DepthConsistency::kColumns * DepthConsistency::kRows>;

/// Takes out what a wrong pose does to the errors of a frame: a constant and slopes.
bool TakeOutPose(FrameCells& cells) {
  const auto seen = std::ranges::count_if(cells, [](const CellMean& c) { return c.pixels > 0; });
  if (seen < kMinCells) return false;
  Eigen::MatrixXd places(seen, 3);
  Eigen::VectorXd errors(seen);
  Eigen::Index row = 0;
  const auto place = [](std::size_t cell) {
    const std::size_t column = cell % DepthConsistency::kColumns;
    const std::size_t line = cell / DepthConsistency::kColumns;
    return Eigen::RowVector3d(1.0, static_cast<double>(column), static_cast<double>(line));
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].pixels == 0) continue;
    places.row(row) = place(i);
    errors(row++) = cells[i].error;
  }
  const Eigen::Vector3d plane = places.colPivHouseholderQr().solve(errors);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].pixels > 0) cells[i].error -= place(i) * plane;
  return true;
}

/// The mean over blocks of the product of cells' errors in two different ones: noise of either is
/// not that of the other. `left_out` is no block of it.
double Covariance(const std::vector<std::vector<std::optional<double>>>& errors, int left_out) {
  double sum = 0.0;
  int pairs = 0;
  for (std::size_t a = 0; a < errors.size(); ++a) {
    for (std::size_t b = a + 1; b < errors.size(); ++b) {
      if (static_cast<int>(a) == left_out || static_cast<int>(b) == left_out) continue;
      for (std::size_t cell = 0; cell < errors[a].size(); ++cell) {
        if (!errors[a][cell] || !errors[b][cell]) continue;
        sum += *errors[a][cell] * *errors[b][cell];
        ++pairs;
      }
    }
  }
  return pairs > 0 ? sum / pairs : 0.0;
}

}  // namespace

void DepthConsistency::Add(const Image<float>& depth_m, const SurfaceMaps& surface,
                           const RigidTransform& T_map_depth, int block) {
  const Eigen::Vector3f axis = T_map_depth.linear().col(2).cast<float>();
  const Eigen::Vector3f origin = T_map_depth.translation().cast<float>();
  FrameCells cells{};
  double distances_m = 0.0;
  int pixels = 0;
  for (int y = 0; y < depth_m.height(); y += kStride) {
    for (int x = 0; x < depth_m.width(); x += kStride) {
      const float measured_m = depth_m.At(x, y);
      const Eigen::Vector3f p_map(surface.vx.At(x, y), surface.vy.At(x, y), surface.vz.At(x, y));
      if (!(measured_m > 0.0F) || std::isnan(p_map.z())) continue;
      const Eigen::Vector3f ray = p_map - origin;
      const Eigen::Vector3f normal(surface.nx.At(x, y), surface.ny.At(x, y), surface.nz.At(x, y));
      if (!(-normal.dot(ray) >= kMinCosine * ray.norm())) continue;
      const double error =
          static_cast<double>(measured_m) / static_cast<double>(axis.dot(ray)) - 1.0;
      if (!(std::abs(error) < kMaxError)) continue;
      CellMean& cell = cells[static_cast<std::size_t>(y * kRows / depth_m.height() * kColumns +
                                                      x * kColumns / depth_m.width())];
      cell.error += error;
      ++cell.pixels;
      distances_m += static_cast<double>(measured_m);
      ++pixels;
    }
  }
  const double cell_pixels =
      static_cast<double>(depth_m.size()) / (kStride * kStride * static_cast<double>(cells.size()));
  for (CellMean& cell : cells) {
    if (cell.pixels < kMinShown * cell_pixels) cell.pixels = 0;
    if (cell.pixels > 0) cell.error /= cell.pixels;
  }
  if (!TakeOutPose(cells)) return;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].pixels == 0) continue;
    Sum& sum = blocks_[static_cast<std::size_t>(block)][i];
    sum.errors += cells[i].error;
    sum.frames += 1.0;
  }
  distances_m_ += distances_m / pixels;
  ++frames_;
}

DepthAssessment DepthConsistency::Assess() const {
  DepthAssessment result;
  result.frames = frames_;
  if (frames_ > 0) result.distance_m = distances_m_ / frames_;
  std::vector<std::vector<std::optional<double>>> errors;
  std::array<int, kColumns * kRows> seen{};
  for (const Cells& block : blocks_) {
    std::vector<std::optional<double>> means(block.size());
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block[i].frames == 0.0) continue;
      means[i] = block[i].errors / block[i].frames;
      ++seen[i];
    }
    errors.push_back(std::move(means));
  }
  if (std::ranges::count_if(seen, [](int blocks) { return 2 * blocks >= kBlocks; }) < kMinSeen)
    return result;
  const double variance = Covariance(errors, -1);
  // The jackknife, of the variance: its root may be of something negative.
  double mean = 0.0, squares = 0.0;
  std::array<double, kBlocks> without{};
  for (int block = 0; block < kBlocks; ++block) {
    without[static_cast<std::size_t>(block)] = Covariance(errors, block);
    mean += without[static_cast<std::size_t>(block)] / kBlocks;
  }
  for (const double each : without) squares += (each - mean) * (each - mean);
  const double variance_sigma = std::sqrt((kBlocks - 1.0) / kBlocks * squares);
  result.uneven = std::sqrt(std::max(0.0, variance));
  // From the variance's; of what is zero the root of it.
  result.sigma = result.uneven > 0.0
                     ? std::min(variance_sigma / (2.0 * result.uneven), std::sqrt(variance_sigma))
                     : std::sqrt(variance_sigma);
  if (result.uneven > std::max(kMaxUneven, 3.0 * result.sigma)) {
    result.verdict = CheckVerdict::kMoved;
  } else if (std::sqrt(std::max(0.0, variance) + variance_sigma) <= 2.0 * kMaxUneven) {
    result.verdict = CheckVerdict::kAgrees;
  }
  return result;
}

std::string DescribeDepth(const DepthAssessment& assessment) {
  const auto amount = [&](double fraction) {
    return fmt::format("{:.3f} % ({:.2f} mm at {:.2f} m)", 100.0 * fraction,
                       1e3 * fraction * assessment.distance_m, assessment.distance_m);
  };
  switch (assessment.verdict) {
    case CheckVerdict::kMoved:
      return fmt::format("uneven over the image by {}, uncertain by {:.3f} %",
                         amount(assessment.uneven), 100.0 * assessment.sigma);
    case CheckVerdict::kAgrees:
      return fmt::format("ok, the same surface looks the same all over the image within {}",
                         amount(std::hypot(assessment.uneven, assessment.sigma)));
    default:
      return "this scan cannot tell: for half of the time surface has to fill half of the image, "
             "and longer if distances are noisy";
  }
}

}  // namespace isotherm
