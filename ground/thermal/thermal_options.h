#pragma once

#include "common/base/status.h"
#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/reading_corrections.h"

namespace isotherm {

Status Validate(const ThermalOptions& options);

/// Fails if the lens (if it is known) is sharp nowhere between the distances that are not bad.
Status CheckSharpness(const ThermalOptions& options, const ThermalSensorModel& sensor);

/// Returns `options` with the emission angles of its material where it sets none. The material is
/// known (Validate, CHECK).
ThermalOptions WithAnglesOfMaterial(const ThermalOptions& options);

/// Returns `options` with all limits as the fuser takes them, for everything that states or applies
/// them: WithAnglesOfMaterial, and distances narrowed to those at which the rig's lens is sharp (if
/// it is known).
ThermalOptions CompleteLimits(const ThermalOptions& options, const ThermalSensorModel& sensor);

/// Returns how readings are corrected, by what is known of the sensor and as the options ask for
/// it.
ReadingCorrections CorrectionsOf(const ThermalOptions& options, const ThermalSensorModel& sensor);

}  // namespace isotherm
