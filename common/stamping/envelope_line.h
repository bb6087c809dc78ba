#pragma once

#include <cstddef>
#include <deque>

#include "common/stamping/lower_hull.h"

namespace isotherm {

/// The straight line along which those frames arrive that were held up least, of differences
/// arrival - ticks over the camera's time.
///
///   groups    of every `group` frames the lowest counts; the others were held up
///   hull      a frame can be late but never early, so no line may lie above the lower convex hull
///             of all frames (Moon, Skelly and Towsley, INFOCOM 1999). Its edge over the middle is
///             the first guess, which any number of frames that are late together cannot move
///   line      least squares through the lowest of the groups, without those groups that are far
///             above the hull's line, because all their frames were late. So the line rests on
///             many frames instead of the two that the hull touches
///   forgets   two hulls, begun one window apart, take turns: it all rests on one to two windows
///
/// Thread-compatible.
class EnvelopeLine {
 public:
  using Point = LowerHull::Point;

  /// `group` >= 1 frames, `window_s` > 0 seconds of the camera's time, `max_slope` > 0 seconds per
  /// second.
  EnvelopeLine(std::size_t group, double window_s, double max_slope);

  /// `sample.x`: the camera's time, seconds, not below that of the last one; `sample.y`: the
  /// difference, seconds. Groups are assessed when they are full.
  void Add(Point sample);
  void Clear();

  /// There is a line: one group is full.
  bool ready() const { return used_ > 0; }
  /// Full groups in the window.
  std::size_t groups() const { return groups_.size(); }
  double At(double x) const { return mean_.y + slope_ * (x - mean_.x); }
  /// Seconds per second.
  double slope() const { return slope_; }
  /// Standard error of At(x), seconds: that of the regression, or while there are less than three
  /// groups what the frames of a group are above the lowest on average.
  double Sigma(double x) const;

 private:
  void TakeTurns(Point sample);
  void CloseGroup();
  void Fit();
  /// Returns how far above the hull's line a group may be.
  double Reach(const LowerHull::Line& base) const;

  std::size_t group_;
  double window_s_, max_slope_;
  LowerHull hull_, next_hull_;
  Point lowest_{};             ///< Least delayed point of the group that is not full yet.
  double sum_ = 0.0;           ///< Sum of that group's differences.
  std::size_t in_group_ = 0;   ///< Its frames.
  double group_spread_ = 0.0;  ///< Mean less lowest of the last group.
  std::deque<Point> groups_;   ///< The lowest of each.
  Point mean_{};               ///< Mean of the groups that the line rests on.
  double slope_ = 0.0;
  double variance_ = 0.0;  ///< Variance of one group about the line.
  double moment_ = 0.0;    ///< Sum of squares of x about the mean.
  std::size_t used_ = 0;   ///< Groups that the line rests on.
};

}  // namespace isotherm
