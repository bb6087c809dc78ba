#pragma once

#include <cstddef>

#include "common/doubts/doubts.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_counts.h"

namespace isotherm {

/// Holds what became of a scan, as far as it may prove that something was wrong from the start.
struct ScanOutcome {
  const ScanCounts& counts;
  const GroundOptions& options;
  DepthSensorModel depth_sensor{};  ///< The rig's depth camera.
  ThermalSensorModel thermal_sensor{};
  bool continued = false;           ///< It went on with a saved model.
  bool can_fuse = false;            ///< The calibration and the camera allow temperatures.
  std::size_t poses = 0;            ///< In `world`.
  std::size_t maps = 1;             ///< Sub-maps that were never joined, with the first.
  std::size_t points = 0;           ///< Points of the surface.
  std::size_t measured_points = 0;  ///< Points of the surface with a temperature.
};

/// Nothing was tracked, or no temperature was assigned although there are thermal frames: with the
/// likely cause and what to do. Such a result is not what was asked for.
Doubts DoubtsAboutResult(const ScanOutcome& outcome);

}  // namespace isotherm
