#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// Knows what the views of a target have shown a camera so far, and what a careful person would
/// add: zones of the image, tilts, distances. Thread-compatible.
class ViewCoverage {
 public:
  static constexpr int kZoneColumns = 3, kZoneRows = 3;

  explicit ViewCoverage(const Eigen::Vector2i& size_px) : size_px_(size_px) {}

  /// One view: where the features are in the image, and where the target is.
  void Add(const std::vector<Eigen::Vector2d>& features_px, const RigidTransform& T_camera_board);

  int views() const { return views_; }
  /// Features per zone of the image, row by row.
  const std::array<int, kZoneColumns * kZoneRows>& zones() const { return zones_; }
  double MinDistance() const { return min_distance_m_; }
  double MaxDistance() const { return max_distance_m_; }
  /// The fraction of the half diagonal that the farthest feature reached.
  double reach_fraction() const { return reach_fraction_; }

  /// Returns what is missing, a phrase each, the most important first: "no views with the target in
  /// the upper left corner".
  std::vector<std::string> Missing() const;

 private:
  const Eigen::Vector2i size_px_;
  int views_ = 0;
  std::array<int, kZoneColumns * kZoneRows> zones_{};
  /// Views in which the board's left, right, upper or lower side (in the image) is the nearer one.
  std::array<int, 4> tilted_{};
  double min_distance_m_ = 0.0, max_distance_m_ = 0.0;
  double reach_fraction_ = 0.0;
};

}  // namespace isotherm
