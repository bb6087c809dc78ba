#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"

namespace isotherm {

/// Holds the apparent temperature at one place of a thermal image.
struct ThermalSample {
  double kelvin = 0.0;
  Eigen::Vector2d gradient_k_px = Eigen::Vector2d::Zero();
};

/// Bilinear, with the derivative of just that; nullopt at the border and where a pixel around has
/// no value.
std::optional<ThermalSample> SampleThermal(const Image<std::uint16_t>& image,
                                           const RadiometricScale& scale,
                                           const Eigen::Vector2d& pixel);

/// Blurs by pixels that have a value only; those without stay without. `weights` as of
/// GaussianWeights.
Image<std::uint16_t> BlurKnownPixels(const Image<std::uint16_t>& image,
                                     std::span<const float> weights);

}  // namespace isotherm
