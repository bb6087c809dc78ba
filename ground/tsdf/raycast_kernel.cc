// One row of rays through the sparse volume, in SIMD lanes along x. Compiled once per instruction
// set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/raycast_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include <limits>

#include "ground/tsdf/raycast_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using VF = hn::Vec<D>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<D>;
using MI = hn::Mask<DI>;

constexpr D d;
constexpr DI di;

/// The interpolated surface can lie this many voxels along the ray beside the nearest voxels'
/// change of sign, at grazing incidence.
constexpr int kMaxShifts = 3;

struct Point {
  VF x, y, z;
};

/// tsdf in [-1, 1] from a voxel word; the scale is TsdfVoxel::kTsdfScale.
HWY_INLINE VF DecodeTsdf(VI word) {
  return hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(word)), hn::Set(d, 1.0F / 32767.0F));
}

struct Lookup {
  VI index;  ///< First voxel of the block; 0 where there is none.
  MI found;
};

HWY_INLINE Lookup FindBlock(const RaycastKernelArgs& a, VI bx, VI by, VI bz) {
  const VI minus_one = hn::Set(di, -1);
  MI inside = hn::And(hn::And(hn::Gt(bx, minus_one), hn::Lt(bx, hn::Set(di, a.blocks_x))),
                      hn::And(hn::Gt(by, minus_one), hn::Lt(by, hn::Set(di, a.blocks_y))));
  inside = hn::And(inside, hn::And(hn::Gt(bz, minus_one), hn::Lt(bz, hn::Set(di, a.blocks_z))));
  const VI entry = hn::Add(
      bx, hn::Mul(hn::Set(di, a.blocks_x), hn::Add(by, hn::Mul(hn::Set(di, a.blocks_y), bz))));
  const VI block = hn::GatherIndex(di, a.table, hn::IfThenElseZero(inside, entry));
  const MI found = hn::And(inside, hn::Gt(block, minus_one));
  return {hn::IfThenElseZero(found, hn::ShiftLeft<9>(block)), found};
}

HWY_INLINE VI LocalIndex(VI x, VI y, VI z) {
  const VI seven = hn::Set(di, 7);
  return hn::Or(hn::And(x, seven),
                hn::Or(hn::ShiftLeft<3>(hn::And(y, seven)), hn::ShiftLeft<6>(hn::And(z, seven))));
}

HWY_INLINE MI Observed(const RaycastKernelArgs& a, VI word) {
  return hn::Gt(hn::And(word, hn::Set(di, 0xFFFF)), hn::Set(di, a.min_weight_code - 1));
}

HWY_INLINE VI FloorToInt(VF v) { return hn::ConvertTo(di, hn::Floor(v)); }

struct Interpolated {
  VF value;
  Point gradient;  ///< Per voxel.
  MF valid;        ///< All eight voxels around were observed.
};

/// Trilinear interpolation of the distance and its gradient within the cell.
HWY_INLINE Interpolated Interpolate(const RaycastKernelArgs& a, const Point& p) {
  const VF lx = hn::Floor(p.x);
  const VF ly = hn::Floor(p.y);
  const VF lz = hn::Floor(p.z);
  const VI x0 = hn::ConvertTo(di, lx);
  const VI y0 = hn::ConvertTo(di, ly);
  const VI z0 = hn::ConvertTo(di, lz);
  const VI one = hn::Set(di, 1);
  MI valid = hn::Eq(one, one);
  VF corner[8];
  for (int k = 0; k < 8; ++k) {
    const VI x = (k & 1) != 0 ? hn::Add(x0, one) : x0;
    const VI y = (k & 2) != 0 ? hn::Add(y0, one) : y0;
    const VI z = (k & 4) != 0 ? hn::Add(z0, one) : z0;
    const Lookup block =
        FindBlock(a, hn::ShiftRight<3>(x), hn::ShiftRight<3>(y), hn::ShiftRight<3>(z));
    const VI word = hn::GatherIndex(di, a.voxels, hn::Add(block.index, LocalIndex(x, y, z)));
    valid = hn::And(valid, hn::And(block.found, Observed(a, word)));
    corner[k] = DecodeTsdf(word);
  }
  const VF fx = hn::Sub(p.x, lx);
  const VF fy = hn::Sub(p.y, ly);
  const VF fz = hn::Sub(p.z, lz);
  const auto lerp = [](VF from, VF to, VF f) { return hn::MulAdd(f, hn::Sub(to, from), from); };
  const VF x00 = lerp(corner[0], corner[1], fx);
  const VF x10 = lerp(corner[2], corner[3], fx);
  const VF x01 = lerp(corner[4], corner[5], fx);
  const VF x11 = lerp(corner[6], corner[7], fx);
  const VF near = lerp(x00, x10, fy);
  const VF far = lerp(x01, x11, fy);
  Interpolated result;
  result.value = lerp(near, far, fz);
  result.gradient.x =
      lerp(lerp(hn::Sub(corner[1], corner[0]), hn::Sub(corner[3], corner[2]), fy),
           lerp(hn::Sub(corner[5], corner[4]), hn::Sub(corner[7], corner[6]), fy), fz);
  result.gradient.y = lerp(hn::Sub(x10, x00), hn::Sub(x11, x01), fz);
  result.gradient.z = hn::Sub(far, near);
  result.valid = hn::RebindMask(d, valid);
  return result;
}

