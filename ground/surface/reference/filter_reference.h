#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/frame/frame.h"
#include "common/testing/kernel_checks.h"
#include "ground/surface/filter_kernel.h"

// These functions do what the kernels beside this folder must do, one element at a time and in
// double precision: they are their specification. Compiled for tests only.
namespace isotherm::reference {

/// The bilateral filter's mean with the biweight's weights.
inline double FilterPixel(const BilateralRowArgs& a, int x) {
  const double centre = a.rows[a.radius][x];
  if (!(centre > 0.0)) return 0.0;
  const double tau = std::min(a.tau_at_1m * centre, 1.0) * centre;
  double sum = 0.0;
  double weights = 0.0;
  for (int dy = -a.radius; dy <= a.radius; ++dy) {
    const float* row = a.rows[dy + a.radius];
    for (int dx = -a.radius; row != nullptr && dx <= a.radius; ++dx) {
      if (x + dx < 0 || x + dx >= a.width || row[x + dx] == 0.0F) continue;
      const double u = (row[x + dx] - centre) / tau;
      const double falloff = std::pow(std::max(0.0, 1.0 - u * u), 2);
      const double w = falloff * a.spatial[(dy + a.radius) * (2 * a.radius + 1) + dx + a.radius];
      sum += w * row[x + dx];
      weights += w;
    }
  }
  return sum / weights;
}

/// Metres of a raw depth; 0 = none. Products of single precision, as is said of the limits.
inline double Metres(const MetresRowArgs& a, std::uint16_t raw) {
  const float depth = static_cast<float>(raw) * a.metres_per_unit;
  const bool good = raw != kNoDepth && raw != kNoDepthSaturated && depth >= a.min_depth_m &&
                    depth <= a.max_depth_m;
  return good ? double{a.metres_per_unit} * raw : 0.0;
}

/// Mean of those near the nearest; each bound of it, where rounding may decide which are near.
struct HalfPixel {
  std::vector<double> means;
};

inline HalfPixel HalvePixel(const HalfRowArgs& a, int x) {
  std::vector<double> z;
  for (const float* row : {a.upper, a.lower}) {
    for (const int column : {2 * x, 2 * x + 1}) {
      if (row[column] > 0.0F) z.push_back(row[column]);
    }
  }
  if (z.empty()) return {{0.0}};
  std::sort(z.begin(), z.end());
  HalfPixel result;
  for (const double slack : {-testing::kSinglePrecision, testing::kSinglePrecision}) {
    double sum = 0.0;
    double count = 0.0;
    for (const double value : z) {
      if (value != z.front() && value - z.front() > (a.max_step_ratio + slack) * z.front())
        continue;
      sum += value;
      count += 1.0;
    }
    result.means.push_back(sum / count);
  }
  return result;
}

/// The depth that FillRow must give a pixel, 0 = none; nullopt where rounding may decide.
inline std::optional<double> FillPixel(const FillRowArgs& a, int x) {
  using testing::AtLeastZero;
  using testing::Both;
  using testing::Tribool;
  constexpr double kSlack = 1e-4;
  const int side = 2 * a.radius + 1;
  if (a.rows[a.radius][x] > 0.0F) return a.rows[a.radius][x];
  if (x < a.radius || x >= a.width - a.radius) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  const auto for_depths = [&](const auto& visit) {
    for (int row = 0; row < side; ++row) {
      for (int dx = -a.radius; a.rows[row] != nullptr && dx <= a.radius; ++dx) {
        if (a.rows[row][x + dx] > 0.0F)
          visit(double{a.rows[row][x + dx]}, Eigen::Vector3d(dx, row - a.radius, 1.0));
      }
    }
  };
  for_depths([&](double z, const Eigen::Vector3d&) { nearest = std::min(nearest, z); });
  if (!std::isfinite(nearest)) return 0.0;
  // The plane 1 / z = (1 + k . (dx, dy, 1)) / nearest, weighted by z.
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  Tribool certain = Tribool::kYes;
  const auto for_used = [&](const auto& visit) {
    for_depths([&](double z, const Eigen::Vector3d& offset) {
      const Tribool used = AtLeastZero(a.max_step_ratio - (z / nearest - 1.0), 1e-6);
      if (used == Tribool::kEither) certain = Tribool::kEither;
      if (used != Tribool::kNo) visit(z / nearest, offset);
    });
  };
  for_used([&](double r, const Eigen::Vector3d& offset) {
    M += r * r * offset * offset.transpose();
    right += r * (1.0 - r) * offset;
  });
  const Eigen::Vector2d mean = M.block<2, 1>(0, 2) / M(2, 2);
  const Eigen::Matrix2d scatter = M.topLeftCorner<2, 2>() - M(2, 2) * mean * mean.transpose();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues()(0);
  Tribool good = AtLeastZero(least - 0.5 * a.radius * a.radius, kSlack);
  good = Both(good, AtLeastZero(0.7 * a.radius - mean.cwiseAbs().maxCoeff(), kSlack));
  good = Both(good, AtLeastZero(M(2, 2) - 4.5, kSlack));
  if (certain == Tribool::kEither) return std::nullopt;
  if (good == Tribool::kNo) return 0.0;
  const Eigen::Vector3d k = M.fullPivLu().solve(right);
  double squared_error = 0.0;
  double squares = 0.0;  // The kernel subtracts sums of this size.
  for_used([&](double r, const Eigen::Vector3d& offset) {
    squared_error += std::pow(r * (1.0 + k.dot(offset)) - 1.0, 2);
    squares += (1.0 - r) * (1.0 - r);
  });
  const double allowed = 1.3 * a.noise_at_1m * nearest;
  good = Both(good, AtLeastZero(allowed * allowed - squared_error / M(2, 2),
                                10.0 * testing::kSinglePrecision * (squares + allowed * allowed)));
  if (good == Tribool::kNo) return 0.0;
  if (good == Tribool::kEither) return std::nullopt;
  return nearest / (1.0 + k.z());
}

}  // namespace isotherm::reference
