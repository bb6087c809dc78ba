#pragma once

#include <string>

#include "common/base/status.h"
#include "common/rig/rig.h"

namespace isotherm {

class SimulatedDepthOptions;
class SimulatedThermalOptions;
class SimulationOptions;

/// Checks ranges and relations; the message names the field.
Status Validate(const SimulationOptions& options);

/// The options with everything that may be left out filled in (clocks, ideal cameras).
SimulationOptions Resolved(const SimulationOptions& options);

/// Returns cameras without what makes real ones worse than their data sheets, but for what is set:
/// `simulation.ideal_cameras` for a camera alone.
SimulatedThermalOptions IdealThermalCamera(const SimulatedThermalOptions& set);
SimulatedDepthOptions IdealDepthCamera(const SimulatedDepthOptions& set);

/// The rig of the thesis: a PrimeSense Carmine 1.09 below an Optris PI 450.
Rig DefaultSimulatedRig();

/// Returns the scale of the images of a camera that measures up to `max_celsius`. `options` are
/// valid.
RadiometricScale ScaleOf(const SimulatedThermalOptions& options);

/// Returns the rig that the options name, with their scales. Fails if the file has no depth or no
/// thermal camera.
Result<Rig> SimulatedRig(const SimulationOptions& options);

/// "furnace-door", "calibrator", "plane", "corner-sphere".
std::string SceneName(const SimulationOptions& options);

/// Returns what the scene adds to each pixel of a simulated camera; the rig tells it.
SceneInfluence InfluenceOf(const SimulatedThermalOptions& options);

}  // namespace isotherm
