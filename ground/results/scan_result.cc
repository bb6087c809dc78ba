#include "ground/results/scan_result.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "common/base/units.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "ground/export/result_files.h"
#include "ground/json/message_json.h"
#include "ground/model/saved_model.h"
#include "ground/renderer/layers.h"
#include "ground/results/scan_doubts.h"
#include "ground/results/scan_text.h"
#include "ground/results/sigma_figures.h"
#include "ground/thermal/thermal_options.h"
#include "ground/thermal/thermal_records.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

Json DescribeStage(const StageStats& stats) {
  Json stage;
  stage["calls"] = stats.count();
  stage["p50_ms"] = stats.Percentile(50);
  stage["p95_ms"] = stats.Percentile(95);
  stage["p99_ms"] = stats.Percentile(99);
  stage["max_ms"] = stats.max_ms();
  stage["total_s"] = stats.total_ms() * 1e-3;
  if (stats.processor_ms() > 0.0) stage["processor_s"] = stats.processor_ms() * 1e-3;
  return stage;
}

namespace {

Json DescribeStages(const ScanModel& scan) {
  Json stages;
  for (const Stage stage : AllValues<Stage>()) {
    if (const StageStats* stats = scan.stages[stage])
      stages[std::string(ToString(stage))] = DescribeStage(*stats);
  }
  return stages;
}

std::uint64_t Sum(const EnumArray<LostReason, std::uint64_t>& counts) {
  std::uint64_t sum = 0;
  for (const LostReason reason : AllValues<LostReason>()) sum += counts[reason];
  return sum;
}

/// Writes the counts of the reasons that occurred, by name.
template <typename Reason>
void DescribeReasons(const EnumArray<Reason, std::uint64_t>& counts, const char* key, Json& json) {
  for (const Reason reason : AllValues<Reason>()) {
    if (counts[reason] > 0) json[key][std::string(ToString(reason))] = counts[reason];
  }
}

/// Describes the odometry poses of a scan: how many came, were accepted and were used.
Json DescribeOdometry(const OdometryPrior& odometry) {
  Json json;
  const OdometryStreamCounts& samples = odometry.stream().counts();
  json["source"] = odometry.stream().source();
  json["in"] = samples.in;
  json["accepted"] = samples.accepted;
  DescribeReasons(samples.refused, "refused_by_reason", json);
  json["gaps"] = samples.gaps;
  json["restarts"] = samples.restarts;
  Json& frames = json["depth_frames"];
  frames["used"] = odometry.counts().used;
  frames["missing"] = odometry.counts().missing;
  frames["contradicted"] = odometry.counts().contradicted;
  frames["distrusted"] = odometry.counts().distrusted;
  return json;
}

std::string ModelName(int map) {
  return map == 0 ? "model.iso" : fmt::format("model-{}.iso", map + 1);
}

std::set<std::string> WrittenNames(const ExportOptions& options, bool has_view, int maps) {
  std::set<std::string> names = {"trajectory.txt", "stats.json"};
  if (options.expert().cloud()) names.insert("cloud.ply");
  if (options.expert().mesh()) names.insert("mesh.ply");
  for (int map = 0; options.expert().model() && map < maps; ++map) names.insert(ModelName(map));
  if (!options.expert().renders() || !has_view) return names;
  for (const RenderLayer layer : AllLayers())
    names.insert(fmt::format("renders/{}.png", LayerName(layer)));
  return names;
}

void AddResultDoubts(const ScanModel& scan, const GroundOptions& options,
                     const ResultSummary& summary, Doubts& doubts) {
  const Doubts more = DoubtsAboutResult({.counts = scan.counts,
                                         .options = options,
                                         .depth_sensor = scan.rig.depth_sensor,
                                         .thermal_sensor = scan.rig.thermal_sensor,
                                         .continued = scan.is_continued,
                                         .can_fuse = scan.thermal_status.ok(),
                                         .poses = scan.trajectory.poses().size(),
                                         .maps = static_cast<std::size_t>(scan.atlas.size()),
                                         .points = summary.points,
                                         .measured_points = summary.measured_points});
  doubts.insert(doubts.end(), more.begin(), more.end());
}

Json DescribeDelay(const CalibrationCheckReport& report) {
  const Refinement& r = *report.refinement;
  const double calibrated_s = report.calibrated_delay_s.value_or(NAN);
  return {{"verdict", ToString(report.verdict.delay)},
          {"calibrated_ms", kMsPerS * calibrated_s},
          {"estimated_ms", kMsPerS * (calibrated_s + r.correction[kDelay])},
          {"off_by_ms", kMsPerS * r.correction[kDelay]},
          {"sigma_ms", kMsPerS * r.Sigma(kDelay)}};
}

Json DescribeCalibration(const CalibrationCheckReport& report) {
  Json json;
  json["verdict"] = ToString(Overall(report));
  if (!report.is_on) return json;
  json["elapsed_s"] = report.elapsed_s;
  if (!report.refinement) {
    json["reason"] = report.reason;
    return json;
  }
  const Refinement& r = *report.refinement;
  json["pose"] = {{"verdict", ToString(report.verdict.pose)},
                  {"off_by_px", r.shift.rms_px},
                  {"sigma_px", r.shift.sigma_px}};
  json["delay"] = DescribeDelay(report);
  const FractionChange influence = ChangeOfInfluence(r);
  json["influence"] = {{"verdict", ToString(report.verdict.influence)},
                       {"off_by", influence.sum},
                       {"sigma", influence.sigma},
                       {"near_fraction", r.after.influence.near_fraction},
                       {"total_fraction", r.after.influence.total_fraction}};
  json["offset"] = {{"verdict", ToString(report.verdict.offset)}};
  if (r.epoch_offset) {
    json["offset"]["kelvin"] = r.epoch_offset->kelvin;
    json["offset"]["sigma_k"] = r.epoch_offset->sigma_k;
  }
  json["thermal_frames"] = r.frames;
  json["points_with_texture"] = r.textured_points;
  return json;
}

/// model.iso, and one more for each sub-map that was never joined.
Status SaveModels(const ScanModel& scan, const GroundOptions& options,
                  const std::filesystem::path& dir,
                  const std::function<void(std::string_view what, double fraction)>& progress) {
  if (!options.export_().expert().model()) return OkStatus();
  Status first;
  for (int i = 0; i < scan.atlas.size(); ++i) {
    const Status saved = SaveSubMap(dir / ModelName(i), scan.atlas.map(i), scan.rig, [&](double) {
      if (progress) progress("model", 0.0);  // A small part of all.
    });
    // One that fails must not cost the others.
    if (first.ok()) first = saved;
  }
  return first;
}

Json DescribeDepth(const ScanCounts& counts) {
  Json depth;
  depth["in"] = counts.depth_in;
  depth["repeated"] = counts.depth_repeated;
  depth["tracked"] = counts.depth_tracked;
  depth["degraded"] = counts.depth_degraded;
  depth["unconfirmed"] = counts.depth_unconfirmed;
  depth["relocalisations"] = counts.relocalisations;
  depth["integrated"] = counts.depth_integrated;
  depth["not_integrated_behind"] = counts.depth_behind;
  depth["not_integrated_uncertain"] = counts.depth_uncertain;
  depth["refused"] = counts.depth_refused;
  depth["lost"] = Sum(counts.depth_lost);
  DescribeReasons(counts.depth_lost, "lost_by_reason", depth);
  return depth;
}

Json DescribeThermal(const ScanCounts& counts) {
  Json thermal;
  thermal["in"] = counts.thermal_in;
  thermal["fused"] = counts.thermal_fused;
  thermal["longest_pause_s"] = counts.longest_thermal_pause_s;
  DescribeReasons(counts.thermal_left_out, "left_out_by_reason", thermal);
  Json& not_assigned = thermal["pixels_not_assigned"];
  not_assigned["near_an_edge"] = counts.fusion.occluded;
  not_assigned["smeared"] = counts.fusion.smeared;
  not_assigned["steep_gradient"] = counts.fusion.steep;
  not_assigned["maybe_hidden"] = counts.fusion.maybe_hidden;
  thermal["voxels_assigned"] = counts.fusion.assigned;
  thermal["voxels_dropped_in_review"] = counts.fusion.dropped;
  return thermal;
}

Json DescribeSigma(const SigmaFigures& figures) {
  Json json;
  for (std::size_t i = 0; i < SigmaFigures::kNames.size(); ++i) {
    const std::string name(SigmaFigures::kNames[i]);
    json["translation_mm"][name] = figures.translation_mm[i];
    json["rotation_deg"][name] = figures.rotation_deg[i];
  }
  return json;
}

Json DescribeDrift(const Atlas& atlas) {
  Json drift;
  drift["loops_closed"] = atlas.drift().closures;
  drift["largest_gap_m"] = atlas.drift().largest_gap_m;
  drift["last_gap_m"] = atlas.drift().last_gap_m;
  drift["last_gap_rad"] = atlas.drift().last_gap_rad;
  drift["maps_never_joined"] = atlas.size() - 1;
  return drift;
}

Json DescribeVolume(const ScanModel& scan) {
  Json volume;
  const VoxelGrid& grid = scan.tsdf().grid();
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
  return volume;
}

}  // namespace

