#pragma once

#include <string>

#include "common/simulation/simulated_scan.h"

namespace isotherm {

/// Temperatures of the corner's parts, degrees Celsius, each the same everywhere.
struct CornerTemperatures {
  double back_wall;
  double side_wall;
  double floor;
  double sphere;
};

/// Two walls, a floor and a sphere before them, which the rig looks at from 0.6 m while it sways:
/// surfaces in all directions, so that tracking holds, and nothing that hides much.
StagedScene CornerScene(std::string name, const CornerTemperatures& celsius);

}  // namespace isotherm
