#pragma once

#include <span>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulated_scan.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

inline constexpr double kHotBar_celsius = 80.0, kColdBar_celsius = 40.0;

/// A resolution target in a panel: groups of hot and cold bars of these widths, flush, so that only
/// the camera's resolution blurs them. Black bodies. The rig looks at it from `distance_m`.
StagedScene MakeResolutionTarget(std::span<const double> bar_widths_m, const Swing& distance_m);

/// The bars of one width.
struct BarGroup {
  double contrast = 0.0;          ///< Between the middles of hot and cold bars, of the true one.
  double coverage_percent = 0.0;  ///< Points of these middles that have a temperature.
};
/// As many as there are widths.
std::vector<BarGroup> MeasureBars(const SimulatedScan& scan, const ScanModel& model,
                                  std::span<const double> bar_widths_m, ThreadPool& pool);

}  // namespace isotherm
