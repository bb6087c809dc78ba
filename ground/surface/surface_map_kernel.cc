// One row of vertex and normal maps in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/surface/surface_map_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <algorithm>
#include <limits>

#include "ground/surface/surface_map_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// Largest difference of the steps to either side of a pixel on one surface, as a fraction of both
/// together; 1 would be a step on one side only.
constexpr float kMaxBend = 0.3F;

/// Fills pixels [begin, end) of a row with "no surface".
void ClearPixels(SurfaceMaps& maps, int y, int begin, int end) {
  for (Image<float>* plane : {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz}) {
    std::fill(plane->Row(y).begin() + begin, plane->Row(y).begin() + end,
              std::numeric_limits<float>::quiet_NaN());
  }
}

/// Depths of pixels and of those `reach` away from them.
struct Cross {
  VF centre, left, right, up, down;
};

/// Returns whether a pixel and the four around it lie on one surface.
HWY_INLINE MF OnOneSurface(const SurfaceMapArgs& a, const Cross& depth) {
  const VF z = depth.centre;
  // A pixel without a return is as far away as the depth: no neighbour of any surface.
  const VF limit = hn::Mul(z, hn::Set(d, std::min(a.max_step, 1.0F)));
  const auto near = [&](VF neighbour) { return hn::Lt(hn::Abs(hn::Sub(neighbour, z)), limit); };
  // A slope steps on both sides alike; a step on one side only is an edge, where differences
  // would give the normal of a bridge across it.
  const VF noise = hn::Mul(hn::Set(d, a.noise_at_1m), hn::Mul(z, z));
  const auto even = [&](VF before, VF after) {
    const VF bend = hn::Abs(hn::Sub(hn::Add(before, after), hn::Add(z, z)));
    const VF slope = hn::Abs(hn::Sub(after, before));
    return hn::Le(bend, hn::MulAdd(hn::Set(d, kMaxBend), slope, noise));
  };
  return hn::And(hn::And(hn::And(near(depth.left), near(depth.right)),
                         hn::And(near(depth.up), near(depth.down))),
                 hn::And(even(depth.left, depth.right), even(depth.up, depth.down)));
}

/// Normals, not normalised, and their squared lengths.
struct Normals {
  VF x, y, z, squared;
};

/// Returns b x a of the differences along the row and the column, which points towards the camera
/// (x right, y down, z forward).
HWY_INLINE Normals CrossProduct(VF ax, VF ay, VF az, VF bx, VF by, VF bz) {
  const VF nx = hn::Sub(hn::Mul(by, az), hn::Mul(bz, ay));
  const VF ny = hn::Sub(hn::Mul(bz, ax), hn::Mul(bx, az));
  const VF nz = hn::Sub(hn::Mul(bx, ay), hn::Mul(by, ax));
  return {nx, ny, nz, hn::MulAdd(nx, nx, hn::MulAdd(ny, ny, hn::Mul(nz, nz)))};
}

// Makes a row of vertices and normals of a depth image: vertex = depth * ray, normal = normalised
// cross product of the differences of the vertices `reach` pixels below and above, right and left.
// NaN unless the five pixels lie on one surface.
// Rows: three image rows of depth; six planes of maps, one pixel per lane. Fast: vertices of
// neighbours are never stored; a ray is one multiplication; the row's end is done by a vector that
// overlaps the one before.
void SurfaceMapRow(const SurfaceMapArgs& a, int y, SurfaceMaps& maps) {
  const int width = a.depth_m->width();
  const int height = a.depth_m->height();
  const int reach = a.reach;
  if (y < reach || y + reach >= height || width <= 2 * reach) {
    ClearPixels(maps, y, 0, width);
    return;
  }
  ClearPixels(maps, y, 0, reach);
  ClearPixels(maps, y, width - reach, width);
  const float* centre_row = a.depth_m->Row(y).data();
  const float* upper_row = a.depth_m->Row(y - reach).data();
  const float* lower_row = a.depth_m->Row(y + reach).data();
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const VF inverse_fx = hn::Set(d, 1.0F / a.fx);
  const auto ray_y = [&](int row) { return hn::Set(d, (static_cast<float>(row) - a.cy) / a.fy); };
  const VF ray_y_centre = ray_y(y);
  const VF ray_y_upper = ray_y(y - reach);
  const VF ray_y_lower = ray_y(y + reach);
  const int end = width - reach;
  if (end - reach < lanes) {  // Too narrow for a vector: no surface; no camera is that small.
    ClearPixels(maps, y, 0, width);
    return;
  }
  for (int start = reach; start < end; start += lanes) {
    const int x = std::min(start, end - lanes);  // The last vector overlaps the one before.
    const auto ray_x = [&](int offset) {
      const VF column = hn::Add(hn::Iota(d, static_cast<float>(x)),
                                hn::Set(d, static_cast<float>(offset) - a.cx));
      return hn::Mul(column, inverse_fx);
    };
    const Cross depth = {hn::LoadU(d, centre_row + x), hn::LoadU(d, centre_row + x - reach),
                         hn::LoadU(d, centre_row + x + reach), hn::LoadU(d, upper_row + x),
                         hn::LoadU(d, lower_row + x)};
    const MF smooth = OnOneSurface(a, depth);

    const VF rx = ray_x(0);
    // Differences of the neighbours' vertices.
    const VF ax = hn::Sub(hn::Mul(ray_x(reach), depth.right), hn::Mul(ray_x(-reach), depth.left));
    const VF az = hn::Sub(depth.right, depth.left);
    const VF ay = hn::Mul(ray_y_centre, az);
    const VF bz = hn::Sub(depth.down, depth.up);
    const VF bx = hn::Mul(rx, bz);
    const VF by = hn::Sub(hn::Mul(ray_y_lower, depth.down), hn::Mul(ray_y_upper, depth.up));
    const Normals n = CrossProduct(ax, ay, az, bx, by, bz);
    const auto good = hn::And(smooth, hn::Gt(n.squared, hn::Zero(d)));
    const VF scale = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(n.squared));
    const auto store = [&](Image<float>& plane, VF value) {
      hn::StoreU(hn::IfThenElse(good, value, none), d, plane.Row(y).data() + x);
    };
    store(maps.vx, hn::Mul(rx, depth.centre));
    store(maps.vy, hn::Mul(ray_y_centre, depth.centre));
    store(maps.vz, depth.centre);
    store(maps.nx, hn::Mul(n.x, scale));
    store(maps.ny, hn::Mul(n.y, scale));
    store(maps.nz, hn::Mul(n.z, scale));
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(SurfaceMapRow);

void SurfaceMapRow(const SurfaceMapArgs& args, int y, SurfaceMaps& maps) {
  HWY_DYNAMIC_DISPATCH(SurfaceMapRow)(args, y, maps);
}

}  // namespace isotherm
#endif  // HWY_ONCE
