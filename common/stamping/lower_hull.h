#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace isotherm {

/// Lower convex hull of points that come in order of x. Thread-compatible.
class LowerHull {
 public:
  /// A point of the plane: x is the device's clock, y the host's.
  struct Point {
    double x = 0.0;
    double y = 0.0;
  };
  /// A line of the plane, y = at_zero + slope * x.
  struct Line {
    double slope = 0.0;
    double at_zero = 0.0;
    double At(double x) const { return at_zero + slope * x; }
  };

  /// `point.x` not below that of the last one; of several at one x the lowest counts. Amortised
  /// constant time.
  void Add(Point point);
  /// The highest line below all points at `x`, among those with a slope of at most `max_slope`:
  /// through the hull's edge over x, or touching one corner if that is too steep. Needs a point.
  Line Below(double x, double max_slope = std::numeric_limits<double>::infinity()) const;

  bool empty() const { return points_.empty(); }
  double first_x() const { return points_.front().x; }
  double last_x() const { return points_.back().x; }
  std::size_t corners() const { return points_.size(); }

 private:
  std::vector<Point> points_;
};

}  // namespace isotherm
