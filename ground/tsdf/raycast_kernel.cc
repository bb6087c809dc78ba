// A tile of rays through the sparse volume, in SIMD lanes of 4 x n pixels. Compiled once per
// instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/raycast_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <limits>

#include "ground/surface/block_layout.h"
#include "ground/tsdf/raycast_kernel.h"
#include "ground/tsdf/tsdf_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// Lanes are 4 pixels wide (1 where there is but one lane) and as many rows high as fit.
constexpr int kLaneColumnsLog2 = hn::MaxLanes(d) >= 4 ? 2 : 0;
constexpr int kLaneColumns = 1 << kLaneColumnsLog2;

/// At grazing incidence the interpolated surface can lie a few voxels along the ray beside the
/// nearest voxels' change of sign.
constexpr float kMaxStepVox = 3.0F;
/// A step below this leaves an error of second order.
constexpr float kConvergedVox = 0.1F;

/// Rays origin + depth * direction, depth along the camera's z in voxels.
struct Rays {
  Vector3 direction;
  Vector3 inverse;
  VF length;  ///< Length of direction.
  const float* origin;

  HWY_INLINE Vector3 At(VF depth) const {
    return {hn::MulAdd(depth, direction.x, hn::Set(d, origin[0])),
            hn::MulAdd(depth, direction.y, hn::Set(d, origin[1])),
            hn::MulAdd(depth, direction.z, hn::Set(d, origin[2]))};
  }
};

/// Never 0, so that a ray parallel to an axis leaves through it infinitely late instead of at NaN.
HWY_INLINE VF NotZero(VF direction) {
  const VF least = hn::Set(d, 1e-8F);
  return hn::IfThenElse(hn::Lt(hn::Abs(direction), least), least, direction);
}

/// Keeps [start, end] inside the volume along one axis.
HWY_INLINE void ClipToAxis(float low, float high, float origin, VF inverse, VF& start, VF& end) {
  const VF t0 = hn::Mul(hn::Set(d, low - origin), inverse);
  const VF t1 = hn::Mul(hn::Set(d, high - origin), inverse);
  start = hn::Max(start, hn::Min(t0, t1));
  end = hn::Min(end, hn::Max(t0, t1));
}

/// Depth at which the ray leaves the block of `b` along one axis.
HWY_INLINE VF AxisExit(VI b, float origin, VF direction, VF inverse) {
  const VF low = hn::Sub(hn::ConvertTo(d, hn::ShiftLeft<BlockLayout::kSideBits>(b)),
                         hn::Set(d, 0.5F + origin));
  const VF face = hn::IfThenElse(hn::Ge(direction, hn::Zero(d)),
                                 hn::Add(low, hn::Set(d, static_cast<float>(kBlockSide))), low);
  return hn::Mul(face, inverse);
}

struct Crossing {
  VF depth;  ///< Depth of the zero crossing, between the nearest voxels' distances.
  MF found;
};

/// Marches until the nearest voxel's distance changes from positive to negative.
class March {
 public:
  HWY_INLINE March(const RaycastKernelArgs& a, const Rays& rays, VF start, VF end)
      : rays_(rays),
        end_(end),
        voxel_step_(hn::Div(hn::Set(d, 1.0F), rays.length)),
        safe_step_(hn::Mul(voxel_step_, hn::Set(d, 0.8F * a.truncation_vox))),
        depth_(start),
        previous_depth_(hn::Zero(d)),
        previous_(hn::Zero(d)),
        crossing_(hn::Zero(d)),
        found_(hn::MaskFromVec(hn::Zero(d))),
        active_(hn::Lt(start, end)) {}

  HWY_INLINE bool done() const { return hn::AllFalse(d, active_); }
  HWY_INLINE Crossing crossing() const { return {crossing_, found_}; }

