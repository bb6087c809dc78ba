#pragma once

#include <cstdint>
#include <vector>

#include "common/simulation/simulation_options.pb.h"
#include "ground/experiment/experiment.h"

namespace isotherm {

/// Says which scenes are scanned, by whom, and for how long at most.
struct GuidanceTrial {
  std::vector<SimulatedScene> scenes;
  std::vector<std::uint64_t> persons;  ///< A seed each.
  double max_duration_s = 0.0;
};

/// Has every scene scanned by every person in every way: guided, by advice only, along a fixed
/// raster at the speed at which smear is good, and along it at the thesis's speed.
Result<ExperimentReport> CompareGuidance(const GuidanceTrial& trial, ThreadPool& pool);

}  // namespace isotherm
