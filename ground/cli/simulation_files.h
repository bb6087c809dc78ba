#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/base/status.h"

namespace isotherm {

class SimulationOptions;
class ThreadPool;

/// Chooses the scene by its name, e.g. "furnace-door".
Status SetScene(const std::string& name, SimulationOptions& options);

/// Renders into a file that gets its name when it is complete.
Status RenderToFile(const SimulationOptions& options, const std::filesystem::path& path,
                    bool overwrite, ThreadPool& pool,
                    const std::function<void(double fraction)>& progress);

/// The true surface in `world`, 2 mm between samples, with how many poses of the scan (one in ten)
/// see each.
Status WriteTrueSurface(const SimulationOptions& options, const std::filesystem::path& path);

/// `threads`, or one per core for 0.
int ChosenThreads(int threads);

}  // namespace isotherm
