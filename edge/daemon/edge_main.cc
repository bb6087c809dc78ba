// isotherm-edge: the command line. What it does is in edge_daemon.cc, how in edge_pipeline.cc.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "common/base/log.h"
#include "common/base/service.h"
#include "common/base/status.h"
#include "common/options/daemon_arguments.h"
#include "common/options/text_proto.h"
#include "common/time/clock.h"
#include "common/transport/transport_environment.h"
#include "edge/daemon/edge_daemon.h"
#include "edge/daemon/make_camera.h"
#include "edge/daemon/rig_name.h"
#include "edge/daemon/validate_options.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

constexpr const char* kDescription =
    "Captures depth and thermal frames, stamps them, follows the thermal camera's shutter, records "
    "them and\n"
    "publishes them over DDS to isotherm-ground. By default it simulates a scan; --source says "
    "where frames come from.";

constexpr const char* kFooter =
    "Examples:\n"
    "  isotherm-edge                                       a simulated furnace door, in real time\n"
    "  isotherm-edge --source cameras --rig rig.textproto --record /data/   the cameras\n"
    "  isotherm-edge --recording scan.mcap --exit-at-end   a recording, once\n"
    "  isotherm-edge --recording scan.mcap --rate 0 --wait-for-ground --exit-at-end\n"
    "                                                      ... as fast as the ground takes it, "
    "nothing dropped\n"
    "  isotherm-edge --config /etc/isotherm/edge.textproto --set "
    "timestamper.expert.depth_window=31\n"
    "\n"
    "SIGTERM, SIGHUP and Ctrl-C end it with everything flushed: within two seconds in every state "
    "of the link. A\n"
    "camera that does not end gets 1.75 s and a disk that does not answer 3.5 s before they are "
    "left behind; after\n"
    "eight seconds it is gone in any case. At the end it prints what became of each frame: "
    "captured = recorded +\n"
    "dropped by reason, captured = published + dropped by reason.\n"
    "\n"
    "Options come from the defaults, the configuration file, --set and the other options, the "
    "later ones winning.\n"
    "The network is chosen by CYCLONEDDS_URI (default: loopback only).\n"
    "\n"
    "What the ground lacks (after an outage of the link, or because it came late) is sent to it "
    "from "
    "the recording, beside\n"
    "what is being captured; a scan is over when the ground has it, or takes nothing for "
    "link.expert.linger_s. The status says\n"
    "how much is still to come.\n"
    "\n"
    "A scan ends with its source, or when the ground orders it to stop (isotherm scan --stop, or "
    "the console); the\n"
    "recording is closed then, and isotherm scan --start begins the next one, with a recording of "
    "its own. With\n"
    "--exit-at-end the program leaves instead.\n"
    "\n"
    "A camera, a network interface or a disk that is missing, at the start or later, is waited for "
    "and asked for in\n"
    "the status; the rest goes on. With --exit-at-end, which is for scripts, what is missing at "
    "the start ends it.\n"
    "\n"
    "Exit status:\n"
    "   0  ended by a signal or at the end of the source\n"
    "  64  wrong command line\n"
    "  65  the recording or calibration is damaged\n"
    "  66  a file does not exist\n"
    "  69  the network or the source is not available (--exit-at-end)\n"
    "  73  the recording cannot be created (--exit-at-end), or is not complete: the disk was full "
    "or failed, and\n"
    "      publishing went on\n"
    "  74  reading failed\n"
    "  78  wrong configuration (all problems are listed)";

struct CommandLine {
  DaemonArguments shared;
  std::optional<std::string> source, recording, scene, depth_camera, rig, record, edge_id;
  std::optional<double> rate;
  std::optional<int> domain;
  bool exit_at_end = false;
  bool wait_for_ground = false;
  bool wait_for_order = false;
  bool list_sources = false;
  bool list_devices = false;
  std::string camera_process, camera_options;
};

void Declare(CLI::App& app, CommandLine& line) {
  app.description(kDescription);
  app.footer(kFooter);
  app.set_version_flag("--version", "isotherm-edge " ISOTHERM_VERSION);
  DeclareConfiguration(app, line.shared);
  app.add_option("--source", line.source, "Where frames come from: cameras, replay or synthetic")
      ->check(CLI::IsMember({"cameras", "replay", "synthetic"}))
      ->type_name("KIND");
  app.add_option("--recording", line.recording, "Recording to replay (implies --source replay)")
      ->type_name("FILE");
  app.add_option("--scene", line.scene,
                 "Scene to simulate (implies --source synthetic), see --list-sources")
      ->type_name("NAME");
  app.add_option(
         "--depth-camera", line.depth_camera,
         "OpenNI2's address of the depth camera or an .oni file (implies --source cameras); "
         "default: the first one found")
      ->type_name("URI");
  app.add_option("--rig", line.rig, "Rig calibration (rig.textproto); default: the source's own")
      ->type_name("FILE");
  app.add_option("--rate", line.rate, "Speed: 1 = real time, 0 = as fast as the rest can follow")
      ->type_name("FACTOR");
  app.add_option("--record", line.record,
                 "Record into FILE, or into a new file in folder FILE; \"off\" = do not")
      ->type_name("FILE");
  app.add_option("--edge-id", line.edge_id,
                 "Name of this rig on the link; \"\" = that of this computer")
      ->type_name("NAME");
  app.add_option("--domain", line.domain, "DDS domain, 0..230")->type_name("N");
  app.add_flag("--exit-at-end", line.exit_at_end, "Leave when the source has ended");
  app.add_flag("--wait-for-ground", line.wait_for_ground,
               "Hold back the first frame until a ground station is there");
  app.add_flag("--wait-for-order", line.wait_for_order,
               "Begin no scan before isotherm scan --start");
  DeclareLogLevel(app, line.shared);
  app.add_flag("--list-sources", line.list_sources,
               "List sources, scenes and connected cameras, then leave");
  app.add_flag("--list-devices", line.list_devices, "List connected cameras, then leave");
  // How this program starts itself for a camera whose library may crash; not for people.
  app.add_option("--camera-process", line.camera_process)
      ->check(CLI::IsMember({"depth", "thermal"}))
      ->group("");
  app.add_option("--camera-options", line.camera_options)->group("");
}

