#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace isotherm {

/// Finds neighbours among points: a balanced k-d tree whose nodes are ranges of one array, so that
/// points far from all others cost no more than near ones. Points that are not finite are never
/// found. Thread-safe (immutable).
class PointIndex {
 public:
  /// Holds a point by its index and how far away it is.
  struct Neighbour {
    std::uint32_t index = 0;
    float distance_m = 0.0F;
  };

  explicit PointIndex(std::span<const Eigen::Vector3f> points);

  /// The nearest point not further away than `max_distance_m`; the one with the smallest index of
  /// several.
  std::optional<Neighbour> Nearest(const Eigen::Vector3f& p, float max_distance_m) const;

  /// Calls `visit(Neighbour)` for each point within `radius_m`, in no particular order.
  template <typename Visit>
  void ForEachWithin(const Eigen::Vector3f& p, float radius_m, const Visit& visit) const {
    VisitRange(0, points_.size(), p, radius_m, visit);
  }

 private:
  /// Holds a point in the order of the tree.
  struct Point {
    Eigen::Vector3f position;
    std::uint32_t index;
  };
  /// A leaf is searched point by point. Larger: more distances for each query; smaller: a deeper
  /// tree. Not tuned.
  static constexpr std::size_t kLeafPoints = 12;

  void Build(std::size_t begin, std::size_t end);
  void NearestInRange(std::size_t begin, std::size_t end, const Eigen::Vector3f& p,
                      Neighbour& best) const;
  static void Offer(const Point& point, const Eigen::Vector3f& p, Neighbour& best);

  template <typename Visit>
  void VisitRange(std::size_t begin, std::size_t end, const Eigen::Vector3f& p, float radius_m,
                  const Visit& visit) const {
    if (end - begin <= kLeafPoints) {
      for (std::size_t i = begin; i < end; ++i) VisitPoint(points_[i], p, radius_m, visit);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const int axis = axes_[middle];
    const float offset = p[axis] - points_[middle].position[axis];
    if (offset <= radius_m) VisitRange(begin, middle, p, radius_m, visit);
    VisitPoint(points_[middle], p, radius_m, visit);
    if (offset >= -radius_m) VisitRange(middle + 1, end, p, radius_m, visit);
  }

  template <typename Visit>
  static void VisitPoint(const Point& point, const Eigen::Vector3f& p, float radius_m,
                         const Visit& visit) {
    const float distance = (point.position - p).norm();
    if (distance <= radius_m) visit(Neighbour{point.index, distance});
  }

  std::vector<Point>
      points_;  ///< The node of a range is its middle; children are what is left and right.
  std::vector<std::uint8_t> axes_;  ///< Splitting axis of the node at the same place.
};

/// Median distance from a point to its nearest neighbour at another place, from a sample; 0 for
/// fewer than two.
float TypicalSpacing(std::span<const Eigen::Vector3f> points, const PointIndex& index);

}  // namespace isotherm
