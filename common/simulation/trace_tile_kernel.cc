#include "common/simulation/trace_tile_kernel.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "common/simulation/trace_tile_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"
//
#include "common/simulation/intersection.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm {
namespace HWY_NAMESPACE {

/// Positive floats have the order of their bits, and the largest integer needs no associative
/// addition to be found in SIMD.
float Largest(const float* values) {
  std::int32_t largest = 0;
  for (int i = 0; i < RayGrid::kTilePixels; ++i) {
    const auto bits = std::bit_cast<std::int32_t>(values[i]);
    largest = bits > largest ? bits : largest;
  }
  return std::bit_cast<float>(largest);
}

// Intersects the rays of a tile with one primitive and keeps, per ray, the nearer hit. A ray (x, y,
// 1) from the camera becomes o + t (R_primitive_camera (x, y, 1)) in the primitive's coordinates;
// as its third component is 1, t is the depth. IntersectShape solves for the first t > 0 in closed
// form. Rows: one array each for x, y, the depth and the index of what is hit; lanes are
// neighbouring pixels of the tile. Fast: the shape is a template argument, conditions are combined
// without branches, and the compiler's vectoriser makes SIMD code of the loop, for which
// CMakeLists.txt passes the options.
template <Shape shape>
void TraceShape(const TileTarget& p, const RayGrid::Tile& tile, TileHits& hits) {
  const float r00 = p.R_primitive_camera[0], r10 = p.R_primitive_camera[1],
              r20 = p.R_primitive_camera[2];
  const float r01 = p.R_primitive_camera[3], r11 = p.R_primitive_camera[4],
              r21 = p.R_primitive_camera[5];
  const float r02 = p.R_primitive_camera[6], r12 = p.R_primitive_camera[7],
              r22 = p.R_primitive_camera[8];
  const float ox = p.camera_in_primitive[0], oy = p.camera_in_primitive[1],
              oz = p.camera_in_primitive[2];
  const LocalSize<float> size{p.size[0], p.size[1], p.size[2]};
  const std::int32_t index = p.index;
  const float* const ray_x = tile.ray_x;
  const float* const ray_y = tile.ray_y;
  float* const nearest = hits.z;
  std::int32_t* const indices = hits.index;
  for (int i = 0; i < RayGrid::kTilePixels; ++i) {
    const float x = ray_x[i], y = ray_y[i];
    const LocalRay<float> ray{
        ox, oy, oz, r00 * x + r01 * y + r02, r10 * x + r11 * y + r12, r20 * x + r21 * y + r22};
    const float t = IntersectShape<shape, float>(ray, size);
    const float z_before = nearest[i];
    const std::int32_t index_before = indices[i];
    nearest[i] = t < z_before ? t : z_before;
    indices[i] = t < z_before ? index : index_before;
  }
  hits.farthest = Largest(nearest);
}

void TraceAny(Shape shape, const TileTarget& target, const RayGrid::Tile& tile, TileHits& hits) {
  switch (shape) {
    case Shape::kBox:
      return TraceShape<Shape::kBox>(target, tile, hits);
    case Shape::kRectangle:
      return TraceShape<Shape::kRectangle>(target, tile, hits);
    case Shape::kSphere:
      return TraceShape<Shape::kSphere>(target, tile, hits);
    case Shape::kCylinder:
      return TraceShape<Shape::kCylinder>(target, tile, hits);
    case Shape::kTube:
      return TraceShape<Shape::kTube>(target, tile, hits);
    case Shape::kDisc:
      return TraceShape<Shape::kDisc>(target, tile, hits);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace isotherm
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(TraceAny);

void TraceTile(Shape shape, const TileTarget& target, const RayGrid::Tile& tile, TileHits& hits) {
  HWY_DYNAMIC_DISPATCH(TraceAny)(shape, target, tile, hits);
}

}  // namespace isotherm
#endif  // HWY_ONCE
