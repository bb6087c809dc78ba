#include "ground/evaluation/point_index.h"

#include <algorithm>
#include <limits>

#include "common/base/quantile.h"

namespace isotherm {

PointIndex::PointIndex(std::span<const Eigen::Vector3f> points) {
  points_.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) points_.push_back({points[i], static_cast<std::uint32_t>(i)});
  }
  axes_.assign(points_.size(), 0);
  Build(0, points_.size());
}

void PointIndex::Build(std::size_t begin, std::size_t end) {
  if (end - begin <= kLeafPoints) return;
  Eigen::Vector3f low = points_[begin].position;
  Eigen::Vector3f high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(points_[i].position);
    high = high.cwiseMax(points_[i].position);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  // The tree lies in the array itself: the middle of a range is its node, so that no pointers are
  // needed.
  std::nth_element(at(begin), at(middle), at(end), [axis](const Point& a, const Point& b) {
    return a.position[axis] < b.position[axis];
  });
  axes_[middle] = static_cast<std::uint8_t>(axis);
  Build(begin, middle);
  Build(middle + 1, end);
}

void PointIndex::Offer(const Point& point, const Eigen::Vector3f& p, Neighbour& best) {
  const float distance = (point.position - p).norm();
  if (distance < best.distance_m || (distance == best.distance_m && point.index < best.index)) {
    best = {point.index, distance};
  }
}

void PointIndex::NearestInRange(std::size_t begin, std::size_t end, const Eigen::Vector3f& p,
                                Neighbour& best) const {
  if (end - begin <= kLeafPoints) {
    for (std::size_t i = begin; i < end; ++i) Offer(points_[i], p, best);
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const int axis = axes_[middle];
  const float offset = p[axis] - points_[middle].position[axis];
  Offer(points_[middle], p, best);
  // The side of the query first: the other one is mostly out of reach then.
  const bool left_first = offset <= 0.0F;
  if (left_first) {
    NearestInRange(begin, middle, p, best);
    if (-offset <= best.distance_m) NearestInRange(middle + 1, end, p, best);
  } else {
    NearestInRange(middle + 1, end, p, best);
    if (offset <= best.distance_m) NearestInRange(begin, middle, p, best);
  }
}

std::optional<PointIndex::Neighbour> PointIndex::Nearest(const Eigen::Vector3f& p,
                                                         float max_distance_m) const {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  if (!p.allFinite()) return std::nullopt;
  Neighbour best{kNone, max_distance_m};
  NearestInRange(0, points_.size(), p, best);
  if (best.index == kNone) return std::nullopt;
  return best;
}

float TypicalSpacing(std::span<const Eigen::Vector3f> points, const PointIndex& index) {
  // The median of 500 distances is steady enough for a spacing from which only a radius is chosen.
  // The limits keep repeated and single points from deciding it.
  constexpr std::size_t kSamples = 500;
  constexpr float kMinDistance_m = 1e-5F;
  constexpr float kMaxDistance_m = 10.0F;
  std::vector<float> distances;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSamples);
  for (std::size_t i = 0; i < points.size(); i += step) {
    if (!points[i].allFinite()) continue;
    float nearest = std::numeric_limits<float>::max();
    // Nearest() would find the point itself, or another in the same place.
    for (float radius = 1e-3F; radius <= kMaxDistance_m && nearest > radius; radius *= 2.0F) {
      index.ForEachWithin(points[i], radius, [&](const PointIndex::Neighbour& neighbour) {
        if (neighbour.distance_m > kMinDistance_m)
          nearest = std::min(nearest, neighbour.distance_m);
      });
    }
    if (nearest <= kMaxDistance_m) distances.push_back(nearest);
  }
  if (distances.empty()) return 0.0F;
  return TakeMedian(distances);
}

}  // namespace isotherm
