// Lanes numbered, and some of them written one after another. Included once per instruction set.
#include "common/simd/kernel_prelude-inl.h"

#if defined(ISOTHERM_PACKING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOTHERM_PACKING_INL_H_
#undef ISOTHERM_PACKING_INL_H_
#else
#define ISOTHERM_PACKING_INL_H_
#endif

#include <array>
#include <bit>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace isotherm::HWY_NAMESPACE {

/// first, first + 1, ... per lane. hn::Iota writes them to memory one by one, unless the compiler
/// knows the first, and waits for that.
HWY_INLINE VI CountFrom(std::int32_t first) { return hn::Add(hn::Iota(di, 0), hn::Set(di, first)); }

/// Lanes of the longest vectors whose packing is looked up; longer ones have an instruction.
constexpr std::size_t kLookedUpLanes = 8;

/// For each set of lanes their numbers, and zeros behind them.
constexpr std::array<std::array<std::uint8_t, kLookedUpLanes>, 1 << kLookedUpLanes> kPackedLanes =
    [] {
      std::array<std::array<std::uint8_t, kLookedUpLanes>, 1 << kLookedUpLanes> packed{};
      for (std::size_t lanes = 0; lanes < packed.size(); ++lanes) {
        std::size_t count = 0;
        for (std::uint8_t lane = 0; lane < kLookedUpLanes; ++lane) {
          if ((lanes >> lane & 1) != 0) packed[lanes][count++] = lane;
        }
      }
      return packed;
    }();

/// Writes the lanes of `kept` of any vectors of 32-bit integers one after another. Does what
/// hn::CompressStore does, whose table GCC copies to the stack in each call: a kilobyte with AVX2.
template <typename Tag>
class Packing {
 public:
  HWY_INLINE explicit Packing(hn::Mask<Tag> kept) : kept_(kept) {
    if constexpr (kIsLookedUp) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(Tag(), kept, bytes);
      lanes_ = bytes[0];
      count_ = std::popcount(static_cast<unsigned>(lanes_));
    } else {
      count_ = static_cast<std::int32_t>(hn::CountTrue(Tag(), kept));
    }
  }

  /// How many lanes are kept.
  HWY_INLINE std::int32_t count() const { return count_; }

  /// Writes a whole vector to any address; what stands behind the kept lanes means nothing.
  HWY_INLINE void Store(hn::Vec<Tag> v, std::int32_t* to) const {
    if constexpr (kIsLookedUp) {
      const hn::Rebind<std::uint8_t, Tag> bytes;
      const auto numbers = hn::PromoteTo(Tag(), hn::LoadU(bytes, kPackedLanes[lanes_].data()));
      hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(Tag(), numbers)), Tag(), to);
    } else {
      hn::CompressStore(v, kept_, Tag(), to);
    }
  }

 private:
  static constexpr bool kIsLookedUp = !HWY_HAVE_SCALABLE && hn::MaxLanes(Tag()) <= kLookedUpLanes;

  hn::Mask<Tag> kept_;
  std::uint8_t lanes_ = 0;  ///< A bit for each.
  std::int32_t count_ = 0;
};

}  // namespace isotherm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // ISOTHERM_PACKING_INL_H_
