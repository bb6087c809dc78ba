// Rows of the filters of a depth image in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/surface/filter_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include <algorithm>
#include <limits>

#include "common/frame/frame.h"
#include "ground/surface/filter_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

constexpr std::int32_t kSaturated = kNoDepthSaturated;

/// Pixel x of the row, with the neighbours that are inside the image.
float FilterPixel(const BilateralRowArgs& a, int x) {
  const int side = 2 * a.radius + 1;
  const float centre = a.rows[a.radius][x];
  if (!(centre > 0.0F)) return 0.0F;
  const float tau = std::min(a.tau_at_1m * centre * centre, centre);
  const float inverse = 1.0F / (tau * tau);
  float sum = 0.0F;
  float weights = 0.0F;
  for (int dy = 0; dy < side; ++dy) {
    if (a.rows[dy] == nullptr) continue;
    for (int dx = std::max(-a.radius, -x); dx <= std::min(a.radius, a.width - 1 - x); ++dx) {
      const float z = a.rows[dy][x + dx];
      const float falloff = std::max(0.0F, 1.0F - (z - centre) * (z - centre) * inverse);
      const float w = a.spatial[dy * side + dx + a.radius] * falloff * falloff;
      sum += w * z;
      weights += w;
    }
  }
  return sum / weights;
}

// Smooths depth along surfaces but not across edges: the mean of the window with weights
//   w = spatial[dy, dx] (1 - ((z - centre) / tau)^2)^2,   tau = tau_at_1m centre^2,
// 0 beyond tau (Tukey's biweight in place of a Gaussian of the difference). No return stays none.
// Rows: 2 radius + 1 image rows, nullptr outside the image; one pixel per lane. Fast: the biweight
// needs no exponential, and a pixel without return is beyond any tau, so nothing is masked.
void BilateralRow(const BilateralRowArgs& a, std::span<float> filtered) {
  const int side = 2 * a.radius + 1;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  int x = 0;
  for (; x < std::min(a.radius, a.width); ++x) filtered[x] = FilterPixel(a, x);
  // The last vector overlaps the one before.
  const int last = a.width - a.radius - lanes;
  for (int start = x; start < last + lanes && last >= x; start += lanes) {
    const int column = std::min(start, last);
    const VF centre = hn::LoadU(d, a.rows[a.radius] + column);
    const auto valid = hn::Gt(centre, zero);
    if (hn::AllFalse(d, valid)) {
      hn::StoreU(zero, d, filtered.data() + column);
      continue;
    }
    const VF tau = hn::Min(hn::Mul(hn::Set(d, a.tau_at_1m), hn::Mul(centre, centre)), centre);
    const VF inverse = hn::Div(one, hn::Max(tau, hn::Set(d, 1e-9F)));
    VF sum = zero;
    VF weights = zero;
    for (int dy = 0; dy < side; ++dy) {
      if (a.rows[dy] == nullptr) continue;
      const float* row = a.rows[dy] + column - a.radius;
      const float* spatial = a.spatial + dy * side;
      for (int dx = 0; dx < side; ++dx) {
        const VF z = hn::LoadU(d, row + dx);
        const VF difference = hn::Mul(hn::Sub(z, centre), inverse);
        const VF falloff = hn::Max(zero, hn::NegMulAdd(difference, difference, one));
        const VF w = hn::Mul(hn::Mul(falloff, falloff), hn::Set(d, spatial[dx]));
        sum = hn::MulAdd(w, z, sum);
        weights = hn::Add(weights, w);
      }
    }
    const VF mean = hn::Div(sum, hn::Max(weights, hn::Set(d, 1e-9F)));
    hn::StoreU(hn::IfThenElseZero(valid, mean), d, filtered.data() + column);
  }
  if (last >= x) x = last + lanes;
  for (; x < a.width; ++x) filtered[x] = FilterPixel(a, x);
}

// Raw depth to metres: raw * metres_per_unit within the limits, else 0; counts what is valid.
// Rows: 16-bit raw, one pixel per lane. Fast: no branch per pixel; bound by memory.
int MetresRow(const MetresRowArgs& a, std::span<float> depth_m) {
  const hn::Rebind<std::uint16_t, D> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int width = static_cast<int>(depth_m.size());
  std::size_t valid = 0;
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    const auto raw = hn::PromoteTo(di, hn::LoadU(d16, a.raw + x));
    const VF depth = hn::Mul(hn::ConvertTo(d, raw), hn::Set(d, a.metres_per_unit));
    auto good =
        hn::And(hn::Ge(depth, hn::Set(d, a.min_depth_m)), hn::Le(depth, hn::Set(d, a.max_depth_m)));
    good = hn::And(good, hn::RebindMask(d, hn::And(hn::Gt(raw, hn::Zero(di)),
                                                   hn::Lt(raw, hn::Set(di, kSaturated)))));
    hn::StoreU(hn::IfThenElseZero(good, depth), d, depth_m.data() + x);
    valid += hn::CountTrue(d, good);
  }
  for (; x < width; ++x) {
    const float depth = static_cast<float>(a.raw[x]) * a.metres_per_unit;
    const bool good =
        a.raw[x] != 0 && a.raw[x] != kSaturated && depth >= a.min_depth_m && depth <= a.max_depth_m;
    depth_m[x] = good ? depth : 0.0F;
    valid += good ? 1 : 0;
  }
  return static_cast<int>(valid);
}

