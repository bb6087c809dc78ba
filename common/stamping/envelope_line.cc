#include "common/stamping/envelope_line.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/quantile.h"

namespace isotherm {
namespace {

// A group counts if it is above the hull's line by at most this many times what the lowest quarter
// of the groups is. That keeps nearly all groups of jitter alone, and half of all may be late.
constexpr double kReach = 4.0;
constexpr double kLowestFraction = 0.25;
// With fewer groups than this a quarter of them says nothing.
constexpr std::size_t kMinGroups = 4;
// Ticks have microseconds: closer than this is equal.
constexpr double kEqual_s = 2e-6;

}  // namespace

EnvelopeLine::EnvelopeLine(std::size_t group, double window_s, double max_slope)
    : group_(group), window_s_(window_s), max_slope_(max_slope) {
  CHECK(group >= 1);
  CHECK(window_s > 0.0);
  CHECK(max_slope > 0.0);
}

void EnvelopeLine::Add(Point sample) {
  TakeTurns(sample);
  // By the line as it is: the group itself may be steep.
  if (in_group_ == 0 || sample.y - slope_ * (sample.x - lowest_.x) < lowest_.y) lowest_ = sample;
  sum_ += sample.y;
  if (++in_group_ == group_) CloseGroup();
}

void EnvelopeLine::Clear() { *this = EnvelopeLine(group_, window_s_, max_slope_); }

void EnvelopeLine::TakeTurns(Point sample) {
  hull_.Add(sample);
  if (!next_hull_.empty() && sample.x - next_hull_.first_x() >= window_s_) {
    hull_ = std::exchange(next_hull_, {});
    hull_.Add(sample);
    while (!groups_.empty() && groups_.front().x < hull_.first_x()) groups_.pop_front();
  }
  // A hull cannot forget points: a second one begins when the first is as old as the window, and
  // takes over one window later. So the line rests on one to two windows.
  if (sample.x - hull_.first_x() >= window_s_) next_hull_.Add(sample);
}

void EnvelopeLine::CloseGroup() {
  groups_.push_back(lowest_);
  group_spread_ = sum_ / static_cast<double>(in_group_) - lowest_.y;
  in_group_ = 0;
  sum_ = 0.0;
  Fit();
}

double EnvelopeLine::Reach(const LowerHull::Line& base) const {
  std::vector<double> excess;
  excess.reserve(groups_.size());
  for (const Point& lowest : groups_) excess.push_back(lowest.y - base.At(lowest.x));
  if (excess.size() <= kMinGroups) return *std::ranges::max_element(excess) + kEqual_s;
  return kReach * TakeQuantile(excess, kLowestFraction) + kEqual_s;
}

void EnvelopeLine::Fit() {
  // The hull rests on single frames; the line is fitted to all groups that are near it, which is
  // less noisy.
  const LowerHull::Line base = hull_.Below((hull_.first_x() + hull_.last_x()) / 2.0, max_slope_);
  const double reach = Reach(base);
  const auto counts = [&](const Point& lowest) { return lowest.y - base.At(lowest.x) <= reach; };
  mean_ = {};
  used_ = 0;
  for (const Point& lowest : groups_) {
    if (!counts(lowest)) continue;
    mean_.x += lowest.x;
    mean_.y += lowest.y;
    ++used_;
  }
  CHECK(used_ > 0);  // The lowest quarter is within reach.
  mean_.x /= static_cast<double>(used_);
  mean_.y /= static_cast<double>(used_);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Point& lowest : groups_) {
    if (!counts(lowest)) continue;
    const double x = lowest.x - mean_.x, y = lowest.y - mean_.y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  moment_ = xx;
  slope_ = xx > 0.0 ? std::clamp(xy / xx, -max_slope_, max_slope_) : 0.0;
  // Two points always lie on their line.
  variance_ = used_ < 3 ? 0.0
                        : std::max(0.0, yy - 2.0 * slope_ * xy + slope_ * slope_ * xx) /
                              static_cast<double>(used_ - 2);
}

double EnvelopeLine::Sigma(double x) const {
  if (used_ < 3) return group_spread_;
  const double from_mean = x - mean_.x;
  return std::sqrt(variance_ *
                   (1.0 / static_cast<double>(used_) + from_mean * from_mean / moment_));
}

}  // namespace isotherm
