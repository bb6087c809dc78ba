// One row of the bilateral filter in SIMD lanes. Compiled once per instruction set.
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
HWY_EXPORT(HalfRow);

void BilateralRow(const BilateralRowArgs& args, std::span<float> filtered) {
  HWY_DYNAMIC_DISPATCH(BilateralRow)(args, filtered);
}

int MetresRow(const MetresRowArgs& args, std::span<float> depth_m) {
  return HWY_DYNAMIC_DISPATCH(MetresRow)(args, depth_m);
}

void HalfRow(const HalfRowArgs& args, std::span<float> half_m) {
  HWY_DYNAMIC_DISPATCH(HalfRow)(args, half_m);
}

}  // namespace isotherm
#endif  // HWY_ONCE