  HWY_INLINE void Step(const RaycastKernelArgs& a) {
    const VF zero = hn::Zero(d);
    const VF half = hn::Set(d, 0.5F);
    const Vector3 p = rays_.At(depth_);
    const VI x = ToVoxel(hn::Add(p.x, half), a.last[0]);
    const VI y = ToVoxel(hn::Add(p.y, half), a.last[1]);
    const VI z = ToVoxel(hn::Add(p.z, half), a.last[2]);
    const VI bx = BlockOf(x);
    const VI by = BlockOf(y);
    const VI bz = BlockOf(z);
    const VI entry = hn::Add(
        bx, hn::Add(hn::Mul(by, hn::Set(di, a.stride_y)), hn::Mul(bz, hn::Set(di, a.stride_z))));
    const VI block = hn::GatherIndex(di, a.table, entry);
    const VI local = hn::Or(LocalPart(0, x), hn::Or(LocalPart(1, y), LocalPart(2, z)));
    const VI word = hn::GatherIndex(di, a.voxels, hn::Add(FirstElement(block), local));
    const MF in_block = hn::RebindMask(d, hn::Gt(block, hn::Set(di, -1)));
    const MF observed = hn::RebindMask(d, Observed(a, word));
    const VF value = DecodeTsdf(word);
    const MF behind = hn::And(active_, hn::And(observed, hn::Le(value, zero)));
    const MF hit = hn::And(behind, hn::Gt(previous_, zero));
    const VF at_crossing =
        hn::Div(previous_, hn::Max(hn::Sub(previous_, value), hn::Set(d, 1e-9F)));
    crossing_ = hn::IfThenElse(
        hit, hn::MulAdd(at_crossing, hn::Sub(depth_, previous_depth_), previous_depth_), crossing_);
    found_ = hn::Or(found_, hit);
    // A surface entered from behind (or whose front was never observed) hides what lies beyond it.
    active_ = hn::AndNot(behind, active_);

    previous_ = hn::IfThenElse(observed, value, hn::IfThenElseZero(in_block, previous_));
    previous_depth_ = hn::IfThenElse(observed, depth_, previous_depth_);
    const VF free_step = hn::Max(voxel_step_, hn::Mul(safe_step_, value));
    VF next = hn::Add(depth_, hn::IfThenElse(observed, free_step, voxel_step_));
    if (!hn::AllFalse(d, hn::AndNot(in_block, active_))) {
      VF exit = AxisExit(bx, a.origin[0], rays_.direction.x, rays_.inverse.x);
      exit = hn::Min(exit, AxisExit(by, a.origin[1], rays_.direction.y, rays_.inverse.y));
      exit = hn::Min(exit, AxisExit(bz, a.origin[2], rays_.direction.z, rays_.inverse.z));
      exit = hn::MulAdd(voxel_step_, hn::Set(d, 0.01F), hn::Max(exit, depth_));
      next = hn::IfThenElse(in_block, next, exit);
    }
    depth_ = next;
    active_ = hn::And(active_, hn::Lt(depth_, end_));
  }

 private:
  const Rays& rays_;
  const VF end_;
  const VF voxel_step_;
  const VF safe_step_;  ///< Where the distance is 1.
  VF depth_;
  VF previous_depth_;  ///< Depth and value of the last observed voxel,
  VF previous_;        ///< and its distance. Not positive: no crossing can start there.
  VF crossing_;
  MF found_;
  MF active_;
};

/// Rays of 4 x n pixels, and how far they go.
struct Bundle {
  Rays rays;
  VF start, end;

