#pragma once

namespace isotherm {

/// The edge corrects the thermal camera when its housing has drifted by so much: the default of
/// `nuc.expert.max_housing_drift_k`, kelvin. A test compares them, for ground and edge do not
/// include each other.
inline constexpr double kShippedHousingDrift_k = 0.5;

}  // namespace isotherm
