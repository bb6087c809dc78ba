#include "ground/experiment/link_scan.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/child_process.h"
#include "common/recording/recording.h"
#include "ground/evaluation/true_poses.h"
#include "ground/experiment/radio_profile.h"
#include "ground/link_emulator/emulated_network.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// For the poses of frames, which carry the times of the recording.
constexpr double kStampTolerance_ms = 10.0;
/// Far more than any scan takes to arrive: then something hangs.
constexpr auto kPatience = 10min;
constexpr auto kTick = 50ms;

/// Returns a program's arguments on `host`, the program itself first.
std::vector<std::string> On(const EmulatedHost& host, const fs::path& profile,
                            const fs::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = host.CommandPrefix();
  words.insert(words.end(),
               {"/usr/bin/env", "CYCLONEDDS_URI=file://" + profile.string(), program.string()});
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

Result<ChildProcess> Start(const std::vector<std::string>& words, const fs::path& log) {
  return ChildProcess::Start(words.front(), {words.begin() + 1, words.end()}, log);
}

std::vector<std::string> EdgeArguments(const LinkScanSetup& setup) {
  return {"--recording", setup.recording.string(), "--record",
          (setup.folder / "edge.mcap").string(), "--rate", "1", "--wait-for-ground",
          "--exit-at-end", "--set", "link.policy=" + setup.policy, "--set",
          fmt::format("link.expert.backfill_hz={}", setup.backfill ? 200 : 0), "--set",
          fmt::format("link.expert.pieces={}", setup.pieces),
          // Stamps stay those of the simulation, so that poses can be compared with the truth.
          "--set", "source.expert.rebase=false", "--set", "link.expert.linger_s=60"};
}

Result<std::vector<std::string>> GroundArguments(const LinkScanSetup& setup) {
  const auto poses = ReadTruePoses(setup.recording);
  if (!poses) return Err(poses.error());
  std::vector<std::string> arguments{"--once", "--output", (setup.folder / "results").string(),
                                     "--set", "live.expert.record_viewable=false"};
  // The result is then in the truth's world.
  const std::vector<std::string> pose = InitialPoseArguments(poses->front().T_world_depth);
  arguments.insert(arguments.end(), pose.begin(), pose.end());
  return arguments;
}

Status Explain(const char* name, const ChildProcess& process, const std::string& what) {
  return Unavailable(
      fmt::format("{} {}; the end of its log:\n{}", name, what, LastLines(process.log(), 5)));
}

/// Waits until both have ended, the edge first. Returns how long the edge has run.
Result<double> WaitForBoth(ChildProcess& edge, ChildProcess& ground) {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<double> edge_s;
  while (true) {
    const double now_s = ToSeconds(std::chrono::steady_clock::now() - begin);
    const std::optional<int> edge_status = edge.Poll(), ground_status = ground.Poll();
    if (edge_status && !edge_s) edge_s = now_s;
    if (edge_status.value_or(0) != 0)
      return Err(Explain("isotherm-edge", edge, fmt::format("ended with {}", *edge_status)));
    if (ground_status.value_or(0) != 0)
      return Err(Explain("isotherm-ground", ground, fmt::format("ended with {}", *ground_status)));
    if (edge_status && ground_status) return *edge_s;
    if (now_s > ToSeconds(kPatience)) {
      return Err(edge_status ? Explain("isotherm-ground", ground, "hangs")
                             : Explain("isotherm-edge", edge, "hangs"));
    }
    std::this_thread::sleep_for(kTick);
  }
}

Result<nlohmann::json> ReadStats(const fs::path& folder) {
  const fs::path path = folder / "stats.json";
  std::ifstream file(path);
  nlohmann::json json = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return Err(DataLoss(path.string() + ": not there, or not JSON"));
  return json;
}

/// Returns the number at `where`, NaN if there is none.
double NumberAt(const nlohmann::json& json, const std::string& where) {
  const nlohmann::json::json_pointer pointer(where);
  if (!json.contains(pointer) || !json.at(pointer).is_number())
    return std::numeric_limits<double>::quiet_NaN();
  return json.at(pointer).get<double>();
}

double OfBoth(const nlohmann::json& stats, const std::string& name) {
  double sum = 0.0;
  for (const char* sensor : {"depth", "thermal"}) {
    const double frames = NumberAt(stats, fmt::format("/link/{}/{}", sensor, name));
    if (std::isfinite(frames)) sum += frames;
  }
  return sum;
}

Status ReadOutcome(const LinkScanSetup& setup, LinkScanOutcome& outcome) {
  const auto recording = RecordingReader::Open(setup.folder / "edge.mcap");
  if (!recording) return recording.error();
  for (const auto& [topic, messages] : (*recording)->info().messages_by_topic) {
    if (topic == "/depth" || topic == "/thermal") outcome.captured += static_cast<double>(messages);
  }
  const fs::path results = setup.folder / "results";
  const auto stats = ReadStats(results);
  if (!stats) return stats.error();
  outcome.missing = outcome.captured - OfBoth(*stats, "received");
  outcome.late = OfBoth(*stats, "late");
  outcome.most_lacking = NumberAt(*stats, "/link/most_lacking_frames");
  outcome.feedback_p50_ms = NumberAt(*stats, "/link/feedback/latency_p50_ms");
  outcome.feedback_p99_ms = NumberAt(*stats, "/link/feedback/latency_p99_ms");
  EvaluationRequest request;
  request.result_dir = results;
  request.groundtruth = setup.recording;
  request.surface = setup.surface;
  request.emissivity = setup.emissivity;
  request.ambient_celsius = setup.ambient_celsius;
  request.tolerance_ms = kStampTolerance_ms;
  auto evaluation = Evaluate(request);
  if (!evaluation) return evaluation.error();
  outcome.evaluation = std::move(*evaluation);
  return OkStatus();
}

Status MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  fs::create_directories(folder, error);
  if (error)
    return IoError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  const fs::path profile = folder / "profile.xml";
  if (!(std::ofstream(profile) << RadioProfile()).flush())
    return IoError(profile.string() + ": cannot be written");
  return OkStatus();
}

}  // namespace

