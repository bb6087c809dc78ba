#pragma once

#include <span>
#include <string_view>

#include "common/radiometry/band_emissivity.h"

namespace isotherm {

/// A material with its refractive index in the long-wave infrared (docs/materials.md).
struct OpticalMaterial {
  std::string_view name;  ///< As on the command line.
  std::string_view description;
  std::string_view source;
  std::span<const IndexSample> index;
};

/// All that are built in: metals, then oxides, then dielectrics.
std::span<const OpticalMaterial> OpticalMaterials();

/// nullptr if there is none of that name.
const OpticalMaterial* FindOpticalMaterial(std::string_view name);

}  // namespace isotherm
