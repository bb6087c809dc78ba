// What the voxel kernels share: reciprocals, and records of four 32-bit words looked up or written
// by SIMD lanes. Included once per instruction set, after hwy/highway.h.
#if defined(ISOTHERM_VOXEL_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_VOXEL_KERNEL_INL_H_
#undef ISOTHERM_VOXEL_KERNEL_INL_H_
#else
#define ISOTHERM_VOXEL_KERNEL_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// The first `count` lanes from any address, zeros in the others. A whole vector must be readable
/// (Image has slack): without AVX2, a masked load takes aligned addresses only.
HWY_INLINE hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> LoadFirst(
    std::size_t count, const float* p) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
  return hn::IfThenElseZero(hn::FirstN(d, count), hn::LoadU(d, p));
}

/// Writes the first `count` lanes to any address and nothing behind them, where a blended store
/// would write what it has read: the next row may be another thread's.
HWY_INLINE void StoreFirst(hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> v,
                           std::size_t count, float* p) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
  if (count >= hn::Lanes(d)) {
    hn::StoreU(v, d, p);
    return;
  }
  HWY_ALIGN float all[hn::MaxLanes(hn::ScalableTag<float>())];
  hn::Store(v, d, all);
  std::memcpy(p, all, sizeof(float) * count);
}

/// 1 / v to about 22 bits.
HWY_INLINE hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> Reciprocal(
    hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> v) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
#if HWY_ARCH_X86
  const auto estimate = hn::ApproximateReciprocal(v);
  return hn::Mul(estimate, hn::NegMulAdd(v, estimate, hn::Set(d, 2.0F)));
#else
  return hn::Div(hn::Set(d, 1.0F), v);
#endif
}

/// Four vectors; lane i of each is a word of record i. Integer words are bit casts.
struct RecordVectors {
  hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> word[4];
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE RecordVectors GatherRecords(const void* records, const std::int32_t* indices) {
  const hwy::HWY_NAMESPACE::ScalableTag<float> tag;
  float words[4];
  std::memcpy(words, static_cast<const std::byte*>(records) + 16 * std::ptrdiff_t{*indices}, 16);
  RecordVectors v;
  for (int i = 0; i < 4; ++i) v.word[i] = hwy::HWY_NAMESPACE::Set(tag, words[i]);
  return v;
}

#else

/// The 128-bit records `indices[0]`, `indices[4]`, `indices[8]`, ... side by side.
HWY_INLINE hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::ScalableTag<float>> LoadEveryFourth(
    const float* records, const std::int32_t* indices) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::Full128<float> d4;
  const auto load = [&](int i) { return hn::LoadU(d4, records + 4 * std::ptrdiff_t{indices[i]}); };
#if HWY_MAX_BYTES == 16
  return load(0);
#else
  const hn::Full256<float> d8;
  const auto low = hn::Combine(d8, load(4), load(0));
#if HWY_MAX_BYTES == 32
  return low;
#else
  return hn::Combine(hn::Full512<float>(), hn::Combine(d8, load(12), load(8)), low);
#endif
#endif
}

/// Record `indices[i]` for each lane i. One load of 16 bytes per lane and a transposition of 4 x 4
/// words in each 128-bit block cost a quarter of four gathers.
HWY_INLINE RecordVectors GatherRecords(const void* records, const std::int32_t* indices) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
  const hn::Repartition<double, decltype(d)> dd;
  const auto* base = static_cast<const float*>(records);
  const auto r0 = LoadEveryFourth(base, indices);
  const auto r1 = LoadEveryFourth(base, indices + 1);
  const auto r2 = LoadEveryFourth(base, indices + 2);
  const auto r3 = LoadEveryFourth(base, indices + 3);
  const auto low0 = hn::BitCast(dd, hn::InterleaveLower(d, r0, r1));
  const auto high0 = hn::BitCast(dd, hn::InterleaveUpper(d, r0, r1));
  const auto low1 = hn::BitCast(dd, hn::InterleaveLower(d, r2, r3));
  const auto high1 = hn::BitCast(dd, hn::InterleaveUpper(d, r2, r3));
  return {{hn::BitCast(d, hn::InterleaveLower(dd, low0, low1)),
           hn::BitCast(d, hn::InterleaveUpper(dd, low0, low1)),
           hn::BitCast(d, hn::InterleaveLower(dd, high0, high1)),
           hn::BitCast(d, hn::InterleaveUpper(dd, high0, high1))}};
}

#endif

/// Writes the first `count` lanes to consecutive records.
HWY_INLINE void StoreRecords(const RecordVectors& v, std::size_t count, void* records) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
  auto* target = static_cast<float*>(records);
  if (count >= hn::Lanes(d)) {
    hn::StoreInterleaved4(v.word[0], v.word[1], v.word[2], v.word[3], d, target);
    return;
  }
  HWY_ALIGN float all[4 * hn::MaxLanes(hn::ScalableTag<float>())];
  hn::StoreInterleaved4(v.word[0], v.word[1], v.word[2], v.word[3], d, all);
  std::memcpy(target, all, 16 * count);
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // ISOTHERM_VOXEL_KERNEL_INL_H_
