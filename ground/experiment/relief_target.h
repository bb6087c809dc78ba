#pragma once

#include "common/concurrency/thread_pool.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulated_scan.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// A board with ridges 6 mm wide and 5 mm high, 12 mm from one to the next, beside a flat part,
/// with things around it that a tracker can hold on to.
StagedScene MakeReliefTarget(const ScanPath& path);

/// A path that looks at the middle of the board from this distance.
ScanPath TowardsRelief(const Swing& distance_m);

/// Holds how a model shows the board; NaN where it does not show something.
struct ReliefCheck {
  double kept_percent = 0.0;  ///< Height of the ridges above the grooves, of the true one.
  double flat_rms_mm = 0.0;   ///< Distance of the flat part from the true plane.
  double scene_rms_mm = 0.0;  ///< Distance of all surfaces from the true ones, along their normals.
  double points = 0.0;        ///< Points of the model.
};
ReliefCheck MeasureRelief(const SimulatedScan& scan, const ScanModel& model, ThreadPool& pool);

}  // namespace isotherm