Json DescribeScan(const ScanModel& scan, const GroundOptions& options) {
  Json json;
  json["frames"]["depth"] = DescribeDepth(scan.counts);
  if (const auto sigma = Figures(scan.trajectory.sigmas()))
    json["pose_sigma"] = DescribeSigma(*sigma);
  // A scan without odometry has no such section, rather than one of zeros.
  if (scan.external_odometry.stream().counts().in > 0)
    json["external_odometry"] = DescribeOdometry(scan.external_odometry);
  json["frames"]["thermal"] = DescribeThermal(scan.counts);
  json["stages"] = DescribeStages(scan);
  json["threads"] = scan.pool.threads();
  json["drift"] = DescribeDrift(scan.atlas);
  json["volume"] = DescribeVolume(scan);
  json["calibration"] = ToJson(ToProto(scan.rig));
  GroundOptions complete = options;
  // What the material decided is written out, so that the result can be evaluated by the limits it
  // was made with.
  *complete.mutable_thermal() = WithAnglesOfMaterial(options.thermal());
  json["configuration"] = ToJson(complete);
  if (!scan.thermal_status.ok()) json["thermal_not_fused_because"] = scan.thermal_status.message();
  return json;
}

Json DescribeProcessor(const ProcessorTimes& used, const Trajectory& trajectory) {
  Json json;
  json["total_s"] = used.total_s;
  const std::vector<StampedPose>& poses = trajectory.poses();
  const double data_s = poses.empty() ? 0.0 : ToSeconds(poses.back().time - poses.front().time);
  // By the scan's own time: below 1 one core would keep up with the cameras.
  if (data_s > 0.0) json["per_second_of_data_s"] = used.total_s / data_s;
  for (const auto& [name, thread_s] : used.by_thread_s) json["by_thread_s"][name] = thread_s;
  return json;
}

