// One row of the bilateral filter in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tracker/filter_kernel.cc"
#include <hwy/foreach_target.h>  // Must come before highway.h.
//
#include <hwy/highway.h>

#include <algorithm>

#include "ground/tracker/filter_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using VF = hn::Vec<D>;
constexpr D d;

/// Pixel x of the row, with the neighbours that are inside the image.
float FilterPixel(const BilateralRowArgs& a, int x) {
  const int side = 2 * a.radius + 1;
  const float centre = a.rows[a.radius][x];
  if (!(centre > 0.0F)) return 0.0F;
  const float tau = a.tau_at_1m * centre * centre;
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

void BilateralRow(const BilateralRowArgs& a, std::span<float> filtered) {
  const int side = 2 * a.radius + 1;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF zero = hn::Zero(d);
  const VF one = hn::Set(d, 1.0F);
  int x = 0;
  for (; x < std::min(a.radius, a.width); ++x) filtered[x] = FilterPixel(a, x);
  for (; x + lanes + a.radius <= a.width; x += lanes) {
    const VF centre = hn::LoadU(d, a.rows[a.radius] + x);
    const auto valid = hn::Gt(centre, zero);
    if (hn::AllFalse(d, valid)) {
      hn::StoreU(zero, d, filtered.data() + x);
      continue;
    }
    const VF tau = hn::Mul(hn::Set(d, a.tau_at_1m), hn::Mul(centre, centre));
    const VF inverse = hn::Div(one, hn::Max(tau, hn::Set(d, 1e-9F)));
    VF sum = zero;
    VF weights = zero;
    for (int dy = 0; dy < side; ++dy) {
      if (a.rows[dy] == nullptr) continue;
      const float* row = a.rows[dy] + x - a.radius;
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
    hn::StoreU(hn::IfThenElseZero(valid, mean), d, filtered.data() + x);
  }
  for (; x < a.width; ++x) filtered[x] = FilterPixel(a, x);
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(BilateralRow);

void BilateralRow(const BilateralRowArgs& args, std::span<float> filtered) {
  HWY_DYNAMIC_DISPATCH(BilateralRow)(args, filtered);
}

}  // namespace isotherm
#endif  // HWY_ONCE
