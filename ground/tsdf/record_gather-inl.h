// Records of four 32-bit words, looked up or written by SIMD lanes. Included by kernels once per
// instruction set, after hwy/highway.h.
#if defined(ISOTHERM_RECORD_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_RECORD_GATHER_INL_H_
#undef ISOTHERM_RECORD_GATHER_INL_H_
#else
#define ISOTHERM_RECORD_GATHER_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

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

/// Record `indices[i]` for each lane i. One load of 16 bytes per lane and a transposition cost a
/// quarter of four gathers.
HWY_INLINE RecordVectors GatherRecords(const void* records, const std::int32_t* indices) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<float> d;
  const hn::Full128<float> d4;
  const hn::Repartition<double, decltype(d)> dd;
  constexpr int kBlocks = static_cast<int>(hn::MaxLanes(hn::ScalableTag<float>())) / 4;
  // Row r holds records r, r + 4, r + 8, ... so that each 128-bit block is a 4 x 4 transposition.
  HWY_ALIGN float rows[4][4 * kBlocks];
  const auto* base = static_cast<const float*>(records);
  for (int block = 0; block < kBlocks; ++block) {
    for (int row = 0; row < 4; ++row) {
      const float* record = base + 4 * std::ptrdiff_t{indices[4 * block + row]};
      hn::Store(hn::LoadU(d4, record), d4, &rows[row][4 * block]);
    }
  }
  const auto r0 = hn::Load(d, rows[0]);
  const auto r1 = hn::Load(d, rows[1]);
  const auto r2 = hn::Load(d, rows[2]);
  const auto r3 = hn::Load(d, rows[3]);
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

#endif  // ISOTHERM_RECORD_GATHER_INL_H_
