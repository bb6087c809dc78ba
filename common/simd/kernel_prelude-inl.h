// Every kernel begins with this file. A kernel is a source file that Highway compiles once per
// instruction set, in namespace isotherm::HWY_NAMESPACE; the best one for the processor is picked
// at run time. The file names itself, and then includes this before anything else:
//
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "ground/tsdf/culling_kernel.cc"
//   #include "common/simd/kernel_prelude-inl.h"
//
// foreach_target.h includes that file again for each instruction set, and must come before
// highway.h. What follows them is compiled once per instruction set, too.
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#if defined(ISOTHERM_KERNEL_PRELUDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_KERNEL_PRELUDE_INL_H_
#undef ISOTHERM_KERNEL_PRELUDE_INL_H_
#else
#define ISOTHERM_KERNEL_PRELUDE_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Vectors of floats and of as many 32-bit integers, and their masks.
using D = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<D>;
using VF = hn::Vec<D>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<D>;
using MI = hn::Mask<DI>;

constexpr D d;
constexpr DI di;

/// A vector in space for each lane.
struct Vector3 {
  VF x, y, z;
};

HWY_INLINE VF Dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// The first `count` lanes from any address, zeros in the others. A whole vector must be readable
/// (Image has slack): without AVX2, a masked load takes aligned addresses only.
HWY_INLINE VF LoadFirst(std::size_t count, const float* p) {
  return hn::IfThenElseZero(hn::FirstN(d, count), hn::LoadU(d, p));
}

/// Writes the first `count` lanes to any address and nothing behind them, where a blended store
/// would write what it has read: the next row may be another thread's.
HWY_INLINE void StoreFirst(VF v, std::size_t count, float* p) {
  if (count >= hn::Lanes(d)) {
    hn::StoreU(v, d, p);
    return;
  }
  HWY_ALIGN float all[hn::MaxLanes(d)];
  hn::Store(v, d, all);
  std::memcpy(p, all, sizeof(float) * count);
}

/// 1 / v to about 22 bits: x86 estimates 12, a Newton step doubles them. NEON's 8 would not do.
HWY_INLINE VF Reciprocal(VF v) {
#if HWY_ARCH_X86
  const VF estimate = hn::ApproximateReciprocal(v);
  return hn::Mul(estimate, hn::NegMulAdd(v, estimate, hn::Set(d, 2.0F)));
#else
  return hn::Div(hn::Set(d, 1.0F), v);
#endif
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // ISOTHERM_KERNEL_PRELUDE_INL_H_
