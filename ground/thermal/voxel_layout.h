#pragma once

#include <cstdint>

namespace isotherm {

/// Exported where a point was never assigned a temperature.
inline constexpr std::uint8_t kNeverMeasured = 255;

/// Class of a measurement condition (eq. 6.3a-b) as it is exported.
enum class ConditionClass : std::uint8_t {
  kBad = 0,
  kGood = 1,
  kAcceptable = 2,
  kUnchecked = kNeverMeasured,  ///< Motion and disagreement only: not known.
};

/// The 32-bit word of a thermal voxel (thesis fig. 6.9), as volumes, kernels and model files have
/// it (the table is in docs/model-format.md):
///   bits 31..16  temperature code: 0 = none, never measured or not kept, else 1 + (celsius + 100)
///                / 0.025 (steps of 0.025 K from -100 to 1538 °C)
///   bits 15..12  motion class, bits 11..8 disagreement class, each as 0 unchecked, 1 bad,
///                2 acceptable, 3 good: the zeros of a voxel from before these checks are right
///   bits  7..4   distance class, bits 3..0 angle class (ConditionClass)
struct ThermalLayout {
  static constexpr int kCodeShift = 16;
  static constexpr int kMotionShift = 12;
  static constexpr int kDisagreementShift = 8;
  static constexpr int kDistanceShift = 4;
  static constexpr int kAngleShift = 0;

  static constexpr int kClassBits = 4;
  static constexpr std::uint32_t kClassMask = 0xFU;  ///< Mask of any class after its shift.
  static constexpr std::uint32_t kClassesMask = 0xFFFFU;
  static constexpr std::uint32_t kMotionMask = kClassMask << kMotionShift;
  static constexpr std::uint32_t kDisagreementMask = kClassMask << kDisagreementShift;
  static constexpr std::uint32_t kDistanceMask = kClassMask << kDistanceShift;
  static constexpr std::uint32_t kAngleMask = kClassMask << kAngleShift;
  /// The classes of one measurement; disagreement is of many.
  static constexpr std::uint32_t kConditionMask = kMotionMask | kDistanceMask | kAngleMask;

  static constexpr float kMin_celsius = -100.0F;
  static constexpr float kStep_k = 0.025F;
  static constexpr float kStepsPerKelvin = 40.0F;
  static constexpr std::uint32_t kCodeMask = 0xFFFFU;  ///< Mask of the code after its shift.
  static constexpr float kMaxCode = 65535.0F;

  static constexpr std::uint32_t Code(std::uint32_t word) { return word >> kCodeShift; }
  /// The four bits of a motion or disagreement class: more is better.
  static constexpr std::uint32_t Encode(ConditionClass c) {
    constexpr std::uint32_t kCodes[] = {1, 3, 2};
    return c == ConditionClass::kUnchecked ? 0 : kCodes[static_cast<std::uint8_t>(c)];
  }
  static constexpr ConditionClass Decode(std::uint32_t code) {
    constexpr ConditionClass kClasses[] = {ConditionClass::kUnchecked, ConditionClass::kBad,
                                           ConditionClass::kAcceptable, ConditionClass::kGood};
    return kClasses[code & 0x3U];
  }
  static constexpr std::uint32_t Classes(ConditionClass distance, ConditionClass angle,
                                         ConditionClass motion = ConditionClass::kUnchecked,
                                         ConditionClass disagreement = ConditionClass::kUnchecked) {
    return Encode(motion) << kMotionShift | Encode(disagreement) << kDisagreementShift |
           static_cast<std::uint32_t>(distance) << kDistanceShift |
           static_cast<std::uint32_t>(angle) << kAngleShift;
  }
};
static_assert(1U << ThermalLayout::kClassBits == ThermalLayout::kClassMask + 1);
static_assert((ThermalLayout::kConditionMask | ThermalLayout::kDisagreementMask) ==
              ThermalLayout::kClassesMask);
static_assert((ThermalLayout::kConditionMask & ThermalLayout::kDisagreementMask) == 0);
static_assert(ThermalLayout::kConditionMask == 0xF0FFU);
static_assert(static_cast<float>(ThermalLayout::kCodeMask) == ThermalLayout::kMaxCode);
static_assert(1.0F / ThermalLayout::kStep_k == ThermalLayout::kStepsPerKelvin);

/// Good in motion, distance and angle.
inline constexpr std::uint32_t kAllGood =
    ThermalLayout::Classes(ConditionClass::kGood, ConditionClass::kGood, ConditionClass::kGood);
static_assert(kAllGood == 0x3011U);
static_assert(ThermalLayout::Classes(ConditionClass::kAcceptable, ConditionClass::kGood,
                                     ConditionClass::kGood, ConditionClass::kBad) == 0x3121U);
static_assert(ThermalLayout::Decode(ThermalLayout::Encode(ConditionClass::kBad)) ==
                  ConditionClass::kBad &&
              ThermalLayout::Decode(ThermalLayout::Encode(ConditionClass::kUnchecked)) ==
                  ConditionClass::kUnchecked);

}  // namespace isotherm
