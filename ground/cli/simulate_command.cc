#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "common/base/progress.h"
#include "common/base/service.h"
#include "common/options/override.h"
#include "common/options/text_proto.h"
#include "common/recording/recording.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/true_surface.h"
#include "ground/cli/command.h"
#include "ground/cli/simulation_files.h"

namespace isotherm {
namespace {

constexpr const char* kSimulateFooter =
    R"(The recording holds depth and thermal frames with the noise and the clocks of real cameras, a
shutter event, the calibration and the true poses. --surface writes the true surface for
`isotherm evaluate`.

Examples:
  isotherm simulate --scene furnace-door -o door.mcap --surface door.ply
  isotherm reconstruct door.mcap -o out --initial-pose-from door.mcap
  isotherm evaluate out --groundtruth door.mcap --surface door.ply --emissivity 0.96 --ambient 23)";

struct SimulateArguments {
  std::string scene = "furnace-door", output, surface, config;
  std::optional<double> duration_s;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> overrides;
  bool force = false;
  int threads = 0;
};

Status CollectOptions(const SimulateArguments& arguments, SimulationOptions& options) {
  if (!arguments.config.empty()) ISOTHERM_RETURN_IF_ERROR(LoadTextProto(arguments.config, options));
  ISOTHERM_RETURN_IF_ERROR(SetScene(arguments.scene, options));
  if (arguments.duration_s) options.set_duration_s(*arguments.duration_s);
  if (arguments.seed) options.set_seed(*arguments.seed);
  for (const std::string& assignment : arguments.overrides) {
    ISOTHERM_RETURN_IF_ERROR(ApplyOverride(assignment, options).WithContext("--set"));
  }
  if (!(options.duration_s() > 0.0)) {
    return InvalidArgument(
        fmt::format("--duration must be above 0 s, got {:g}: a scan without frames is none",
                    options.duration_s()));
  }
  return Validate(options);
}

int Run(const SimulateArguments& arguments) {
  SimulationOptions options;
  if (const Status status = CollectOptions(arguments, options); !status.ok()) {
    return FailConfiguration(status.message());
  }
  const StopSignal signal;  // Before any other thread.
  ThreadPool pool(ChosenThreads(arguments.threads));
  ProgressBar progress("simulating", 0, "");
  const Status status = RenderToFile(
      options, arguments.output, arguments.force, pool,
      [&](double fraction) { progress.Update(fraction); }, signal.token());
  if (status.ok()) progress.Finish();
  if (!status.ok()) return Fail(status);
  fmt::print("{}: {} s of {}\n", arguments.output, options.duration_s(), SceneName(options));
  if (arguments.surface.empty()) return 0;
  ProgressBar surface_progress("true surface", 0, "");
  const Status surface = WriteTrueSurface(
      options, arguments.surface, [&](double fraction) { surface_progress.Update(fraction); },
      signal.token());
  if (!surface.ok()) return Fail(surface);
  surface_progress.Finish();
  return 0;
}

}  // namespace

void AddSimulateCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("simulate", "Renders a simulated scan, with truth, into a recording");
  auto arguments = std::make_shared<SimulateArguments>();
  command->add_option("--scene", arguments->scene, SceneNames())->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Recording to write (.mcap)")->required();
  command->add_option("--surface", arguments->surface, "True surface to write (.ply)");
  command->add_option("--duration", arguments->duration_s, "Length of the scan, seconds");
  command->add_option("--seed", arguments->seed, "Everything random follows from it");
  command->add_option("--config", arguments->config,
                      "Configuration file (text format of isotherm.SimulationOptions)");
  command->add_option("--set", arguments->overrides, "Override an option: depth.rate_hz=60")
      ->take_all();
  command->add_option("--threads", arguments->threads, "Threads; 0 = one per core");
  command->add_flag("--force", arguments->force, "Replace an existing recording");
  command->footer(kSimulateFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
