#pragma once

#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"

namespace isotherm {

/// Something hot in front of a wall, scanned once, with three ways to keep its temperature off the
/// wall.
struct HiddenSurfaceSetup {
  StagedScene staged;
  double duration_s;
  double max_wrong_percent;  ///< With visibility from the thermal camera.
  /// Least fraction of wrong points that algorithm 4 leaves, if it must fail; 0 = it may do well.
  double algorithm4_wrong_percent;
};

/// Counts wrongly assigned points without a filter, with algorithm 4 and with what the thermal
/// camera sees of the model.
Result<ExperimentReport> CompareParallaxFilters(const HiddenSurfaceSetup& setup, ThreadPool& pool);

}  // namespace isotherm
