#include "ground/cli/simulation_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "common/base/partial_file.h"
#include "common/concurrency/thread_pool.h"
#include "common/options/nearest_name.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/surface_sampling.h"

namespace isotherm {
namespace {

// The default voxel: truth need not be finer than what is compared with it.
constexpr double kSampleSpacing_m = 0.002;
// Every tenth pose counts what is seen: 30 degrees a second move little in a third of a second.
constexpr std::size_t kPoseStep = 10;

}  // namespace

std::string SceneNames() {
  std::vector<std::string> names;
  SimulationOptions options;
  for (int value = SimulatedScene_MIN; value <= SimulatedScene_MAX; ++value) {
    if (!SimulatedScene_IsValid(value)) continue;
    options.mutable_scene()->set_scene(static_cast<SimulatedScene>(value));
    names.push_back(SceneName(options));
  }
  return JoinNames(names);
}

Status SetScene(const std::string& name, SimulationOptions& options) {
  std::vector<std::string> names;
  for (int value = SimulatedScene_MIN; value <= SimulatedScene_MAX; ++value) {
    if (!SimulatedScene_IsValid(value)) continue;
    options.mutable_scene()->set_scene(static_cast<SimulatedScene>(value));
    names.push_back(SceneName(options));
    if (names.back() == name) return OkStatus();
  }
  return InvalidArgument(fmt::format("there is no scene '{}'.{} Known: {}", name,
                                     DidYouMean(name, names), JoinNames(names)));
}

Status RenderToFile(const SimulationOptions& options, const std::filesystem::path& path,
                    bool overwrite, ThreadPool& pool,
                    const std::function<void(double fraction)>& progress,
                    const std::stop_token& stop) {
  const Result<PartialFile> target = PartialFile::Create(path, overwrite);
  if (!target) return target.error();
  ISOTHERM_RETURN_IF_ERROR(RenderRecording(options, target->path(), pool, progress, stop));
  return target->Commit();
}

Status WriteTrueSurface(const SimulationOptions& options, const std::filesystem::path& path,
                        const std::function<void(double fraction)>& progress,
                        const std::stop_token& stop) {
  const Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(options);
  if (!scan) return scan.error();
  std::vector<SurfaceSample> samples = SampleSurface((*scan)->scene(), kSampleSpacing_m);
  const Rig& rig = (*scan)->rig();
  const double max_depth_m = options.depth().expert().max_depth_m();
  const auto& times = (*scan)->depth_times();
  for (std::size_t i = 0; i < times.size(); i += kPoseStep) {
    if (stop.stop_requested()) return Unavailable("writing the true surface was interrupted");
    if (progress) progress(static_cast<double>(i) / static_cast<double>(times.size()));
    const CaptureTime time = times[i].exposure;
    CountSeen((*scan)->scene(), *rig.depth, (*scan)->PoseAt(time), max_depth_m, SeenBy::kDepth,
              samples);
    CountSeen((*scan)->scene(), *rig.thermal, (*scan)->ThermalPoseAt(time), max_depth_m,
              SeenBy::kThermal, samples);
  }
  return WriteSurfacePly(path, samples);
}

int ChosenThreads(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace isotherm
