#pragma once

#include <cstdint>

#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/rig/sensor_models.h"

namespace isotherm {

// What a real thermal camera adds to the image that its optics and detector make, in counts of a
// scale; 0 stays "no value", and what the scale cannot hold becomes it.

/// Adds the same to each pixel.
void AddKelvin(double kelvin, const RadiometricScale& scale, Image<std::uint16_t>& counts);

/// Adds to each pixel a part of how much warmer its surroundings and the whole image are, both
/// means over pixels with a value. °C; NaN is no value.
void AddSceneInfluence(const SceneInfluence& influence, Image<float>& celsius);

/// Adds normally distributed errors of this standard deviation, the same for the same `stream`.
void AddPattern(double sigma_kelvin, std::uint64_t stream, const RadiometricScale& scale,
                Image<std::uint16_t>& counts);

/// Returns by how much all pixels are too warm together at `time_s`, kelvin: normally distributed
/// with this standard deviation, and forgotten within twice `memory_s`.
double FlickerKelvin(double sigma_kelvin, double memory_s, double time_s, std::uint64_t stream);

}  // namespace isotherm
