#include "ground/evaluation/true_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm {

TrueSurface::TrueSurface(TruePoints points)
    : points_(std::move(points)),
      index_(points_.positions_m),
      spacing_m_(TypicalSpacing(points_.positions_m, index_)) {}

float TrueSurface::DiscDistance(const Eigen::Vector3f& p, std::uint32_t sample) const {
  const Eigen::Vector3f offset = p - points_.positions_m[sample];
  const float along = offset.dot(points_.normals[sample]);
  const float beside = (offset - along * points_.normals[sample]).norm();
  // Discs as large as the spacing overlap: the surface between samples has no holes.
  return std::hypot(along, std::max(0.0F, beside - spacing_m_));
}

std::optional<TrueSurface::Foot> TrueSurface::Project(const Eigen::Vector3f& p) const {
  const auto nearest = index_.Nearest(p, std::numeric_limits<float>::max());
  if (!nearest) return std::nullopt;
  Foot foot{nearest->index, nearest->index, DiscDistance(p, nearest->index)};
  // Far away it makes no difference which disc it is.
  constexpr float kFarSpacings = 10.0F;
  if (nearest->distance_m > kFarSpacings * spacing_m_) return foot;
  index_.ForEachWithin(
      p, nearest->distance_m + spacing_m_, [&](const PointIndex::Neighbour& candidate) {
        const float distance = DiscDistance(p, candidate.index);
        const bool tie = distance == foot.distance_m && candidate.index < foot.disc;
        if (distance < foot.distance_m || tie) {
          foot.disc = candidate.index;
          foot.distance_m = distance;
        }
      });
  return foot;
}

float TrueSurface::CelsiusAt(const Eigen::Vector3f& p, std::uint32_t nearest) const {
  const float radius = 2.0F * spacing_m_;
  const std::uint32_t primitive = points_.primitive[nearest];
  double sum = 0.0;
  double weights = 0.0;
  index_.ForEachWithin(p, radius, [&](const PointIndex::Neighbour& neighbour) {
    // Across the edge of a part the temperature may jump; it must not be smoothed away.
    if (points_.primitive[neighbour.index] != primitive) return;
    const double fraction = neighbour.distance_m / radius;
    const double weight = (1.0 - fraction * fraction) * (1.0 - fraction * fraction);
    sum += weight * points_.celsius[neighbour.index];
    weights += weight;
  });
  return weights > 0.0 ? static_cast<float>(sum / weights) : points_.celsius[nearest];
}

float TrueSurface::CelsiusSpread(const Eigen::Vector3f& p, float radius_m) const {
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  index_.ForEachWithin(p, radius_m, [&](const PointIndex::Neighbour& neighbour) {
    low = std::min(low, points_.celsius[neighbour.index]);
    high = std::max(high, points_.celsius[neighbour.index]);
  });
  return std::max(0.0F, high - low);
}

}  // namespace isotherm
