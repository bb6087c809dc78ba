// Blocks against the planes of a view in SIMD lanes. Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ground/tsdf/culling_kernel.cc"
#include "common/simd/kernel_prelude-inl.h"  // Before everything else.

#include "common/simd/packing-inl.h"
#include "ground/tsdf/culling_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

// Keeps the blocks inside a view: p[0] x + p[1] y + p[2] z + p[3] >= 0 for each of its planes,
// whose offsets the caller has moved out so that a block counts until all of it is outside. Rows:
// block coordinates are x y z of each block after another; a block per lane. Fast: the table of
// blocks is read in order, with three loads per vector, and only indices are written; the smallest
// of the five values decides without a branch.
std::int32_t CullBlocks(const float (&planes)[kFrustumPlanes][4], const std::int32_t* coordinates,
                        std::int32_t count, std::int32_t* inside) {
  const auto lanes = static_cast<std::int32_t>(hn::Lanes(d));
  std::int32_t found = 0;
  std::int32_t block = 0;
  for (; block + lanes <= count; block += lanes) {
    VI x, y, z;
    hn::LoadInterleaved3(di, coordinates + 3 * std::ptrdiff_t{block}, x, y, z);
    const VF bx = hn::ConvertTo(d, x);
    const VF by = hn::ConvertTo(d, y);
    const VF bz = hn::ConvertTo(d, z);
    VF least = hn::Set(d, 0.0F);
    for (const auto& plane : planes) {
      least = hn::Min(
          least,
          hn::MulAdd(hn::Set(d, plane[0]), bx,
                     hn::MulAdd(hn::Set(d, plane[1]), by,
                                hn::MulAdd(hn::Set(d, plane[2]), bz, hn::Set(d, plane[3])))));
    }
    const auto seen = hn::RebindMask(di, hn::Ge(least, hn::Zero(d)));
    const Packing<DI> packing(seen);
    packing.Store(CountFrom(block), inside + found);
    found += packing.count();
  }
  for (; block < count; ++block) {
    const std::int32_t* b = coordinates + 3 * std::ptrdiff_t{block};
    bool seen = true;
    for (const auto& plane : planes) {
      seen = seen && plane[0] * static_cast<float>(b[0]) + plane[1] * static_cast<float>(b[1]) +
                             plane[2] * static_cast<float>(b[2]) + plane[3] >=
                         0.0F;
    }
    if (seen) inside[found++] = block;
  }
  return found;
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isotherm {

HWY_EXPORT(CullBlocks);

std::int32_t CullBlocks(const float (&planes)[kFrustumPlanes][4], const std::int32_t* coordinates,
                        std::int32_t count, std::int32_t* inside) {
  return HWY_DYNAMIC_DISPATCH(CullBlocks)(planes, coordinates, count, inside);
}

}  // namespace isotherm
#endif  // HWY_ONCE
