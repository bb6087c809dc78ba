#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>

#include "common/base/status.h"

namespace isotherm {

class SimulationOptions;

/// Writes the true surface in `world`, 2 mm between samples, with how many poses of the scan (one
/// in ten) see each.
Status WriteTrueSurface(const SimulationOptions& options, const std::filesystem::path& path,
                        const std::function<void(double fraction)>& progress = {},
                        const std::stop_token& stop = {});

}  // namespace isotherm