// Counts pixels with a depth, and those beside a gap.
// Rows: two image rows, one pixel per lane; the last of a row has no right neighbour and is not
// counted. Fast: three loads and two counts for a vector; bound by memory.
GapCount CountGaps(const float* row, const float* below, int width) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  std::size_t pixels = 0;
  std::size_t beside_gap = 0;
  int x = 0;
  for (; x + lanes < width; x += lanes) {
    const MF seen = hn::Gt(hn::LoadU(d, row + x), zero);
    const MF complete =
        hn::And(hn::Gt(hn::LoadU(d, row + x + 1), zero), hn::Gt(hn::LoadU(d, below + x), zero));
    pixels += hn::CountTrue(d, seen);
    beside_gap += hn::CountTrue(d, hn::AndNot(complete, seen));
  }
  for (; x + 1 < width; ++x) {
    const bool seen = row[x] > 0.0F;
    pixels += seen ? 1 : 0;
    beside_gap += seen && !(row[x + 1] > 0.0F && below[x] > 0.0F) ? 1 : 0;
  }
  return {static_cast<int>(pixels), static_cast<int>(beside_gap)};
}

/// Sums over the depths z around pixels, with r = z / nearest and e = 1 - r, of one surface.
struct PlaneSums {
  VF S, Sx, Sy, Sxx, Sxy, Syy;  ///< Sums of r r, times offsets in pixels.
  VF T, Tx, Ty;                 ///< Sums of r e, times offsets.
  VF ee;

  HWY_INLINE PlaneSums()
      : S(hn::Zero(d)), Sx(S), Sy(S), Sxx(S), Sxy(S), Syy(S), T(S), Tx(S), Ty(S), ee(S) {}
};

/// A plane may fill a pixel within these limits; lengths are in pixels over the radius.
constexpr float kMinFillPixels = 4.5F;  ///< Sum of r r, which is hardly above 1 each.
/// The depths must lie around the pixel: the middle of a surface's outermost two columns, seen from
/// one pixel beside it, is 0.75 away.
constexpr float kMaxFillOffset = 0.7F;
/// Smallest scatter of their positions, square pixels over the radius squared: no line.
constexpr float kMinFillScatter = 0.5F;
/// Largest root mean square distance from the plane in standard deviations of the noise. An edge
/// leaves a sixth of its height; with half as much again, bridges across edges double the error of
/// the pose, with less, noise is taken for edges.
constexpr float kMaxFillNoise = 1.3F;

/// The least depth around pixels that is none of their own; infinity if there is none.
HWY_INLINE VF NearestAround(const FillRowArgs& a, int x) {
  const VF zero = hn::Zero(d);
  const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  VF nearest = infinity;
  for (int dy = 0; dy <= 2 * a.radius; ++dy) {
    if (a.rows[dy] == nullptr) continue;
    for (int dx = -a.radius; dx <= a.radius; ++dx) {
      const VF z = hn::LoadU(d, a.rows[dy] + x + dx);
      nearest = hn::Min(nearest, hn::IfThenElse(hn::Gt(z, zero), z, infinity));
    }
  }
  return nearest;
}