/// Rays origin + depth * direction, depth along the camera's z in voxels.
struct Rays {
  Point direction;
  Point inverse;
  VF length;  ///< Of direction.
  const float* origin;

  HWY_INLINE Point At(VF depth) const {
    return {hn::MulAdd(depth, direction.x, hn::Set(d, origin[0])),
            hn::MulAdd(depth, direction.y, hn::Set(d, origin[1])),
            hn::MulAdd(depth, direction.z, hn::Set(d, origin[2]))};
  }
};

/// Depth at which the ray leaves the block of `b` along one axis.
HWY_INLINE VF AxisExit(VI b, VF origin, VF direction, VF inverse) {
  const VF low = hn::Sub(hn::ConvertTo(d, hn::ShiftLeft<3>(b)), hn::Set(d, 0.5F));
  const VF high = hn::Add(low, hn::Set(d, 8.0F));
  const VF face = hn::IfThenElse(hn::Ge(direction, hn::Zero(d)), high, low);
  const VF exit = hn::Mul(hn::Sub(face, origin), inverse);
  // A ray parallel to the axis never leaves through it.
  const VF never = hn::Set(d, 1e30F);
  return hn::IfThenElse(hn::Lt(hn::Abs(direction), hn::Set(d, 1e-8F)), never, exit);
}

struct Crossing {
  VF before, after;  ///< Depths around the zero crossing.
  MF found;
};

/// Marches until the nearest voxel's distance changes from positive to negative.
HWY_INLINE Crossing March(const RaycastKernelArgs& a, const Rays& rays, VF start, VF end) {
  const VF zero = hn::Zero(d);
  const VF voxel_step = hn::Div(hn::Set(d, 1.0F), rays.length);
  const VF safe_step = hn::Mul(voxel_step, hn::Set(d, 0.8F * a.truncation_vox));
  VF depth = start;
  VF previous_depth = zero;
  VF previous = zero;  // Not positive: no crossing can start here.
  Crossing crossing{zero, zero, hn::MaskFromVec(zero)};
  MF active = hn::Lt(start, end);
  while (!hn::AllFalse(d, active)) {
    const Point p = rays.At(depth);
    const VF half = hn::Set(d, 0.5F);
    const VI x = FloorToInt(hn::Add(p.x, half));
    const VI y = FloorToInt(hn::Add(p.y, half));
    const VI z = FloorToInt(hn::Add(p.z, half));
    const VI bx = hn::ShiftRight<3>(x);
    const VI by = hn::ShiftRight<3>(y);
    const VI bz = hn::ShiftRight<3>(z);
    const Lookup block = FindBlock(a, bx, by, bz);
    const VI word = hn::GatherIndex(di, a.voxels, hn::Add(block.index, LocalIndex(x, y, z)));
    const MF in_block = hn::RebindMask(d, block.found);
    const MF observed = hn::And(in_block, hn::RebindMask(d, Observed(a, word)));
    const VF value = DecodeTsdf(word);
    const MF behind = hn::And(active, hn::And(observed, hn::Le(value, zero)));
    const MF hit = hn::And(behind, hn::Gt(previous, zero));
    crossing.before = hn::IfThenElse(hit, previous_depth, crossing.before);
    crossing.after = hn::IfThenElse(hit, depth, crossing.after);
    crossing.found = hn::Or(crossing.found, hit);
    // A surface entered from behind (or whose front was never observed) hides what lies beyond it.
    active = hn::AndNot(behind, active);

    previous = hn::IfThenElse(observed, value, hn::IfThenElse(in_block, previous, zero));
    previous_depth = hn::IfThenElse(observed, depth, previous_depth);
    const VF free_step = hn::Max(voxel_step, hn::Mul(safe_step, value));
    VF next = hn::Add(depth, hn::IfThenElse(observed, free_step, voxel_step));
    if (!hn::AllTrue(d, in_block)) {
      VF exit = AxisExit(bx, hn::Set(d, a.origin[0]), rays.direction.x, rays.inverse.x);
      exit = hn::Min(exit, AxisExit(by, hn::Set(d, a.origin[1]), rays.direction.y, rays.inverse.y));
      exit = hn::Min(exit, AxisExit(bz, hn::Set(d, a.origin[2]), rays.direction.z, rays.inverse.z));
      exit = hn::Add(hn::Max(exit, depth), hn::Mul(voxel_step, hn::Set(d, 0.01F)));
      next = hn::IfThenElse(in_block, next, exit);
    }
    depth = next;
    active = hn::And(active, hn::Lt(depth, end));
  }
  return crossing;
}

