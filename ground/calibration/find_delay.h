#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "ground/calibration/delay_search.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

/// Holds the search and the sample of the surface that it compares images on.
struct FindDelayOptions {
  DelaySearchOptions search;
  std::size_t coarse_points = 6000;  ///< Points on the surface for the grid; more: slower.
  std::size_t fine_points = 30'000;  ///< For the result and its uncertainty.
};

/// The delay, to be added to the stamps, at which the thermal images of a scan agree about the
/// surface: those of each part of the scan by itself if the rig reverses within seconds. Its sigma
/// holds, beside the spread of the parts, up to a millisecond for what is wrong in all of them
/// alike, and what the drift of the poses can be taken for (DelaySigmaOfDrift).
/// Fails and says what the scan lacks. Deterministic. `progress` gets the fraction done, 0..1.
Result<DelayEstimate> FindDelay(const ScanViews& views, const FindDelayOptions& options,
                                ThreadPool& pool, const std::function<void(double)>& progress);

/// Returns what to tell the user of an estimate whose uncertainty is mostly that of drifting poses,
/// since the rig hardly reversed; empty for others.
std::string HintOfDrift(const DelayEstimate& estimate);

}  // namespace isotherm
