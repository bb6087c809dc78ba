// The voxel kernels share this file: where a block's voxels are, and records of four 32-bit words
// looked up or written by SIMD lanes. Included once per instruction set.
#include "common/simd/kernel_prelude-inl.h"

#if defined(ISOTHERM_VOXEL_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_VOXEL_KERNEL_INL_H_
#undef ISOTHERM_VOXEL_KERNEL_INL_H_
#else
#define ISOTHERM_VOXEL_KERNEL_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "ground/surface/block_layout.h"

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// Camera coordinates of a block's voxels, layer by layer of equal z: within each they differ from
/// the layer's first voxel by the same offsets, which are computed once.
class BlockPoints {
 public:
  /// `axes` has the step of one voxel along x, y and z as columns, row-major; `first` is the
  /// block's first voxel.
  HWY_INLINE BlockPoints(const float* axes, const float* first) : axes_(axes), first_(first) {
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < BlockLayout::kLayerVoxels; i += lanes) {
      const VI element = hn::Iota(di, i);
      const VF x = hn::ConvertTo(d, hn::And(element, hn::Set(di, BlockLayout::kSideMask)));
      const VF y = hn::ConvertTo(d, hn::ShiftRight<BlockLayout::kShiftY>(element));
      for (int row = 0; row < 3; ++row) {
        const float* axis = axes + 3 * row;
        hn::Store(hn::MulAdd(hn::Set(d, axis[0]), x, hn::Mul(hn::Set(d, axis[1]), y)), d,
                  along_[row] + i);
      }
    }
  }

  /// The first voxel of a layer, in all lanes.
  HWY_INLINE Vector3 Origin(int layer) const {
    const auto step = static_cast<float>(layer);
    const auto coordinate = [&](int row) {
      return hn::Set(d, first_[row] + step * axes_[3 * row + 2]);
    };
    return {coordinate(0), coordinate(1), coordinate(2)};
  }
  /// Voxels from number `i` of the layer on.
  HWY_INLINE Vector3 At(const Vector3& origin, int i) const {
    return {hn::Add(origin.x, hn::Load(d, along_[0] + i)),
            hn::Add(origin.y, hn::Load(d, along_[1] + i)),
            hn::Add(origin.z, hn::Load(d, along_[2] + i))};
  }

 private:
  const float* axes_;
  const float* first_;
  HWY_ALIGN float along_[3][BlockLayout::kLayerVoxels];
};

/// Four vectors; lane i of each is a word of record i. Integer words are bit casts.
struct RecordVectors {
  VF word[4];
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE RecordVectors GatherRecords(const void* records, const std::int32_t* indices) {
  float words[4];
  std::memcpy(words, static_cast<const std::byte*>(records) + 16 * std::ptrdiff_t{*indices}, 16);
  RecordVectors v;
  for (int i = 0; i < 4; ++i) v.word[i] = hn::Set(d, words[i]);
  return v;
}

#else

/// The 128-bit records `indices[0]`, `indices[4]`, `indices[8]`, ... side by side.
HWY_INLINE VF LoadEveryFourth(const float* records, const std::int32_t* indices) {
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
  const hn::Repartition<double, D> dd;
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
  auto* target = static_cast<float*>(records);
  if (count >= hn::Lanes(d)) {
    hn::StoreInterleaved4(v.word[0], v.word[1], v.word[2], v.word[3], d, target);
    return;
  }
  HWY_ALIGN float all[4 * hn::MaxLanes(d)];
  hn::StoreInterleaved4(v.word[0], v.word[1], v.word[2], v.word[3], d, all);
  std::memcpy(target, all, 16 * count);
}

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // ISOTHERM_VOXEL_KERNEL_INL_H_
