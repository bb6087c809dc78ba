#pragma once

#include <algorithm>
#include <cstdint>

#include "ground/thermal/voxel_layout.h"

namespace isotherm {

/// How well a surface was measured, by all conditions together, in the order of what is left to do.
/// "Measured well" is kGood, wherever it is said: in feedback, plans, renderings, statistics and
/// evaluations.
enum class MeasurementQuality : std::uint8_t { kGood, kAcceptable, kBad, kNever };

/// The quality under these classes (eq. 6.3a-b): good if distance, angle and, as far as it was
/// checked, motion are, bad if one of them is. Disagreement is a finding, not a condition: it
/// does not count.
constexpr MeasurementQuality QualityOf(ConditionClass distance, ConditionClass angle,
                                       ConditionClass motion) {
  constexpr auto quality = [](ConditionClass condition) {
    switch (condition) {
      case ConditionClass::kGood:
        return MeasurementQuality::kGood;
      case ConditionClass::kAcceptable:
        return MeasurementQuality::kAcceptable;
      case ConditionClass::kUnchecked:
        return MeasurementQuality::kNever;
      case ConditionClass::kBad:
        break;
    }
    return MeasurementQuality::kBad;
  };
  const MeasurementQuality measured = std::max(quality(distance), quality(angle));
  return motion == ConditionClass::kUnchecked ? measured : std::max(measured, quality(motion));
}

/// The same of classes as they are exported.
constexpr MeasurementQuality QualityOf(std::uint8_t distance, std::uint8_t angle,
                                       std::uint8_t motion) {
  return QualityOf(static_cast<ConditionClass>(distance), static_cast<ConditionClass>(angle),
                   static_cast<ConditionClass>(motion));
}

}  // namespace isotherm
