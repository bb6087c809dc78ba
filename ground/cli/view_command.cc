#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "common/base/service.h"
#include "common/recording/recording.h"
#include "common/time/clock.h"
#include "ground/cli/command.h"
#include "ground/cli/scan_arguments.h"
#include "ground/console/console.h"
#include "ground/model/load_model.h"
#include "ground/playback/player.h"
#include "ground/results/result_folder.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kViewFooter =
    R"(SCAN is a result folder (or its model.iso), whose surface is shown and measured as it is, or a recording (.mcap), which is
reconstructed while it plays: the page has a time line, from a quarter of its speed to eight times. Shapes are kept in the
folder's shapes.json. Ends with Ctrl-C. The page is that of isotherm-ground (docs/console.md).

Examples:
  isotherm view out/scan
  isotherm view out/scan/scan.mcap
  isotherm view out/scan --port 8081 --no-browser
  isotherm view out/scan --set console.address=\"0.0.0.0\"    for a tablet: encrypted, with a code)";

struct ViewArguments {
  std::string scan;
  ScanArguments recording;
  std::optional<int> port;
  bool no_browser = false;
};

bool IsRecording(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && path.extension() == ".mcap";
}

/// A folder of this user's for certificate and codes; results may be somebody else's.
std::string StateFolder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state != '\0') return std::string(state) + "/isotherm";
  const char* const home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? std::string(home) + "/.local/state/isotherm"
                                          : (fs::temp_directory_path() / "isotherm").string();
}

/// Applies what is the default of a view, where nobody else needs the processor.
void ApplyViewDefaults(const ViewArguments& arguments, GroundOptions& options) {
  ConsoleOptions& console = *options.mutable_console();
  if (arguments.port) console.set_port(*arguments.port);
  if (console.state_dir().empty()) console.set_state_dir(StateFolder());
  console.mutable_expert()->set_mesh_cores(1.0);
}

void OpenBrowser(const std::string& address, bool wanted) {
  const char* const display = std::getenv("DISPLAY");
  const char* const wayland = std::getenv("WAYLAND_DISPLAY");
  if (!wanted || (display == nullptr && wayland == nullptr)) return;
  const pid_t child = fork();
  if (child != 0) return;
  std::freopen("/dev/null", "w", stderr);
  std::freopen("/dev/null", "w", stdout);
  execlp("xdg-open", "xdg-open", address.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

void Announce(const Console& console, const ViewArguments& arguments) {
  fmt::print("{}\n", console.HowToComeIn(::isatty(STDOUT_FILENO) == 1));
  std::fflush(stdout);
  OpenBrowser(console.address(), !arguments.no_browser);
}

/// A finished model and what belongs to it, kept as long as it is shown.
Status ShowModel(const fs::path& path, GroundOptions options, Console& console) {
  Result<LoadedModel> loaded = LoadModel(path, options);
  if (!loaded) return loaded.error();
  const auto model = std::make_shared<LoadedModel>(std::move(*loaded));
  const fs::path folder = path.parent_path();
  RigDescription rig;
  rig.rig = model->rig;
  ScanBegun scan;
  scan.scan = 1;
  const std::string name = fs::absolute(folder).lexically_normal().filename().string();
  scan.description = DescribeScan(options, rig, name, folder.string());
  scan.description.set_phase(live::Scan::FINISHED);
  scan.folder = folder;
  scan.measuring = MakeMeasuringOptions(options, model->rig.thermal_sensor);
  ScanEnded end;
  end.scan = scan.scan;
  end.phase = live::Scan::FINISHED;
  end.maps.push_back({.tsdf = {model, model->tsdf.get()},
                      .thermal = {model, model->thermal.get()},
                      .place = {RigidTransform::Identity(), true}});
  end.path = model->known_poses;
  console.Show(std::move(scan), std::move(end));
  return OkStatus();
}

void WaitForStop(const StopSignal& signal) {
  constexpr auto kTick = std::chrono::milliseconds(100);
  while (!signal.token().stop_requested()) std::this_thread::sleep_for(kTick);
}

int ViewResult(const ViewArguments& arguments, GroundOptions options) {
  const auto path = FindModel(arguments.scan);
  if (!path) return Fail(path.error());
  if (const auto made_with = ConfigurationOf(path->parent_path())) {
    const ConsoleOptions console = options.console();
    options = *made_with;
    *options.mutable_console() = console;
  }
  ApplyViewDefaults(arguments, options);
  StopSignal signal;
  const SystemClock clock{};
  const auto console = Console::Start(options, clock, {});
  if (!console) return Fail(console.error().WithContext("the console"));
  if (const Status shown = ShowModel(*path, options, **console); !shown.ok()) return Fail(shown);
  Announce(**console, arguments);
  WaitForStop(signal);
  return 0;
}

int ViewRecording(const ViewArguments& arguments, const ReconstructRequest& request) {
  GroundOptions options = request.options;
  ApplyViewDefaults(arguments, options);
  StopSignal signal;
  const SystemClock clock{};
  std::unique_ptr<Player> player;
  Mutex mutex;
  ConsoleServices services;
  services.play = [&](const live::PlaybackControl& control) {
    const MutexLock lock(mutex);
    if (player) player->Control(control);
  };
  services.playback = [&] {
    const MutexLock lock(mutex);
    return player ? player->state() : live::Playback();
  };
  const auto console = Console::Start(options, clock, std::move(services));
  if (!console) return Fail(console.error().WithContext("the console"));
  Result<std::unique_ptr<Player>> opened =
      Player::Open(clock, options, arguments.scan, (*console)->feed());
  if (!opened) return Fail(opened.error());
  {
    const MutexLock lock(mutex);
    player = std::move(*opened);
  }
  Announce(**console, arguments);
  while (!signal.token().stop_requested()) {
    const Nanoseconds wait = player->Step();
    if (wait > Nanoseconds(0)) std::this_thread::sleep_for(wait);
  }
  return 0;
}

int Run(const ViewArguments& arguments) {
  ReconstructRequest request;
  if (const int status = CollectScanOptions(arguments.recording, request); status != 0)
    return status;
  return IsRecording(arguments.scan) ? ViewRecording(arguments, request)
                                     : ViewResult(arguments, request.options);
}

}  // namespace

void AddViewCommand(CLI::App& app, CommandBody& body) {
  CLI::App* command =
      app.add_subcommand("view", "Shows a finished scan, or plays a recording, in the console");
  auto arguments = std::make_shared<ViewArguments>();
  command->add_option("scan", arguments->scan, "Result folder, model (model.iso) or recording")
      ->required();
  command->add_option("--port", arguments->port, "Port to serve on; 0 = any that is free")
      ->check(CLI::Range(0, 65535));
  command->add_flag("--no-browser", arguments->no_browser,
                    "Only say the address; otherwise a browser is opened if there is a display");
  AddScanOptions(*command, arguments->recording);
  command->footer(kViewFooter);
  command->callback([arguments, &body] { body = [arguments] { return Run(*arguments); }; });
}

}  // namespace isotherm
