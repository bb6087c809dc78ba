#pragma once

#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"

namespace isotherm {

/// Something hot in front of a wall, scanned once, with several ways to keep its temperature off
/// the wall.
struct HiddenSurfaceSetup {
  StagedScene staged;
  double duration_s;
  double focus_m;            ///< Focus distance of the thermal camera.
  double max_wrong_percent;  ///< With all rules of the pipeline.
  bool defeats_algorithm4;   ///< Algorithm 4, with the other rules, must not do as well.
};

/// Counts wrongly assigned points and what is covered at all: without a filter, with algorithm 4
/// as the thesis has it and with the pipeline's other rules, with the pipeline's visibility, and
/// with each of its other rules switched off in turn.
Result<ExperimentReport> CompareParallaxFilters(const HiddenSurfaceSetup& setup, ThreadPool& pool);

}  // namespace isotherm