HWY_INLINE PlaneSums SumAround(const FillRowArgs& a, int x, VF nearest) {
  const VF one = hn::Set(d, 1.0F);
  const VF inverse = hn::Div(one, nearest);
  const VF lowest = hn::Neg(hn::Set(d, a.max_step_ratio));
  PlaneSums sums;
  for (int row = 0; row <= 2 * a.radius; ++row) {
    if (a.rows[row] == nullptr) continue;
    VF S = hn::Zero(d), Sx = S, Sxx = S, T = S, Tx = S;
    for (int column = -a.radius; column <= a.radius; ++column) {
      const VF dx = hn::Set(d, static_cast<float>(column));
      const VF ratio = hn::Mul(hn::LoadU(d, a.rows[row] + x + column), inverse);
      const VF difference = hn::Sub(one, ratio);
      const MF used = hn::And(hn::Gt(ratio, hn::Zero(d)), hn::Ge(difference, lowest));
      const VF r = hn::IfThenElseZero(used, ratio);
      const VF e = hn::IfThenElseZero(used, difference);
      const VF rr = hn::Mul(r, r);
      const VF re = hn::Mul(r, e);
      const VF rr_x = hn::Mul(rr, dx);
      S = hn::Add(S, rr);
      Sx = hn::Add(Sx, rr_x);
      Sxx = hn::MulAdd(rr_x, dx, Sxx);
      T = hn::Add(T, re);
      Tx = hn::MulAdd(re, dx, Tx);
      sums.ee = hn::MulAdd(e, e, sums.ee);
    }
    const VF dy = hn::Set(d, static_cast<float>(row - a.radius));
    sums.S = hn::Add(sums.S, S);
    sums.Sx = hn::Add(sums.Sx, Sx);
    sums.Sxx = hn::Add(sums.Sxx, Sxx);
    sums.T = hn::Add(sums.T, T);
    sums.Tx = hn::Add(sums.Tx, Tx);
    sums.Sy = hn::MulAdd(S, dy, sums.Sy);
    sums.Sxy = hn::MulAdd(Sx, dy, sums.Sxy);
    sums.Syy = hn::MulAdd(hn::Mul(S, dy), dy, sums.Syy);
    sums.Ty = hn::MulAdd(T, dy, sums.Ty);
  }
  return sums;
}

/// Depths of the planes at the pixels; 0 where the sums do not allow one.
HWY_INLINE VF PlaneDepth(const FillRowArgs& a, const PlaneSums& s, VF nearest) {
  const VF one = hn::Set(d, 1.0F);
  const auto radius = static_cast<float>(a.radius);
  const VF inverse = hn::Div(one, hn::Max(s.S, one));
  const VF mean_x = hn::Mul(s.Sx, inverse);
  const VF mean_y = hn::Mul(s.Sy, inverse);
  const VF Cxx = hn::NegMulAdd(mean_x, s.Sx, s.Sxx);
  const VF Cxy = hn::NegMulAdd(mean_x, s.Sy, s.Sxy);
  const VF Cyy = hn::NegMulAdd(mean_y, s.Sy, s.Syy);
  const VF bx = hn::NegMulAdd(mean_x, s.T, s.Tx);
  const VF by = hn::NegMulAdd(mean_y, s.T, s.Ty);
  const VF scatter = hn::Set(d, kMinFillScatter * radius * radius);
  const VF beyond_x = hn::Sub(Cxx, scatter);
  const VF beyond_y = hn::Sub(Cyy, scatter);
  // The smaller eigenvalue of the scatter is large enough.
  MF good = hn::And(hn::Gt(hn::Min(beyond_x, beyond_y), hn::Zero(d)),
                    hn::Ge(hn::Mul(beyond_x, beyond_y), hn::Mul(Cxy, Cxy)));
  const VF offset = hn::Set(d, kMaxFillOffset * radius);
  good = hn::And(good, hn::Le(hn::Max(hn::Abs(mean_x), hn::Abs(mean_y)), offset));
  good = hn::And(good, hn::Ge(s.S, hn::Set(d, kMinFillPixels)));
  const VF determinant = hn::NegMulAdd(Cxy, Cxy, hn::Mul(Cxx, Cyy));
  const VF to_slope = hn::Div(one, hn::Max(determinant, one));
  const VF slope_x = hn::Mul(hn::NegMulAdd(Cxy, by, hn::Mul(Cyy, bx)), to_slope);
  const VF slope_y = hn::Mul(hn::NegMulAdd(Cxy, bx, hn::Mul(Cxx, by)), to_slope);
  const VF c = hn::Mul(hn::NegMulAdd(slope_x, s.Sx, hn::NegMulAdd(slope_y, s.Sy, s.T)), inverse);
  const VF squared_error =
      hn::NegMulAdd(slope_x, s.Tx, hn::NegMulAdd(slope_y, s.Ty, hn::NegMulAdd(c, s.T, s.ee)));
  const VF allowed = hn::Mul(nearest, hn::Set(d, kMaxFillNoise * a.noise_at_1m));
  good = hn::And(good, hn::Le(hn::Mul(squared_error, inverse), hn::Mul(allowed, allowed)));
  return hn::IfThenElseZero(good, hn::Div(nearest, hn::Add(one, c)));
}

