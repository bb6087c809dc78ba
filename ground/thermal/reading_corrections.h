#pragma once

#include <optional>

#include "common/frame/radiometric_scale.h"
#include "common/rig/radiometric_correction.h"
#include "common/rig/sensor_models.h"
#include "ground/thermal/nuc_epochs.h"

namespace isotherm {

/// Returns a frame's scale, changed so that its temperatures are without the housing's drift; the
/// same if nobody knows the drift, or the housing's temperature.
inline RadiometricScale WithoutDrift(RadiometricScale scale,
                                     const std::optional<HousingDrift>& drift, const NucAge& nuc) {
  if (drift && nuc.housing_change_k)
    scale.offset_kelvin -= drift->error_per_kelvin * *nuc.housing_change_k;
  return scale;
}

/// Says what is corrected in each thermal image. Nothing by default.
struct ReadingCorrections {
  SceneInfluence scene_influence{};                ///< Is taken out.
  RadiometricCorrection radiometric_correction{};  ///< Is added.
  std::optional<HousingDrift> housing_drift{};     ///< Is taken out before both (WithoutDrift).
};

}  // namespace isotherm
