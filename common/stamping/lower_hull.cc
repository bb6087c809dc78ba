#include "common/stamping/lower_hull.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

/// Twice the area of a, b, c: positive if they turn left.
double Cross(const LowerHull::Point& a, const LowerHull::Point& b, const LowerHull::Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

void LowerHull::Add(Point point) {
  if (!points_.empty() && point.x <= points_.back().x) {
    CHECK(point.x == points_.back().x);
    if (point.y >= points_.back().y) return;
    points_.pop_back();
  }
  while (points_.size() >= 2 && Cross(points_[points_.size() - 2], points_.back(), point) <= 0.0) {
    points_.pop_back();
  }
  points_.push_back(point);
}

LowerHull::Line LowerHull::Below(double x, double max_slope) const {
  CHECK(!points_.empty());
  double slope = 0.0;
  if (points_.size() >= 2) {
    const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, x,
                                        [](double at, const Point& point) { return at < point.x; });
    const Point& right = *after;
    const Point& left = *(after - 1);
    slope = std::clamp((right.y - left.y) / (right.x - left.x), -max_slope, max_slope);
  }
  // With the slope limited, the line may no longer pass through the edge: it is moved down until it
  // is below all corners.
  double at_zero = std::numeric_limits<double>::infinity();
  for (const Point& point : points_) at_zero = std::min(at_zero, point.y - slope * point.x);
  return {.slope = slope, .at_zero = at_zero};
}

}  // namespace isotherm