void RaycastRow(const RaycastKernelArgs& a, int y, SurfaceMaps& maps) {
  const int width = maps.width();
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const VF zero = hn::Zero(d);
  const float* near_row = a.near_vox + (y / kRaycastTile) * a.tiles_per_row;
  const float* far_row = a.far_vox + (y / kRaycastTile) * a.tiles_per_row;
  HWY_ALIGN float out[6][hn::MaxLanes(d)];
  for (int x = 0; x < width; x += lanes) {
    // Lanes may span tiles: take each lane's own tile; lanes beyond the row do nothing.
    const VI column = hn::Iota(di, x);
    const VI tile = hn::Min(hn::ShiftRight<3>(column), hn::Set(di, a.tiles_per_row - 1));
    const VF start = hn::GatherIndex(d, near_row, tile);
    VF end = hn::GatherIndex(d, far_row, tile);
    end = hn::IfThenElse(hn::RebindMask(d, hn::Lt(column, hn::Set(di, width))), end, zero);

    Rays rays;
    rays.origin = a.origin;
    const VF u =
        hn::Mul(hn::Sub(hn::ConvertTo(d, column), hn::Set(d, a.cx)), hn::Set(d, 1.0F / a.fx));
    const float v = (static_cast<float>(y) - a.cy) / a.fy;
    const auto rotate = [&](int row) {
      return hn::MulAdd(hn::Set(d, a.R[3 * row]), u,
                        hn::Set(d, a.R[3 * row + 1] * v + a.R[3 * row + 2]));
    };
    rays.direction = {rotate(0), rotate(1), rotate(2)};
    const VF one = hn::Set(d, 1.0F);
    rays.inverse = {hn::Div(one, rays.direction.x), hn::Div(one, rays.direction.y),
                    hn::Div(one, rays.direction.z)};
    rays.length = hn::Sqrt(hn::MulAdd(u, u, hn::Set(d, 1.0F + v * v)));

    Crossing c = March(a, rays, start, end);
    VF depth = zero;
    Interpolated surface{zero, {zero, zero, zero}, hn::MaskFromVec(zero)};
    if (!hn::AllFalse(d, c.found)) {
      // Bracket the crossing of the interpolated distance, which can lie a little beside the
      // nearest voxel's.
      const VF step = hn::Div(one, rays.length);
      Interpolated f0 = Interpolate(a, rays.At(c.before));
      Interpolated f1 = Interpolate(a, rays.At(c.after));
      for (int shift = 0; shift < kMaxShifts; ++shift) {
        const MF late = hn::And(c.found, hn::Gt(f1.value, zero));
        const MF early = hn::AndNot(late, hn::And(c.found, hn::Le(f0.value, zero)));
        const MF moved = hn::Or(late, early);
        if (hn::AllFalse(d, moved)) break;
        const VF shifted = hn::IfThenElse(late, hn::Add(c.after, step), hn::Sub(c.before, step));
        const Interpolated fs = Interpolate(a, rays.At(shifted));
        const auto advance = [&](VF& before, VF& after, VF next) {
          const VF old_before = before;
          before = hn::IfThenElse(late, after, hn::IfThenElse(early, next, before));
          after = hn::IfThenElse(late, next, hn::IfThenElse(early, old_before, after));
        };
        advance(c.before, c.after, shifted);
        advance(f0.value, f1.value, fs.value);
        // What the bracket moves over must have been observed as well.
        f0.valid = hn::And(f0.valid, hn::Or(fs.valid, hn::Not(moved)));
        f1.valid = hn::And(f1.valid, hn::Or(fs.valid, hn::Not(moved)));
      }
      MF good = hn::And(c.found, hn::And(f0.valid, f1.valid));
      good = hn::And(good, hn::And(hn::Gt(f0.value, zero), hn::Le(f1.value, zero)));
      const auto secant = [&](VF t0, VF t1, VF v0, VF v1) {
        return hn::MulAdd(hn::Sub(t1, t0), hn::Div(v0, hn::Max(hn::Sub(v0, v1), hn::Set(d, 1e-9F))),
                          t0);
      };
      depth = secant(c.before, c.after, f0.value, f1.value);
      depth = hn::IfThenElse(good, depth, c.after);
      surface = Interpolate(a, rays.At(depth));
      // One more secant step; the gradient stays that of the point before, a fraction of a voxel
      // away.
      const MF in_front = hn::Gt(surface.value, zero);
      const VF refined = hn::IfThenElse(in_front, secant(depth, c.after, surface.value, f1.value),
                                        secant(c.before, depth, f0.value, surface.value));
      depth = hn::IfThenElse(surface.valid, refined, depth);
      surface.valid = hn::And(good, surface.valid);
    }
    const VF squared = hn::MulAdd(surface.gradient.x, surface.gradient.x,
                                  hn::MulAdd(surface.gradient.y, surface.gradient.y,
                                             hn::Mul(surface.gradient.z, surface.gradient.z)));
    const MF valid = hn::And(surface.valid, hn::Gt(squared, hn::Set(d, 1e-12F)));
    const VF scale = hn::Div(one, hn::Sqrt(hn::Max(squared, hn::Set(d, 1e-12F))));
    const VF none = hn::Set(d, nan);
    const VF metres = hn::Mul(depth, hn::Set(d, a.voxel_m));
    const VF planes[6] = {hn::MulAdd(metres, rays.direction.x, hn::Set(d, a.world_origin[0])),
                          hn::MulAdd(metres, rays.direction.y, hn::Set(d, a.world_origin[1])),
                          hn::MulAdd(metres, rays.direction.z, hn::Set(d, a.world_origin[2])),
                          hn::Mul(surface.gradient.x, scale),
                          hn::Mul(surface.gradient.y, scale),
                          hn::Mul(surface.gradient.z, scale)};
    float* targets[6] = {maps.vx.Row(y).data() + x, maps.vy.Row(y).data() + x,
                         maps.vz.Row(y).data() + x, maps.nx.Row(y).data() + x,
                         maps.ny.Row(y).data() + x, maps.nz.Row(y).data() + x};
    const int count = width - x < lanes ? width - x : lanes;
    for (int k = 0; k < 6; ++k) {
      const VF value = hn::IfThenElse(valid, planes[k], none);
      if (count == lanes) {
        hn::StoreU(value, d, targets[k]);
      } else {
        hn::Store(value, d, out[k]);
        for (int i = 0; i < count; ++i) targets[k][i] = out[k][i];
      }
    }
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(RaycastRow);

void RaycastRow(const RaycastKernelArgs& args, int y, SurfaceMaps& maps) {
  HWY_DYNAMIC_DISPATCH(RaycastRow)(args, y, maps);
}

}  // namespace isotherm
#endif  // HWY_ONCE