  HWY_INLINE Bundle(const RaycastKernelArgs& a, int x, int y, int width, int height, float near_vox,
                    float far_vox) {
    const VF one = hn::Set(d, 1.0F);
    const VI lane = hn::Iota(di, 0);
    const VF column = hn::Add(hn::ConvertTo(d, hn::And(lane, hn::Set(di, kLaneColumns - 1))),
                              hn::Set(d, static_cast<float>(x)));
    const VF row = hn::Add(hn::ConvertTo(d, hn::ShiftRight<kLaneColumnsLog2>(lane)),
                           hn::Set(d, static_cast<float>(y)));
    const MF in_image = hn::And(hn::Lt(column, hn::Set(d, static_cast<float>(width))),
                                hn::Lt(row, hn::Set(d, static_cast<float>(height))));
    const VF u = hn::Mul(hn::Sub(column, hn::Set(d, a.cx)), hn::Set(d, 1.0F / a.fx));
    const VF v = hn::Mul(hn::Sub(row, hn::Set(d, a.cy)), hn::Set(d, 1.0F / a.fy));
    const auto rotate = [&](int i) {
      return NotZero(
          hn::MulAdd(hn::Set(d, a.R[3 * i]), u,
                     hn::MulAdd(hn::Set(d, a.R[3 * i + 1]), v, hn::Set(d, a.R[3 * i + 2]))));
    };
    rays.origin = a.origin;
    rays.direction = {rotate(0), rotate(1), rotate(2)};
    rays.inverse = {hn::Div(one, rays.direction.x), hn::Div(one, rays.direction.y),
                    hn::Div(one, rays.direction.z)};
    rays.length = hn::Sqrt(hn::MulAdd(u, u, hn::MulAdd(v, v, one)));
    start = hn::Set(d, near_vox);
    end = hn::IfThenElse(in_image, hn::Set(d, far_vox), start);
    ClipToAxis(a.low, a.high[0], a.origin[0], rays.inverse.x, start, end);
    ClipToAxis(a.low, a.high[1], a.origin[1], rays.inverse.y, start, end);
    ClipToAxis(a.low, a.high[2], a.origin[2], rays.inverse.z, start, end);
  }
};

struct Surface {
  VF depth;
  Vector3 gradient;
  MF valid;
};

/// Finds the zero crossing of the interpolated distance near the change of sign by Newton steps
/// along the ray.
HWY_INLINE Surface Refine(const RaycastKernelArgs& a, const Bundle& bundle,
                          const Crossing& crossing) {
  const VF zero = hn::Zero(d);
  const Rays& rays = bundle.rays;
  const VF voxel_step = hn::Div(hn::Set(d, 1.0F), rays.length);
  const VF max_step = hn::Mul(voxel_step, hn::Set(d, kMaxStepVox));
  const VF converged = hn::Mul(voxel_step, hn::Set(d, kConvergedVox));
  Surface surface{hn::IfThenElse(crossing.found, crossing.depth, bundle.start),
                  {zero, zero, zero},
                  crossing.found};
  if (hn::AllFalse(d, crossing.found)) return surface;
  for (int i = 0; i < a.max_refinements; ++i) {
    surface.depth = hn::Min(hn::Max(surface.depth, bundle.start), bundle.end);
    const Interpolated f = Interpolate(a, rays.At(surface.depth));
    const VF slope = Dot(f.gradient, rays.direction);
    const MF facing = hn::Lt(slope, hn::Set(d, -1e-6F));
    const VF newton = hn::Div(f.value, hn::Neg(hn::IfThenElse(facing, slope, hn::Set(d, -1.0F))));
    const VF step = hn::Max(hn::Min(newton, max_step), hn::Neg(max_step));
    surface.gradient = f.gradient;
    surface.valid = hn::And(
        hn::And(crossing.found, f.valid),
        hn::And(facing,
                hn::Lt(hn::Abs(newton), hn::Mul(voxel_step, hn::Set(d, a.max_last_step_vox)))));
    surface.depth = hn::Add(surface.depth, step);
    // Lanes whose cell is not observed cannot get better.
    const MF open = hn::And(hn::And(crossing.found, f.valid), hn::Gt(hn::Abs(step), converged));
    if (hn::AllFalse(d, open)) break;
  }
  return surface;
}

