#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/rig/sensor_models.h"
#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {

/// Holds a thermal image without what the radiation on other pixels adds to each one.
struct OwnTemperatures {
  Image<std::uint16_t> temperature_raw;  ///< As in ThermalFrame.
  InfluenceMeans means;
  double gain = 1.0;  ///< 1 / (1 - near_fraction - total_fraction).

  /// How an own temperature at a place of the image (pixels) changes with the two fractions, kelvin
  /// per unit, but for what is the same for all images of one point: its own temperature. That of
  /// one image holds noise, which would pass for knowledge.
  Eigen::Vector2d ByFractions(const Eigen::Vector2d& pixel) const;
};

/// As FindOwnTemperatures takes it: neither fraction beyond what converges.
SceneInfluence Convergent(const SceneInfluence& influence);

/// `influence` is convergent; a fraction below zero is some chance.
OwnTemperatures FindOwnTemperatures(const Image<std::uint16_t>& temperature_raw,
                                    const RadiometricScale& scale, const SceneInfluence& influence);

}  // namespace isotherm
