#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "common/base/status.h"

namespace isotherm {

class SimulationOptions;
class ThreadPool;

/// The names of all scenes: "a, b, c".
std::string SceneNames();

/// Chooses the scene by its name, e.g. "furnace-door".
Status SetScene(const std::string& name, SimulationOptions& options);

/// Renders into a file that gets its name when it is complete.
Status RenderToFile(const SimulationOptions& options, const std::filesystem::path& path,
                    bool overwrite, ThreadPool& pool,
                    const std::function<void(double fraction)>& progress,
                    const std::stop_token& stop = {});

/// `threads`, or one per core for 0.
int ChosenThreads(int threads);

}  // namespace isotherm
