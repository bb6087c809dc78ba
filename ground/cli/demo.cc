#include "ground/cli/demo.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <utility>

#include "common/base/child_process.h"
#include "common/base/progress.h"
#include "common/concurrency/thread_pool.h"
#include "common/recording/recording.h"
#include "common/simulation/options.h"
#include "common/simulation/render_recording.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/true_surface.h"
#include "ground/cli/simulation_files.h"
#include "ground/evaluation/true_poses.h"
#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

// Emissivity of painted surfaces in the simulated scenes.
constexpr double kEmissivity = 0.96;
// Less than half a frame period, more than the stamping error.
constexpr double kStampTolerance_ms = 10.0;
constexpr char kRecordingName[] = "scan.mcap";
constexpr char kSurfaceName[] = "true_surface.ply";

Result<SimulationOptions> Simulation(const DemoRequest& request) {
  SimulationOptions options;
  if (Status status = SetScene(request.scene, options); !status.ok()) return Err(std::move(status));
  options.set_duration_s(request.duration_s);
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  return Resolved(options);
}

Result<fs::path> SimulatedRecording(const SimulationOptions& options, const std::stop_token& stop) {
  ThreadPool pool(ChosenThreads(0));
  std::optional<ProgressBar> progress;
  auto recording = CachedRecording(
      options, DefaultCacheDir(), pool,
      [&](double fraction) {
        if (!progress) progress.emplace("simulating", 0, "");
        progress->Update(fraction);
      },
      stop);
  if (recording && progress) progress->Finish();
  return recording;
}

std::vector<std::string> EdgeArguments(const DemoRequest& request, const fs::path& recording,
                                       const std::string& edge_id) {
  return {"--recording", recording.string(), "--edge-id", edge_id, "--domain",
          std::to_string(request.domain), "--rate", fmt::format("{}", request.rate),
          "--wait-for-ground", "--exit-at-end", "--set",
          // Stamps stay those of the simulation, so that poses can be compared with the truth.
          "source.expert.rebase=false", "--set",
          // The ground confirms the last frames when it has processed them, which may take minutes
          // on a slow computer.
          "link.expert.linger_s=600"};
}

Result<std::vector<std::string>> GroundArguments(const DemoRequest& request,
                                                 const fs::path& recording,
                                                 const std::string& edge_id) {
  const auto poses = ReadTruePoses(recording);
  if (!poses) return Err(poses.error());
  // The result is then in the simulation's world, and the volume lies where the scene is.
  std::vector<std::string> arguments{"--once",
                                     "--output",
                                     request.output.string(),
                                     "--edge-id",
                                     edge_id,
                                     "--domain",
                                     std::to_string(request.domain),
                                     "--set",
                                     "live.expert.record_viewable=false"};
  const std::vector<std::string> pose = InitialPoseArguments(poses->front().T_world_depth);
  arguments.insert(arguments.end(), pose.begin(), pose.end());
  return arguments;
}

Status ExplainFailure(const std::string& name, int exit_status, const fs::path& log) {
  return Unavailable(fmt::format("{} ended with exit status {}; the end of {}:\n{}", name,
                                 exit_status, log.string(), LastLines(log, 5)));
}

// Returns how far the scan is, by the size of the ground's recording against that of the simulated
// one.
double ScanFraction(const fs::path& received, const fs::path& simulated) {
  std::error_code error;
  const auto got = fs::file_size(received, error);
  if (error) return 0.0;
  const auto all = fs::file_size(simulated, error);
  return error || all == 0 ? 0.0
                           : std::min(1.0, static_cast<double>(got) / static_cast<double>(all));
}

// Until both have ended; the other one is ended if one fails.
Status WaitForBoth(ChildProcess& edge, ChildProcess& ground, const fs::path& received,
                   const fs::path& simulated, const std::stop_token& stop) {
  constexpr auto kTick = std::chrono::milliseconds(50);
  ProgressBar progress("scanning", 0, "");
  for (;;) {
    const std::optional<int> edge_status = edge.Poll();
    const std::optional<int> ground_status = ground.Poll();
    if (edge_status.value_or(0) != 0)
      return ExplainFailure("isotherm-edge", *edge_status, edge.log());
    if (ground_status.value_or(0) != 0)
      return ExplainFailure("isotherm-ground", *ground_status, ground.log());
    if (edge_status && ground_status) break;
    if (ground_status && !edge_status) edge.Terminate();  // Nobody is left to confirm its frames.
    if (stop.stop_requested()) return Unavailable("stopped");
    progress.Update(ScanFraction(received, simulated));
    std::this_thread::sleep_for(kTick);
  }
  progress.Finish();
  return OkStatus();
}

