#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm {

/// A focus for scans whose distances vary more than a lens of f/0.8 has depth of field.
inline constexpr double kSharpEverywhere = 0.0;

/// Cameras of the thesis's rig for a scan of some seconds, without shutter events, and with as many
/// thermal frames as are needed. The operator has focused the thermal camera at `focus_m`; 0 = a
/// lens that is sharp everywhere.
SimulationOptions ExperimentCameras(double duration_s, double focus_m);

/// Defaults, but slanted surfaces get temperatures, too: good up to 40 degrees from the normal and
/// acceptable up to 60, whatever the material.
GroundOptions OptionsForSlantedSurfaces();

/// A path's value that goes from one end to the other and rests at both.
Swing FromTo(double from, double to, double duration_s);

/// Who gets the frames of a scan, in order of capture time.
struct FrameSinks {
  std::function<void(const DepthFrame&)> depth;
  std::function<void(const ThermalFramePtr&)> thermal;
};

/// Renders all frames of a scan at their true capture times and hands them on as an edge would that
/// makes no errors: thermal frames are valid unless the shutter was closed.
void PlayScan(const SimulatedScan& scan, ThreadPool& pool, const FrameSinks& sinks);

/// The real pipeline at the start of a scan: the first pose is the true one, the others are
/// tracked.
Result<std::unique_ptr<GroundPipeline>> StartPipeline(GroundOptions options,
                                                      const SimulatedScan& scan,
                                                      const ThreadPool& pool);

/// An experiment says nothing when the rig was lost.
Status CheckTracked(const ScanModel& model);

/// A scan, and pipelines with options of their own that all get its frames.
struct PlayedScan {
  std::unique_ptr<SimulatedScan> scan;
  std::vector<std::unique_ptr<GroundPipeline>> pipelines;
};
/// Plays the whole scan to one pipeline per `options`.
Result<PlayedScan> Play(const SimulationOptions& cameras, StagedScene staged,
                        const std::vector<GroundOptions>& options, ThreadPool& pool);

}  // namespace isotherm
