// isotherm-ground: the command line. What it does is in ground_service.cc.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
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
#include "ground/option_validation/validate_options.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/ground_service.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

constexpr const char* kDescription =
    "Receives depth and thermal frames from isotherm-edge over DDS, tracks the rig, builds the "
    "surface, assigns\n"
    "temperatures where they were measured under good conditions, and tells the edge what is still "
    "to be scanned.";

constexpr const char* kFooter =
    "Examples:\n"
    "  isotherm-ground --output /tmp/scans              a folder per scan, until stopped\n"
    "  isotherm-ground --output out/scan --once         one scan straight into out/scan, then "
    "leave\n"
    "  isotherm-ground --config /etc/isotherm/ground.textproto --set volume.voxel_size_m=0.003\n"
    "\n"
    "Each scan leaves scan.mcap (what was received), cloud.ply, mesh.ply, trajectory.txt, renders/ "
    "and stats.json.\n"
    "What came too late for the model (after an outage of the link, or before this program was "
    "started) is put into\n"
    "scan.mcap when the scan has ended, and the results are made anew with it; a signal ends that "
    "early.\n"
    "SIGTERM, SIGHUP and Ctrl-C end it with everything flushed, as soon as the results of the scan "
    "are written. A disk\n"
    "that does not answer is left behind: the recording after 1.5 s, results after 30 s.\n"
    "The network is chosen by CYCLONEDDS_URI (default: loopback only). Options come from the "
    "defaults, the\n"
    "configuration file, --set and the other options, the later winning.\n"
    "\n"
    "Exit status:\n"
    "   0  ended by a signal, or the one scan is done\n"
    "  64  wrong command line\n"
    "  65  the rig's calibration is not usable\n"
    "  66  a file does not exist\n"
    "  69  the network is not available (--once; a service waits for it)\n"
    "  73  results or recording cannot be written, or the disk is full\n"
    "  74  writing failed\n"
    "  78  wrong configuration (all problems are listed)";

struct CommandLine {
  DaemonArguments shared;
  std::optional<std::string> output, edge_id;
  std::optional<int> domain, threads;
  bool once = false;
  bool no_record = false;
};

void Declare(CLI::App& app, CommandLine& line) {
  app.description(kDescription);
  app.footer(kFooter);
  app.set_version_flag("--version", "isotherm-ground " ISOTHERM_VERSION);
  DeclareConfiguration(app, line.shared);
  app.add_option("--output", line.output, "Where recordings and results go")->type_name("DIR");
  app.add_option("--edge-id", line.edge_id, "The rig to follow; \"\" = the first one seen")
      ->type_name("NAME");
  app.add_option("--domain", line.domain, "DDS domain, 0..230")->type_name("N");
  app.add_option("--threads", line.threads, "Threads of the reconstruction, 0 = one per core")
      ->type_name("N");
  app.add_flag("--once", line.once,
               "Serve one scan, write its results into DIR itself, then leave");
  app.add_flag("--no-record", line.no_record, "Do not record what is received");
  DeclareLogLevel(app, line.shared);
}

Status ApplyCommandLine(const CommandLine& line, GroundOptions& options) {
  ISOTHERM_RETURN_IF_ERROR(Apply(line.shared, options));
  LiveOptions& live = *options.mutable_live();
  if (line.output) live.set_output_dir(*line.output);
  if (line.edge_id) live.set_edge_id(*line.edge_id);
  if (line.domain) live.set_domain(*line.domain);
  if (line.no_record) live.set_record(false);
  if (line.threads) options.set_threads(*line.threads);
  return OkStatus();
}

int Main(int argc, char** argv) {
  CLI::App app;
  CommandLine line;
  Declare(app, line);
  if (const std::optional<int> ended = Parse(app, argc, argv, line.shared)) return *ended;
  GroundOptions options;
  if (const Status applied = ApplyCommandLine(line, options); !applied.ok()) {
    LOG(Ground, Error) << applied.message();
    return ConfigurationExitCode(applied);
  }
  if (const std::vector<Status> problems = ValidateAll(options); !problems.empty()) {
    for (const Status& problem : problems) LOG(Ground, Error) << problem.message();
    return kExitConfiguration;
  }
  *options.mutable_thermal() = WithAnglesOfMaterial(options.thermal());
  LOG(Ground, Debug) << "effective configuration:\n" << ToTextProto(options);
  ShareFreedMemory();
  StopSignal signal;
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  return RunGround(options, {line.once}, environment, clock, signal);
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) { return isotherm::Main(argc, argv); }