std::uint64_t Messages(const RecordingInfo& info, const std::string& topic) {
  const auto found = info.messages_by_topic.find(topic);
  return found == info.messages_by_topic.end() ? 0 : found->second;
}

Status CountFrames(const fs::path& recording, std::uint64_t DemoCounters::*count,
                   DemoReport& report) {
  const auto reader = RecordingReader::Open(recording);
  if (!reader) return reader.error();
  report.depth.*count = Messages((*reader)->info(), "/depth");
  report.thermal.*count = Messages((*reader)->info(), "/thermal");
  return OkStatus();
}

Status CompareWithTruth(const DemoRequest& request, const SimulationOptions& simulation,
                        DemoReport& report) {
  const fs::path surface = request.output / kSurfaceName;
  ISOTHERM_RETURN_IF_ERROR(WriteTrueSurface(simulation, surface));
  EvaluationRequest evaluation;
  evaluation.result_dir = request.output;
  evaluation.groundtruth = report.simulated_recording;
  evaluation.surface = surface;
  evaluation.emissivity = kEmissivity;
  evaluation.ambient_celsius = simulation.scene().surround_celsius();
  evaluation.tolerance_ms = kStampTolerance_ms;
  auto result = Evaluate(evaluation);
  if (!result) return result.error();
  report.evaluation = std::move(*result);
  return OkStatus();
}

Status Scan(const DemoRequest& request, const fs::path& recording, const std::stop_token& stop) {
  // A demo must not meet another one, or a rig, on the same network.
  const std::string edge_id = fmt::format("demo-{}", ::getpid());
  const auto edge_program = NeighbourProgram("isotherm-edge");
  if (!edge_program) return edge_program.error();
  const auto ground_program = NeighbourProgram("isotherm-ground");
  if (!ground_program) return ground_program.error();
  const auto ground_arguments = GroundArguments(request, recording, edge_id);
  if (!ground_arguments) return ground_arguments.error();
  // The ground first: an edge that waits for a ground would log that none is there.
  auto ground =
      ChildProcess::Start(*ground_program, *ground_arguments, request.output / "ground.log");
  if (!ground) return ground.error();
  auto edge = ChildProcess::Start(*edge_program, EdgeArguments(request, recording, edge_id),
                                  request.output / "edge.log");
  if (!edge) return edge.error();
  return WaitForBoth(*edge, *ground, request.output / kRecordingName, recording, stop);
}

// Results of an earlier demo would be taken for those of this one.
Status PrepareOutput(const fs::path& output) {
  std::error_code error;
  fs::create_directories(output, error);
  if (error)
    return IoError(fmt::format("{}: cannot be created: {}", output.string(), error.message()));
  for (const char* name :
       {kRecordingName, kSurfaceName, "trajectory.txt", "cloud.ply", "mesh.ply", "stats.json"}) {
    fs::remove(output / name, error);
    if (error)
      return IoError(
          fmt::format("{}: cannot be replaced: {}", (output / name).string(), error.message()));
  }
  return OkStatus();
}

}  // namespace

Result<DemoReport> RunDemo(const DemoRequest& request, std::stop_token stop) {
  const auto simulation = Simulation(request);
  if (!simulation) return Err(simulation.error());
  if (Status status = PrepareOutput(request.output); !status.ok()) return Err(std::move(status));
  const auto recording = SimulatedRecording(*simulation, stop);
  if (!recording) return Err(recording.error());
  DemoReport report;
  report.simulated_recording = *recording;
  Status status = Scan(request, *recording, stop);
  if (status.ok()) status = CountFrames(*recording, &DemoCounters::simulated, report);
  if (status.ok())
    status = CountFrames(request.output / kRecordingName, &DemoCounters::arrived, report);
  if (status.ok()) status = CompareWithTruth(request, *simulation, report);
  if (!status.ok()) return Err(std::move(status));
  return report;
}

std::string ToText(const DemoReport& report, const std::filesystem::path& output) {
  std::string text = fmt::format("\nlink: {} of {} depth and {} of {} thermal frames arrived\n",
                                 report.depth.arrived, report.depth.simulated,
                                 report.thermal.arrived, report.thermal.simulated);
  text += ToText(report.evaluation);
  text += fmt::format("\nresults in {}:\n", output.string());
  for (const char* name :
       {"cloud.ply", "mesh.ply", "trajectory.txt", "renders", "stats.json", kRecordingName}) {
    std::error_code error;
    if (fs::exists(output / name, error)) text += fmt::format("  {}\n", (output / name).string());
  }
  return text;
}

}  // namespace isotherm