Result<LinkScanOutcome> RunLinkScan(const LinkScanSetup& setup) {
  if (Status status = MakeFolder(setup.folder); !status.ok()) return Err(std::move(status));
  const auto edge_program = NeighbourProgram("isotherm-edge");
  if (!edge_program) return Err(edge_program.error());
  const auto ground_program = NeighbourProgram("isotherm-ground");
  if (!ground_program) return Err(ground_program.error());
  const auto ground_arguments = GroundArguments(setup);
  if (!ground_arguments) return Err(ground_arguments.error());
  const auto network = EmulatedNetwork::Create(setup.seed);
  if (!network) return Err(network.error());
  (*network)->Set(NetworkEnd::kEdge, setup.to_ground);
  (*network)->Set(NetworkEnd::kGround, setup.to_edge);
  const fs::path profile = setup.folder / "profile.xml";
  auto ground =
      Start(On((*network)->host(NetworkEnd::kGround), profile, *ground_program, *ground_arguments),
            setup.folder / "ground.log");
  if (!ground) return Err(ground.error());
  auto edge =
      Start(On((*network)->host(NetworkEnd::kEdge), profile, *edge_program, EdgeArguments(setup)),
            setup.folder / "edge.log");
  if (!edge) return Err(edge.error());
  const auto edge_s = WaitForBoth(*edge, *ground);
  if (!edge_s) return Err(edge_s.error());
  LinkScanOutcome outcome;
  outcome.scan_s = *edge_s;
  constexpr double kBitsPerMegabyte = 8e-6;
  outcome.sent_mbit_s =
      kBitsPerMegabyte * static_cast<double>((*network)->counts(NetworkEnd::kEdge).bytes) / *edge_s;
  if (Status status = ReadOutcome(setup, outcome); !status.ok()) return Err(std::move(status));
  return outcome;
}

}  // namespace isotherm
