#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "common/recording/recording.h"

namespace isotherm {

class SimulationOptions;

/// Gets the fraction that is done, 0..1. Called from the calling thread.
using SimulationProgress = std::function<void(double fraction)>;

/// Renders a simulated scan into a recording: depth and thermal frames, NUC events, the rig, ground
/// truth and the options (metadata `simulation`). A frame's capture time is the true middle of its
/// exposure; its device ticks and its arrival carry the errors of the simulated clocks. Poses in
/// stream "groundtruth" are T_world_depth at the true exposures of the depth frames. The file
/// depends on the options only, not on the number of threads. A stop request ends the rendering
/// with kUnavailable and leaves an incomplete file.
Status RenderRecording(const SimulationOptions& options, const std::filesystem::path& path,
                       ThreadPool& pool, const SimulationProgress& progress,
                       std::stop_token stop = {}, ImageStorage storage = ImageStorage::kCompact);

/// Path of the recording that the options describe, rendered only if it is not there yet. Images
/// are raw: what replays it should load the machine no more than a camera does. It gets
/// its name when it is complete, so that an interrupted run leaves nothing that looks like a scan.
/// Several processes may do this at the same time.
Result<std::filesystem::path> CachedRecording(const SimulationOptions& options,
                                              const std::filesystem::path& cache_dir,
                                              ThreadPool& pool, const SimulationProgress& progress,
                                              std::stop_token stop = {});

/// $XDG_CACHE_HOME/isotherm, or ~/.cache/isotherm, or, without a home, isotherm in the folder for
/// temporary files.
std::filesystem::path DefaultCacheDir();

/// Name of the options' recording in the cache: scene, duration and a hash of everything that its
/// content depends on, the renderer's version included.
Result<std::string> CacheFileName(const SimulationOptions& options);

}  // namespace isotherm