// Fills holes with the plane through the depths around them. In pixels, a plane's inverse depth is
// linear, 1 / z = (1 + c + a dx + b dy) / nearest, which times z is without division for each
// pixel
//   r (1 + c + a dx + b dy) = 1,   r = z / nearest:
// a, b and c of least squares, and the pixel's depth is nearest / (1 + c).
// Rows: 2 radius + 1 image rows, nullptr outside the image; one pixel per lane. Fast: vectors
// without a hole are copied; a row's sums are moved to the window's once per row.
void FillRow(const FillRowArgs& a, std::span<float> filled_m) {
  const float* const centre_row = a.rows[a.radius];
  std::copy_n(centre_row, a.width, filled_m.data());
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int end = a.width - a.radius;
  if (end - a.radius < lanes) return;  // No camera is that small.
  for (int start = a.radius; start < end; start += lanes) {
    const int x = std::min(start, end - lanes);  // The last vector overlaps the one before.
    const VF centre = hn::LoadU(d, centre_row + x);
    const MF seen = hn::Gt(centre, hn::Zero(d));
    if (hn::AllTrue(d, seen)) continue;
    const VF nearest = NearestAround(a, x);
    const MF near_some = hn::Lt(nearest, hn::Set(d, std::numeric_limits<float>::infinity()));
    if (hn::AllTrue(d, hn::Or(seen, hn::Not(near_some)))) continue;
    const VF reference = hn::IfThenElse(near_some, nearest, hn::Set(d, 1.0F));
    const VF plane = PlaneDepth(a, SumAround(a, x, reference), reference);
    hn::StoreU(hn::IfThenElse(seen, centre, plane), d, filled_m.data() + x);
  }
}

/// Pixel x of the smaller row.
float HalfPixel(const HalfRowArgs& a, int x) {
  const float z[4] = {a.upper[2 * x], a.upper[2 * x + 1], a.lower[2 * x], a.lower[2 * x + 1]};
  float nearest = std::numeric_limits<float>::infinity();
  for (const float value : z) {
    if (value > 0.0F) nearest = std::min(nearest, value);
  }
  float sum = 0.0F;
  float count = 0.0F;
  for (const float value : z) {
    if (value > 0.0F && value - nearest <= a.max_step_ratio * nearest) {
      sum += value;
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : 0.0F;
}

// Halves an image: of each 2 x 2 pixels, the mean of those within max_step_ratio of the nearest, so
// that no depth between two surfaces arises; 0 if there is none.
// Rows: the two upper image rows, one smaller pixel per lane. Fast: loads part even from odd
// pixels, so that the four candidates of all lanes stand in four vectors.
void HalfRow(const HalfRowArgs& a, std::span<float> half_m) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int width = static_cast<int>(half_m.size());
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  const VF infinity = hn::Set(d, std::numeric_limits<float>::max());
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    VF z[4];
    hn::LoadInterleaved2(d, a.upper + 2 * x, z[0], z[1]);
    hn::LoadInterleaved2(d, a.lower + 2 * x, z[2], z[3]);
    VF nearest = infinity;
    for (const VF value : z)
      nearest = hn::Min(nearest, hn::IfThenElse(hn::Gt(value, zero), value, infinity));
    VF sum = zero;
    VF count = zero;
    for (const VF value : z) {
      const auto used =
          hn::And(hn::Gt(value, zero),
                  hn::Le(hn::Sub(value, nearest), hn::Mul(hn::Set(d, a.max_step_ratio), nearest)));
      sum = hn::Add(sum, hn::IfThenElseZero(used, value));
      count = hn::Add(count, hn::IfThenElseZero(used, one));
    }
    hn::StoreU(hn::Div(sum, hn::Max(count, one)), d, half_m.data() + x);
  }
  for (; x < width; ++x) half_m[x] = HalfPixel(a, x);
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(BilateralRow);
HWY_EXPORT(MetresRow);
HWY_EXPORT(CountGaps);
HWY_EXPORT(FillRow);
HWY_EXPORT(HalfRow);

void BilateralRow(const BilateralRowArgs& args, std::span<float> filtered) {
  HWY_DYNAMIC_DISPATCH(BilateralRow)(args, filtered);
}

int MetresRow(const MetresRowArgs& args, std::span<float> depth_m) {
  return HWY_DYNAMIC_DISPATCH(MetresRow)(args, depth_m);
}

GapCount CountGaps(const float* row, const float* below, int width) {
  return HWY_DYNAMIC_DISPATCH(CountGaps)(row, below, width);
}

void FillRow(const FillRowArgs& args, std::span<float> filled_m) {
  HWY_DYNAMIC_DISPATCH(FillRow)(args, filled_m);
}

void HalfRow(const HalfRowArgs& args, std::span<float> half_m) {
  HWY_DYNAMIC_DISPATCH(HalfRow)(args, half_m);
}

}  // namespace isotherm
#endif  // HWY_ONCE
