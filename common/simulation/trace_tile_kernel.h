#pragma once

#include <cstdint>

#include "common/simulation/primitive.h"
#include "common/simulation/ray_caster.h"

namespace isotherm {

/// A primitive as the inner loop wants it.
struct TileTarget {
  std::int32_t index = 0;         ///< Into Scene::primitives().
  float R_primitive_camera[9]{};  ///< Column-major.
  float camera_in_primitive[3]{};
  float size[3]{};
};

/// Nearest hits of a tile's rays so far.
struct TileHits {
  float z[RayGrid::kTilePixels];
  std::int32_t index[RayGrid::kTilePixels];
  float farthest;  ///< Largest of `z` after TraceTile.
};

/// Intersects all rays of a tile with one primitive and keeps what is nearer. SIMD with the widest
/// registers of this processor; the result does not depend on them.
void TraceTile(Shape shape, const TileTarget& target, const RayGrid::Tile& tile, TileHits& hits);

}  // namespace isotherm
