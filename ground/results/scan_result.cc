#include "ground/results/scan_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "common/config/rig_calibration.h"
#include "common/config/rig_calibration.pb.h"
#include "ground/export/message_json.h"
#include "ground/export/results.h"
#include "ground/pipeline/saved_model.h"
#include "ground/renderer/layers.h"
#include "ground/results/outcome_text.h"
#include "ground/results/scan_doubts.h"

namespace isotherm {

Json DescribeStage(const StageStats& stats) {
  Json stage;
  stage["calls"] = stats.count();
  stage["p50_ms"] = stats.Percentile(50);
  stage["p95_ms"] = stats.Percentile(95);
  stage["p99_ms"] = stats.Percentile(99);
  stage["max_ms"] = stats.max_ms();
  stage["total_s"] = stats.total_ms() * 1e-3;
  return stage;
}

namespace {

Json DescribeStages(const ScanModel& scan) {
  Json stages;
  for (const Stage stage : AllValues<Stage>()) {
    if (const StageStats* stats = scan.stages.Find(stage))
      stages[std::string(ToString(stage))] = DescribeStage(*stats);
  }
  return stages;
}

std::uint64_t Sum(const EnumArray<LostReason, std::uint64_t>& counts) {
  std::uint64_t sum = 0;
  for (const LostReason reason : AllValues<LostReason>()) sum += counts[reason];
  return sum;
}

/// Counts by name, of those that occurred.
template <typename Reason>
void DescribeReasons(const EnumArray<Reason, std::uint64_t>& counts, const char* key, Json& json) {
  for (const Reason reason : AllValues<Reason>()) {
    if (counts[reason] > 0) json[key][std::string(ToString(reason))] = counts[reason];
  }
}

std::string List(const std::map<std::string, std::uint64_t>& counts) {
  std::string text;
  for (const auto& [reason, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason);
  return text;
}

/// One-sigma figures of the trajectory's poses, relative to the model: median, 95 % and largest.
struct SigmaFigures {
  static constexpr std::array<std::string_view, 3> kNames = {"p50", "p95", "max"};
  std::array<double, 3> translation_mm{};
  std::array<double, 3> rotation_deg{};
};

std::array<double, 3> Figures(std::vector<double> sigmas) {
  std::sort(sigmas.begin(), sigmas.end());
  const std::size_t last = sigmas.size() - 1;
  return {sigmas[last / 2], sigmas[last * 95 / 100], sigmas[last]};
}

/// nullopt without a trajectory.
std::optional<SigmaFigures> Figures(const std::vector<PoseSigma>& sigmas) {
  if (sigmas.empty()) return std::nullopt;
  std::vector<double> translations_mm;
  std::vector<double> rotations_deg;
  for (const PoseSigma& sigma : sigmas) {
    translations_mm.push_back(1e3 * sigma.translation_m);
    rotations_deg.push_back(sigma.rotation_rad * 180.0 / std::numbers::pi);
  }
  return SigmaFigures{Figures(std::move(translations_mm)), Figures(std::move(rotations_deg))};
}

/// Returns what odometry poses were and did.
Json DescribeOdometry(const OdometryPrior& odometry) {
  Json json;
  const OdometryStreamCounts& samples = odometry.stream().counts();
  json["source"] = odometry.stream().source();
  json["in"] = samples.in;
  json["accepted"] = samples.accepted;
  for (const auto& [reason, count] : samples.refused) json["refused_by_reason"][reason] = count;
  json["gaps"] = samples.gaps;
  json["restarts"] = samples.restarts;
  Json& frames = json["depth_frames"];
  frames["used"] = odometry.counts().used;
  frames["missing"] = odometry.counts().missing;
  frames["contradicted"] = odometry.counts().contradicted;
  frames["distrusted"] = odometry.counts().distrusted;
  return json;
}

/// The same in a line, or nothing.
std::string DescribeOdometryInWords(const OdometryPrior& odometry) {
  const OdometryStreamCounts& samples = odometry.stream().counts();
  if (samples.in == 0) return {};
  std::string text = fmt::format(
      "odometry {} poses of \"{}\"{}{}; {} depth frames started from them", samples.in,
      odometry.stream().source(),
      samples.refused.empty() ? "" : ", refused: ", List(samples.refused), odometry.counts().used);
  if (odometry.counts().missing > 0)
    text += fmt::format(", {} had none", odometry.counts().missing);
  if (odometry.counts().contradicted > 0) {
    text += fmt::format(", {} contradicted them ({} more distrusted them)",
                        odometry.counts().contradicted, odometry.counts().distrusted);
  }
  return text + "\n";
}

/// Returns what was out of the ordinary with depth frames; a line, or nothing.
std::string DescribeIncidents(const PipelineCounts& counts) {
  std::string text;
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(counts.depth_repeated, "repeated");
  add(counts.depth_degraded,
      "tracked by their motion before in some direction (a flat or round view does not tell it)");
  add(counts.relocalisations, "times found again after a loss");
  add(counts.depth_unconfirmed, "not used while that was confirmed");
  add(counts.depth_behind, "not integrated to keep up");
  return text.empty() ? text : fmt::format("         {}\n", text);
}

/// A line for each reason, with what to do about it.
template <typename Reason>
std::string ExplainReasons(const EnumArray<Reason, std::uint64_t>& counts, std::string_view what,
                           std::string_view (*explain)(Reason)) {
  std::string text;
  for (const Reason reason : AllValues<Reason>()) {
    if (counts[reason] > 0)
      text += fmt::format("         {} {}: {}\n", counts[reason], what, explain(reason));
  }
  return text;
}

std::string ModelName(int map) {
  return map == 0 ? "model.iso" : fmt::format("model-{}.iso", map + 1);
}

std::set<std::string> WrittenNames(const ExportOptions& options, bool has_view, int maps) {
  std::set<std::string> names = {"trajectory.txt", "stats.json"};
  if (options.cloud()) names.insert("cloud.ply");
  if (options.mesh()) names.insert("mesh.ply");
  for (int map = 0; options.model() && map < maps; ++map) names.insert(ModelName(map));
  if (!options.renders() || !has_view) return names;
  for (const RenderLayer layer : AllLayers())
    names.insert(fmt::format("renders/{}.png", LayerName(layer)));
  return names;
}

void AddResultDoubts(const ScanModel& scan, const GroundOptions& options,
                     const ResultSummary& summary, Doubts& doubts) {
  const Doubts more = DoubtsAboutResult({.counts = scan.counts,
                                         .options = options,
                                         .continued = scan.is_continued,
                                         .can_fuse = scan.thermal_status.ok(),
                                         .poses = scan.trajectory.poses().size(),
                                         .maps = static_cast<std::size_t>(scan.atlas.size()),
                                         .points = summary.points,
                                         .measured_points = summary.measured_points});
  doubts.insert(doubts.end(), more.begin(), more.end());
}

Json DescribeDelay(const DelayReport& delay) {
  constexpr double kMsPerS = 1e3;
  Json json;
  json["verdict"] = ToString(delay.verdict);
  if (!delay.reason.empty()) json["reason"] = delay.reason;
  if (delay.verdict == DelayVerdict::kOff) return json;
  const double calibrated_s = delay.calibrated_s.value_or(NAN);
  json["calibrated_ms"] = kMsPerS * calibrated_s;
  json["elapsed_s"] = delay.elapsed_s;
  if (!delay.off_by) return json;
  json["estimated_ms"] = kMsPerS * (calibrated_s + delay.off_by->delay_s);
  json["off_by_ms"] = kMsPerS * delay.off_by->delay_s;
  json["sigma_ms"] = kMsPerS * delay.off_by->sigma_s;
  json["parts"] = delay.off_by->parts;
  json["contrast"] = delay.off_by->contrast;
  return json;
}

/// Lines on closed loops and on what was not joined, or nothing.
std::string DescribeSubMaps(const Atlas& atlas) {
  std::string text;
  const DriftReport& drift = atlas.drift();
  if (drift.closures > 0) {
    text +=
        fmt::format("drift    {} loops closed, missed by {:.1f} mm at most before it was spread\n",
                    drift.closures, 1e3 * drift.largest_gap_m);
  }
  for (int i = 1; i < atlas.size(); ++i) {
    text += fmt::format(
        "         {} frames were fused after a loss, nowhere near the rest: model-{}.iso\n",
        atlas.map(i).integrated, i + 1);
  }
  return text;
}

/// model.iso, and one more for each sub-map that was never joined.
Status SaveModels(const ScanModel& scan, const GroundOptions& options,
                  const std::filesystem::path& dir,
                  const std::function<void(std::string_view what, double fraction)>& progress) {
  if (!options.export_().model()) return OkStatus();
  Status first;
  for (int i = 0; i < scan.atlas.size(); ++i) {
    const Status saved = SaveSubMap(dir / ModelName(i), scan.atlas.map(i), scan.rig, [&](double) {
      if (progress) progress("model", 0.0);  // A small part of all.
    });
    if (first.ok()) first = saved;
  }
  return first;
}

}  // namespace

Json DescribeScan(const ScanModel& scan, const GroundOptions& options) {
  const PipelineCounts& counts = scan.counts;
  Json json;
  Json& depth = json["frames"]["depth"];
  depth["in"] = counts.depth_in;
  depth["repeated"] = counts.depth_repeated;
  depth["tracked"] = counts.depth_tracked;
  depth["degraded"] = counts.depth_degraded;
  depth["unconfirmed"] = counts.depth_unconfirmed;
  depth["relocalisations"] = counts.relocalisations;
  depth["integrated"] = counts.depth_integrated;
  depth["not_integrated_behind"] = counts.depth_behind;
  depth["refused"] = counts.depth_refused;
  depth["lost"] = Sum(counts.depth_lost);
  DescribeReasons(counts.depth_lost, "lost_by_reason", depth);
  if (const auto sigma = Figures(scan.trajectory.sigmas())) {
    for (std::size_t i = 0; i < SigmaFigures::kNames.size(); ++i) {
      const std::string name(SigmaFigures::kNames[i]);
      json["pose_sigma"]["translation_mm"][name] = sigma->translation_mm[i];
      json["pose_sigma"]["rotation_deg"][name] = sigma->rotation_deg[i];
    }
  }
  if (scan.external_odometry.stream().counts().in > 0)
    json["external_odometry"] = DescribeOdometry(scan.external_odometry);
  Json& thermal = json["frames"]["thermal"];
  thermal["in"] = counts.thermal_in;
  thermal["fused"] = counts.thermal_fused;
  DescribeReasons(counts.thermal_left_out, "left_out_by_reason", thermal);
  Json& not_assigned = thermal["pixels_not_assigned"];
  not_assigned["near_an_edge"] = counts.fusion.occluded;
  not_assigned["smeared"] = counts.fusion.smeared;
  not_assigned["steep_gradient"] = counts.fusion.steep;
  not_assigned["maybe_hidden"] = counts.fusion.maybe_hidden;
  thermal["voxels_assigned"] = counts.fusion.assigned;
  thermal["voxels_dropped_in_review"] = counts.fusion.dropped;
  json["stages"] = DescribeStages(scan);
  json["threads"] = scan.threads;

  Json& drift = json["drift"];
  drift["loops_closed"] = scan.atlas.drift().closures;
  drift["largest_gap_m"] = scan.atlas.drift().largest_gap_m;
  drift["last_gap_m"] = scan.atlas.drift().last_gap_m;
  drift["last_gap_rad"] = scan.atlas.drift().last_gap_rad;
  drift["maps_never_joined"] = scan.atlas.size() - 1;
  const VoxelGrid& grid = scan.tsdf().grid();
  Json& volume = json["volume"];
  for (int axis = 0; axis < 3; ++axis) {
    volume["min_m"].push_back(grid.min_m[axis]);
    volume["size_m"].push_back(grid.size_m()[axis]);
  }
  volume["voxel_size_m"] = grid.voxel_size_m;
  volume["truncation_distance_m"] = scan.tsdf().truncation_distance_m();
  volume["blocks"] = scan.tsdf().block_count();
  volume["blocks_read_ahead"] = scan.spiller.fetched();
  volume["blocks_spilled"] = scan.spiller.spilled();
  volume["blocks_refused_for_memory"] = scan.tsdf().refused_blocks();
  volume["memory_bytes"] =
      scan.tsdf().memory_bytes() +
      static_cast<std::size_t>(scan.tsdf().block_count()) * kBlockVoxels * sizeof(ThermalVoxel);
  if (const ThermalRecords* records = scan.thermal().records())
    volume["record_bytes"] = records->memory_bytes();
  json["calibration"] = ToJson(ToProto(scan.rig));
  json["configuration"] = ToJson(options);
  if (!scan.thermal_status.ok()) json["thermal_not_fused_because"] = scan.thermal_status.message();
  return json;
}

Result<WrittenScan> WriteScan(
    const ScanModel& scan, const GroundOptions& options, const DelayReport& delay, Doubts doubts,
    Json stats, const std::filesystem::path& dir, ThreadPool& pool,
    const std::function<void(std::string_view what, double fraction)>& progress) {
  stats["delay_check"] = DescribeDelay(delay);
  const bool has_view = scan.view.maps.width() > 0;
  const SurfaceMaps view =
      has_view ? CastFullView(scan, options.raycast().min_weight(), pool) : SurfaceMaps();
  const Result<Interpretation> interpretation = Interpretation::Create(options.interpretation());
  if (!interpretation) return Err(interpretation.error());
  const bool interpreted = !interpretation->changes_nothing();
  const ResultInputs inputs{scan.tsdf(),
                            scan.thermal(),
                            scan.trajectory.poses(),
                            has_view ? &view : nullptr,
                            scan.view.T_map_depth.translation(),
                            options.renderer(),
                            options.thermal(),
                            options.export_(),
                            interpreted ? &*interpretation : nullptr,
                            stats,
                            [&](const ResultSummary& summary) {
                              AddResultDoubts(scan, options, summary, doubts);
                              return doubts;
                            }};
  // All others can be made again from the model.
  const Status saved = SaveModels(scan, options, dir, progress);
  if (progress) progress("results", 0.0);
  const Result<ResultSummary> summary = WriteResults(inputs, dir, pool, progress);
  if (!saved.ok()) return Err(saved);
  if (!summary) return Err(summary.error());
  RemoveOtherResults(dir, WrittenNames(options.export_(), has_view, scan.atlas.size()));

  const PipelineCounts& counts = scan.counts;
  std::string text = fmt::format("depth    {} frames: {} tracked, {} integrated\n", counts.depth_in,
                                 counts.depth_tracked, counts.depth_integrated);
  text += ExplainReasons(counts.depth_lost, "lost", ExplainLost);
  text += DescribeIncidents(counts);
  if (const auto sigma = Figures(scan.trajectory.sigmas())) {
    text += fmt::format(
        "         pose within {:.2f} mm and {:.3f} deg of the model (one sigma, median), at worst "
        "{:.2f} mm and {:.3f} deg\n",
        sigma->translation_mm[0], sigma->rotation_deg[0], sigma->translation_mm[2],
        sigma->rotation_deg[2]);
  }
  text += DescribeSubMaps(scan.atlas);
  text += DescribeOdometryInWords(scan.external_odometry);
  text += fmt::format("thermal  {} frames: {} fused\n", counts.thermal_in, counts.thermal_fused);
  text += ExplainReasons(counts.thermal_left_out, "not used", ExplainLeftOut);
  if (!scan.thermal_status.ok())
    text += fmt::format("         {}\n", scan.thermal_status.message());
  if (counts.thermal_in > 0 && delay.verdict != DelayVerdict::kOff)
    text += fmt::format("delay    {}\n", Describe(delay));
  const auto fraction = [&](std::size_t part) {
    return summary->points == 0
               ? 0.0
               : 100.0 * static_cast<double>(part) / static_cast<double>(summary->points);
  };
  text += fmt::format(
      "surface  {} points, {:.1f} % with a temperature, {:.1f} % measured well; {} triangles\n",
      summary->points, fraction(summary->measured_points), fraction(summary->good_points),
      summary->triangles);
  if (summary->measured_points > 0) {
    text += fmt::format("         {:.1f} to {:.1f} °C, mean {:.1f} °C ({} temperature)\n",
                        summary->temperatures.min_celsius, summary->temperatures.max_celsius,
                        summary->temperatures.mean_celsius, interpreted ? "object" : "apparent");
  }
  for (const std::string& sentence : interpretation->Errors(summary->interpretation))
    text += fmt::format("         {}\n", sentence);
  if (scan.spiller.spilled() > 0) {
    text += fmt::format(
        "memory   the model has outgrown volume.max_memory_bytes: {} blocks went to {}, and came "
        "back when seen again\n",
        scan.spiller.spilled(), options.volume().spill_dir());
  }
  if (scan.tsdf().refused_blocks() > 0) {
    text += "         volume.max_memory_bytes was reached: parts of the surface are missing\n";
  }
  const auto median = [&](Stage stage) {
    const StageStats* times = scan.stages.Find(stage);
    return times == nullptr ? 0.0 : times->Percentile(50);
  };
  text += fmt::format(
      "time     {:.1f} ms per depth frame, {:.1f} ms per thermal frame (medians, {} threads)\n",
      median(Stage::kDepthFrame), median(Stage::kThermalFrame), scan.threads);
  text += fmt::format("results  {}\n", dir.string());
  return WrittenScan{std::move(text), std::move(doubts)};
}

}  // namespace isotherm