Result<WrittenScan> WriteScan(
    const ScanModel& scan, const GroundOptions& options, const DriverReport& report,
    const std::filesystem::path& dir,
    const std::function<void(std::string_view what, double fraction)>& progress) {
  Json stats = report.stats;
  stats["calibration_check"] = DescribeCalibration(report.calibration);
  Doubts doubts = report.doubts;
  const bool has_view = scan.view.maps.width() > 0;
  const SurfaceMaps view =
      has_view ? CastFullView(scan, options.raycast().expert().min_weight()) : SurfaceMaps();
  const Result<Interpretation> interpretation = Interpretation::Create(options.interpretation());
  if (!interpretation) return Err(interpretation.error());
  const ResultInputs inputs{scan.tsdf(),
                            scan.thermal(),
                            scan.trajectory.poses(),
                            has_view ? &view : nullptr,
                            scan.view.T_map_depth.translation(),
                            options.renderer(),
                            CompleteLimits(options.thermal(), scan.rig.thermal_sensor),
                            options.export_(),
                            interpretation->changes_nothing() ? nullptr : &*interpretation,
                            stats,
                            [&](const ResultSummary& summary) {
                              // Doubts about the result need the summary, which is there when the
                              // surface is; stats.json is written after.
                              AddResultDoubts(scan, options, summary, doubts);
                              return doubts;
                            }};
  // The model goes first: all other results can be made again from it.
  const Status saved = SaveModels(scan, options, dir, progress);
  if (progress) progress("results", 0.0);
  const Result<ResultSummary> summary = WriteResults(inputs, dir, scan.pool, progress);
  if (!saved.ok()) return Err(saved);
  if (!summary) return Err(summary.error());
  // Last, when all was written: an earlier scan's results must not pass for part of this one, and
  // must not be lost for one that failed.
  RemoveOtherResults(dir, WrittenNames(options.export_(), has_view, scan.atlas.size()));

  std::string text = SummaryText(scan, options, report.calibration, *summary, *interpretation);
  text += fmt::format("results  {}\n", dir.string());
  return WrittenScan{std::move(text), std::move(doubts)};
}

}  // namespace isotherm