/// Writes what the rays of a bundle met to all planes.
HWY_INLINE void WriteSurface(const RaycastKernelArgs& a, const Rays& rays, const Surface& surface,
                             int x, int y, SurfaceMaps& maps) {
  constexpr int kMaxRows = static_cast<int>(hn::MaxLanes(d)) / kLaneColumns;
  const int lane_rows = static_cast<int>(hn::Lanes(d)) / kLaneColumns;
  const VF one = hn::Set(d, 1.0F);
  const VF least = hn::Set(d, 1e-12F);
  const VF none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const VF squared = Dot(surface.gradient, surface.gradient);
  const MF valid = hn::And(surface.valid, hn::Gt(squared, least));
  const VF scale = hn::Div(one, hn::Sqrt(hn::Max(squared, least)));
  const VF metres = hn::Mul(surface.depth, hn::Set(d, a.voxel_m));
  const VF planes[6] = {hn::MulAdd(metres, rays.direction.x, hn::Set(d, a.map_origin[0])),
                        hn::MulAdd(metres, rays.direction.y, hn::Set(d, a.map_origin[1])),
                        hn::MulAdd(metres, rays.direction.z, hn::Set(d, a.map_origin[2])),
                        hn::Mul(surface.gradient.x, scale),
                        hn::Mul(surface.gradient.y, scale),
                        hn::Mul(surface.gradient.z, scale)};
  Image<float>* const targets[6] = {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz};
  const int rows = maps.height() - y < lane_rows ? maps.height() - y : lane_rows;
  const int columns = maps.width() - x < kLaneColumns ? maps.width() - x : kLaneColumns;
  HWY_ALIGN float out[kMaxRows * kLaneColumns];
  for (int k = 0; k < 6; ++k) {
    hn::Store(hn::IfThenElse(valid, planes[k], none), d, out);
    for (int r = 0; r < rows; ++r) {
      float* target = targets[k]->Row(y + r).data() + x;
      for (int i = 0; i < columns; ++i) target[i] = out[r * kLaneColumns + i];
    }
  }
}

// Casts the rays of a tile of 8 x 8 pixels through the volume (algorithm 3). March goes along a ray
// by 0.8 of the distance read in the nearest voxel, by a voxel where nothing was observed and by a
// block where there is none, until the distance turns from positive to negative. Refine goes from
// there to the zero of the trilinearly interpolated distance by Newton steps; its gradient is the
// normal. A change from negative to positive ends the ray: what is met from behind hides the rest.
// Rows: lanes are 4 columns by n rows of pixels, whose rays stay close and read the same blocks.
// Fast: steps are long in free space; the table's border and block -1 spare all bounds checks; four
// bundles wait for memory together.
void RaycastTile(const RaycastKernelArgs& a, int tile_x, int tile_y, float near_vox, float far_vox,
                 SurfaceMaps& maps) {
  constexpr int kColumns = kRaycastTile / kLaneColumns;  // Of bundles.
  const int lane_rows = static_cast<int>(hn::Lanes(d)) / kLaneColumns;
  const int bundles = kColumns * (kRaycastTile / lane_rows);
  for (int first = 0; first < bundles; first += 4) {
    const auto x = [&](int i) { return tile_x + (first + i) % kColumns * kLaneColumns; };
    const auto y = [&](int i) { return tile_y + (first + i) / kColumns * lane_rows; };
    const auto bundle = [&](int i) {
      return Bundle(a, x(i), y(i), maps.width(), maps.height(), near_vox, far_vox);
    };
    // Marching waits for memory most of the time: bundles side by side wait together.
    const Bundle bundle_of[] = {bundle(0), bundle(1), bundle(2), bundle(3)};
    const auto march = [&](int i) {
      return March(a, bundle_of[i].rays, bundle_of[i].start, bundle_of[i].end);
    };
    March marches[] = {march(0), march(1), march(2), march(3)};
    while (!marches[0].done() || !marches[1].done() || !marches[2].done() || !marches[3].done()) {
      for (March& one : marches) one.Step(a);
    }
    for (int i = 0; i < 4; ++i) {
      if (x(i) >= maps.width() || y(i) >= maps.height()) continue;
      WriteSurface(a, bundle_of[i].rays, Refine(a, bundle_of[i], marches[i].crossing()), x(i), y(i),
                   maps);
    }
  }
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(RaycastTile);

void RaycastTile(const RaycastKernelArgs& args, int x, int y, float near_vox, float far_vox,
                 SurfaceMaps& maps) {
  HWY_DYNAMIC_DISPATCH(RaycastTile)(args, x, y, near_vox, far_vox, maps);
}

}  // namespace isotherm
#endif  // HWY_ONCE
