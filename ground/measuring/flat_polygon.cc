#include "ground/measuring/flat_polygon.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of a polygon on the left of the line from `a` to `b`.
std::vector<Eigen::Vector2d> CutLeft(const std::vector<Eigen::Vector2d>& polygon,
                                     const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  std::vector<Eigen::Vector2d> kept;
  const auto side = [&](const Eigen::Vector2d& p) { return Cross(b - a, p - a); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = side(p), at_q = side(q);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))
      kept.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

}  // namespace

double SignedArea(std::span<const Eigen::Vector2d> polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += Cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return 0.5 * twice;
}

double FractionInside(const std::array<Eigen::Vector2d, 3>& triangle,
                      std::span<const Eigen::Vector2d> polygon) {
  const double area = SignedArea(triangle);
  if (area == 0.0) return 0.0;
  std::vector<Eigen::Vector2d> part(polygon.begin(), polygon.end());
  for (std::size_t i = 0; i < 3 && !part.empty(); ++i) {
    const Eigen::Vector2d& a = triangle[i];
    const Eigen::Vector2d& b = triangle[(i + 1) % 3];
    part = area > 0.0 ? CutLeft(part, a, b) : CutLeft(part, b, a);
  }
  return std::clamp(std::abs(SignedArea(part)) / std::abs(area), 0.0, 1.0);
}

}  // namespace isotherm
