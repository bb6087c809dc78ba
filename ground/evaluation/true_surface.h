#pragma once

#include <optional>

#include "ground/evaluation/point_index.h"
#include "ground/evaluation/point_sets.h"

namespace isotherm {

/// The true surface as discs (surfels) around its samples. Thread-safe (immutable).
///
/// Distance of a point p to the disc around sample q with unit normal n: the offset along the
/// normal is h = n . (p - q), the offset beside it d = |(p - q) - h n|; within the disc's radius r
/// the distance is |h|, beyond it sqrt(h^2 + (d - r)^2). r is the typical spacing of the samples,
/// so that the discs close the surface between them; at a convex edge they stand out by at most r
/// in their own plane.
class TrueSurface {
 public:
  explicit TrueSurface(TruePoints points);

  /// Holds where a point meets the true surface.
  struct Foot {
    std::uint32_t nearest = 0;  ///< Nearest sample.
    std::uint32_t disc = 0;     ///< Sample of the nearest disc.
    float distance_m = 0.0F;    ///< To that disc.
  };
  /// nullopt for points that are not finite.
  std::optional<Foot> Project(const Eigen::Vector3f& p) const;

  /// True temperature at `p`, smoothed over the samples of the nearest one's shape within two
  /// spacings, °C.
  float CelsiusAt(const Eigen::Vector3f& p, std::uint32_t nearest) const;
  /// Difference between the hottest and the coldest sample within `radius_m`, kelvin.
  float CelsiusSpread(const Eigen::Vector3f& p, float radius_m) const;

  const TruePoints& points() const { return points_; }
  float spacing_m() const { return spacing_m_; }

 private:
  float DiscDistance(const Eigen::Vector3f& p, std::uint32_t sample) const;

  TruePoints points_;
  PointIndex index_;
  float spacing_m_;
};

}  // namespace isotherm
