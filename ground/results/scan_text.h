#pragma once

#include <string>

#include "ground/calibration/calibration_check.h"
#include "ground/export/result_files.h"
#include "ground/interpretation/interpretation.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// Returns a finished scan on one screen, for the user: frames, surface, temperatures, time.
std::string SummaryText(const ScanModel& scan, const GroundOptions& options,
                        const CalibrationCheckReport& calibration, const ResultSummary& summary,
                        const Interpretation& interpretation);

}  // namespace isotherm
