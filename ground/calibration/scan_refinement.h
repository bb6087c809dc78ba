#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "common/base/status.h"
#include "ground/calibration/rig_refinement.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

struct ScanModel;

/// RefinePlacement by a scan's poses and surface and its thermal `frames` (by time; `visible` need
/// not be filled). Afterwards `views` show the scan from where the last step began. Fails and says
/// what the scan lacks. `progress` gets the fraction done, 0..1.
Result<Refinement> RefineByScan(const ScanModel& scan, const std::vector<StampedThermal>& frames,
                                const ThermalPlacement& before, const RefinementPrior& prior,
                                ScanViews& views, const std::function<void(double)>& progress,
                                const std::stop_token& stop = {});

}  // namespace isotherm
