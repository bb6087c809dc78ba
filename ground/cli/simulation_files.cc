#include "ground/cli/simulation_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "common/base/partial_file.h"
#include "common/concurrency/thread_pool.h"
#include "common/options/nearest_name.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
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

int ChosenThreads(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace isotherm
