#include "ground/results/scan_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string_view>

#include "ground/results/outcome_text.h"
#include "ground/results/sigma_figures.h"

namespace isotherm {
namespace {

/// "", or ", refused: 2 jump, 1 time".
std::string RefusedText(const EnumArray<OdometryFault, std::uint64_t>& counts) {
  std::string text;
  for (const OdometryFault fault : AllValues<OdometryFault>()) {
    if (counts[fault] == 0) continue;
    text +=
        fmt::format("{}{} {}", text.empty() ? ", refused: " : ", ", counts[fault], ToString(fault));
  }
  return text;
}

/// Returns what odometry poses were and did; a line, or nothing.
std::string OdometryText(const OdometryPrior& odometry) {
  const OdometryStreamCounts& samples = odometry.stream().counts();
  if (samples.in == 0) return {};
  std::string text =
      fmt::format("odometry {} poses of \"{}\"{}; {} depth frames started from them", samples.in,
                  odometry.stream().source(), RefusedText(samples.refused), odometry.counts().used);
  if (odometry.counts().missing > 0)
    text += fmt::format(", {} had none", odometry.counts().missing);
  if (odometry.counts().contradicted > 0) {
    text += fmt::format(", {} contradicted them ({} more distrusted them)",
                        odometry.counts().contradicted, odometry.counts().distrusted);
  }
  return text + "\n";
}

/// Returns what was out of the ordinary with depth frames; a line, or nothing.
std::string IncidentsText(const ScanCounts& counts) {
  std::string text;
  const auto add = [&text](std::uint64_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(counts.depth_repeated, "repeated");
  add(counts.depth_degraded,
      "tracked by their motion before in some direction (a flat or round view does not tell it)");
  add(counts.depth_uncertain, "not integrated, because that had gone on for too long");
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

/// Lines on closed loops and on what was not joined, or nothing.
std::string SubMapsText(const Atlas& atlas) {
  std::string text;
  const DriftReport& drift = atlas.drift();
  if (drift.closures > 0) {
    text +=
        fmt::format("drift    {} loops closed, missed by {:.1f} mm at most before it was spread\n",
                    drift.closures, 1e3 * drift.largest_gap_m);
  }
  // Sub-map 0 is the result; others were never joined to it.
  for (int i = 1; i < atlas.size(); ++i) {
    text += fmt::format(
        "         {} frames were fused after a loss, nowhere near the rest: model-{}.iso\n",
        atlas.map(i).integrated, i + 1);
  }
  return text;
}

std::string DepthText(const ScanModel& scan) {
  const ScanCounts& counts = scan.counts;
  std::string text = fmt::format("depth    {} frames: {} tracked, {} integrated\n", counts.depth_in,
                                 counts.depth_tracked, counts.depth_integrated);
  text += ExplainReasons(counts.depth_lost, "lost", ExplainLost);
  text += IncidentsText(counts);
  if (const auto sigma = Figures(scan.trajectory.sigmas())) {
    text += fmt::format(
        "         pose within {:.2f} mm and {:.3f} deg of the model (one sigma, median), at worst "
        "{:.2f} mm and {:.3f} deg\n",
        sigma->translation_mm[0], sigma->rotation_deg[0], sigma->translation_mm[2],
        sigma->rotation_deg[2]);
  }
  return text;
}

std::string ThermalText(const ScanModel& scan, const CalibrationCheckReport& calibration) {
  const ScanCounts& counts = scan.counts;
  std::string text =
      fmt::format("thermal  {} frames: {} fused\n", counts.thermal_in, counts.thermal_fused);
  text += ExplainReasons(counts.thermal_left_out, "not used", ExplainLeftOut);
  if (!scan.thermal_status.ok())
    text += fmt::format("         {}\n", scan.thermal_status.message());
  if (counts.thermal_in == 0 || !calibration.is_on) return text;
  const char* title = "rig";
  for (const std::string& line : Describe(calibration)) {
    text += fmt::format("{:<9}{}\n", title, line);
    title = "";
  }
  return text;
}

std::string SurfaceText(const ResultSummary& summary, const Interpretation& interpretation) {
  const auto fraction = [&](std::size_t part) {
    return summary.points == 0
               ? 0.0
               : 100.0 * static_cast<double>(part) / static_cast<double>(summary.points);
  };
  std::string text = fmt::format(
      "surface  {} points, {:.1f} % with a temperature, {:.1f} % measured well; {} triangles\n",
      summary.points, fraction(summary.measured_points), fraction(summary.good_points),
      summary.triangles);
  if (summary.measured_points > 0) {
    text += fmt::format("         {:.1f} to {:.1f} °C, mean {:.1f} °C ({} temperature)\n",
                        summary.temperatures.min_celsius, summary.temperatures.max_celsius,
                        summary.temperatures.mean_celsius,
                        interpretation.changes_nothing() ? "apparent" : "object");
  }
  if (summary.sigma.points > 0) {
    text += fmt::format("         standard uncertainty {:.2f} K (median), 95 % below {:.2f} K\n",
                        summary.sigma.median_k, summary.sigma.p95_k);
  }
  for (const std::string& sentence : interpretation.Errors(summary.interpretation))
    text += fmt::format("         {}\n", sentence);
  return text;
}

std::string MemoryText(const ScanModel& scan, const GroundOptions& options) {
  std::string text;
  if (scan.spiller.spilled() > 0) {
    text += fmt::format(
        "memory   the model has outgrown volume.expert.max_memory_bytes: {} blocks went to {}, and "
        "came "
        "back when seen again\n",
        scan.spiller.spilled(), options.volume().spill_dir());
  }
  if (scan.tsdf().refused_blocks() > 0) {
    text +=
        "         volume.expert.max_memory_bytes was reached: parts of the surface are missing\n";
  }
  return text;
}

std::string TimeText(const ScanModel& scan) {
  const auto median = [&](Stage stage) {
    const StageStats* times = scan.stages[stage];
    return times == nullptr ? 0.0 : times->Percentile(50);
  };
  return fmt::format(
      "time     {:.1f} ms per depth frame, {:.1f} ms per thermal frame (medians, {} threads)\n",
      median(Stage::kDepthFrame), median(Stage::kThermalFrame), scan.pool.threads());
}

}  // namespace

std::string SummaryText(const ScanModel& scan, const GroundOptions& options,
                        const CalibrationCheckReport& calibration, const ResultSummary& summary,
                        const Interpretation& interpretation) {
  return DepthText(scan) + SubMapsText(scan.atlas) + OdometryText(scan.external_odometry) +
         ThermalText(scan, calibration) + SurfaceText(summary, interpretation) +
         MemoryText(scan, options) + TimeText(scan);
}

}  // namespace isotherm