// FURNACE_DOOR in the configuration is furnace-door on the command line.
std::string SpokenName(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '_' ? '-' : static_cast<char>(std::tolower(c));
  });
  return name;
}

void ListSources() {
  std::puts("cameras     the cameras of this computer (--source cameras)");
  std::puts("replay      a recording (--recording FILE)");
  std::puts(
      "synthetic   a simulated scan (--scene NAME), rendered once and kept in the cache. Scenes:");
  const auto* scenes = SimulatedScene_descriptor();
  for (int i = 0; i < scenes->value_count(); ++i) {
    std::printf("              %s\n", SpokenName(scenes->value(i)->name()).c_str());
  }
}

Status ApplyScene(const std::string& name, SourceOptions& options) {
  const auto* scenes = SimulatedScene_descriptor();
  for (int i = 0; i < scenes->value_count(); ++i) {
    if (SpokenName(scenes->value(i)->name()) != SpokenName(name)) continue;
    options.set_kind(SYNTHETIC);
    options.mutable_simulation()->mutable_scene()->set_scene(
        static_cast<SimulatedScene>(scenes->value(i)->number()));
    return OkStatus();
  }
  return InvalidArgument("--scene " + name + ": no such scene; --list-sources names them");
}

SourceKind KindNamed(const std::string& name) {
  if (name == "cameras") return CAMERAS;
  return name == "replay" ? REPLAY : SYNTHETIC;
}

Status ApplyCommandLine(const CommandLine& line, EdgeOptions& options) {
  ISOTHERM_RETURN_IF_ERROR(Apply(line.shared, options));
  SourceOptions& source = *options.mutable_source();
  if (line.scene) ISOTHERM_RETURN_IF_ERROR(ApplyScene(*line.scene, source));
  if (line.recording) {
    source.set_kind(REPLAY);
    source.set_recording(*line.recording);
  }
  if (line.depth_camera) {
    source.set_kind(CAMERAS);
    source.mutable_depth_camera()->set_uri(*line.depth_camera);
  }
  // Behind the options that imply a source: what is said outright wins.
  if (line.source) source.set_kind(KindNamed(*line.source));
  if (line.rig) source.set_rig_file(*line.rig);
  if (line.rate) source.set_rate(*line.rate);
  if (line.record) options.mutable_spool()->set_record(*line.record);
  if (line.edge_id) options.mutable_link()->set_edge_id(*line.edge_id);
  // After all that may name it. Two rigs with the default of one file would push each other out.
  if (options.link().edge_id().empty()) options.mutable_link()->set_edge_id(HostRigName());
  if (line.domain) options.mutable_link()->set_domain(*line.domain);
  if (line.wait_for_ground) options.mutable_link()->set_wait_for_ground(true);
  if (line.wait_for_order) options.mutable_link()->set_wait_for_order(true);
  if (line.exit_at_end) options.set_exit_at_end(true);
  return OkStatus();
}

int FailConfiguration(const Status& status) {
  LOG(Edge, Error) << status.message();
  return ConfigurationExitCode(status);
}

int Main(int argc, char** argv) {
  CLI::App app;
  CommandLine line;
  Declare(app, line);
  if (const std::optional<int> ended = Parse(app, argc, argv, line.shared)) return *ended;
  // Before any thread or signal handler of the edge exists: the child must be nothing but a camera.
  if (!line.camera_process.empty()) {
    return RunCameraProcess(line.camera_process, line.camera_options, SystemClock());
  }
  if (line.list_sources) ListSources();
  if (line.list_sources || line.list_devices) {
    std::fputs(ListCameras().c_str(), stdout);
    return 0;
  }
  EdgeOptions options;
  if (const Status applied = ApplyCommandLine(line, options); !applied.ok()) {
    return FailConfiguration(applied);
  }
  if (const std::vector<Status> problems = ValidateAll(options); !problems.empty()) {
    std::string text = "wrong configuration:";
    for (const Status& problem : problems) text += "\n" + problem.message();
    return FailConfiguration(InvalidArgument(text));
  }
  LOG(Edge, Debug) << "effective configuration:\n" << ToTextProto(options);

  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  UseSmallPages();
  ShareFreedMemory();
  const StopSignal signal;
  return RunEdge(options, environment, clock, signal);
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) { return isotherm::Main(argc, argv); }
