#pragma once

#include <filesystem>
#include <string>

#include "ground/feedback/model_coverage.h"
#include "ground/service/scan_board.h"

namespace isotherm {

/// Returns what the operator should do next, for the end of a scan's summary: reconstruct the
/// recording again if work was left out of the live scan, and which part of the surface to go on
/// with, or that the scan is done. `recording` is empty if there is none here.
std::string ConclusionText(const BehindCounts& behind, const SurfaceAreas& areas,
                           double done_fraction, const std::filesystem::path& recording);

}  // namespace isotherm
