#pragma once

#include <cstdint>

namespace isotherm {

/// The 32-bit word of a TSDF voxel, as volumes, kernels and model files have it:
///   bits 31..16  truncated signed distance over the truncation distance, signed, 32767 = 1
///   bits 15..0   weight in 1/64 observations; 0 = never observed
/// The distance's sign is the word's: an observed word below kFirstPositive lies at or behind the
/// surface.
struct TsdfLayout {
  static constexpr int kTsdfShift = 16;
  static constexpr std::uint32_t kWeightMask = 0xFFFFU;
  static constexpr std::int32_t kFirstPositive = 1 << kTsdfShift;
  static constexpr float kTsdfScale = 32767.0F;
  static constexpr float kWeightScale = 64.0F;

  /// `tsdf` is -32767 .. 32767.
  static constexpr std::uint32_t Pack(std::int32_t tsdf, std::uint32_t weight) {
    return static_cast<std::uint32_t>(tsdf) << kTsdfShift | weight;
  }
  static constexpr std::int32_t TsdfCode(std::uint32_t word) {
    return static_cast<std::int32_t>(word) >> kTsdfShift;
  }
  static constexpr std::uint32_t WeightCode(std::uint32_t word) { return word & kWeightMask; }
};
static_assert(TsdfLayout::kWeightMask == (std::uint32_t{1} << TsdfLayout::kTsdfShift) - 1);
static_assert(TsdfLayout::Pack(-32767, 65535) == 0x8001'FFFFU);
static_assert(TsdfLayout::TsdfCode(0x8001'0040U) == -32767);
static_assert(TsdfLayout::WeightCode(0x8001'0040U) == 64);
static_assert(static_cast<std::int32_t>(TsdfLayout::Pack(0, 65535)) < TsdfLayout::kFirstPositive &&
              static_cast<std::int32_t>(TsdfLayout::Pack(1, 1)) >= TsdfLayout::kFirstPositive);

}  // namespace isotherm
