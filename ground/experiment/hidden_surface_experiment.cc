#include "ground/experiment/hidden_surface_experiment.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "ground/experiment/model_check.h"
#include "ground/experiment/thesis_fusion.h"
#include "ground/experiment/true_conditions.h"
#include "ground/renderer/renderer.h"
#include "ground/thermal/measurement_conditions.h"

namespace isotherm {
namespace {

struct Method {
  const char* label;
  const char* rendering;
  const ThermalVolume* thermal;
};

RendererOptions ScaleOf(const Scene& scene) {
  double low = scene.surround_celsius(), high = low;
  for (const Primitive& primitive : scene.primitives()) {
    low = std::min(low, primitive.temperature.near_celsius);
    high = std::max(high, primitive.temperature.near_celsius);
  }
  return FixedScale(low, high);
}

/// Fraction of points with a temperature among those that truly were seen under acceptable
/// conditions, percent: the filter must not win by leaving surfaces without temperatures.
double CoveragePercent(const SimulatedScan& scan, const std::vector<CheckedPoint>& points,
                       const ThermalOptions& limits) {
  constexpr std::size_t kEvery = 20;
  std::vector<std::size_t> frames(scan.thermal_times().size());
  std::iota(frames.begin(), frames.end(), std::size_t{0});
  int visible = 0, measured = 0;
  for (std::size_t i = 0; i < points.size(); i += kEvery) {
    const auto conditions = TrueConditions(scan, frames, points[i].truth);
    const bool acceptable = std::ranges::any_of(conditions, [&](const TrueCondition& c) {
      return c.surely_seen && c.distance_m >= limits.distance().min_m() &&
             c.distance_m <= limits.distance().max_m() && c.angle_deg >= limits.angle().min_deg() &&
             c.angle_deg <= limits.angle().max_deg();
    });
    if (!acceptable) continue;
    ++visible;
    measured += points[i].measured() ? 1 : 0;
  }
  return visible == 0 ? std::numeric_limits<double>::quiet_NaN() : 100.0 * measured / visible;
}

ExperimentReport Compare(const HiddenSurfaceSetup& setup, const SimulatedScan& scan,
                         const ScanModel& model, const std::vector<Method>& methods,
                         ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "method";
  report.table.columns = {"points", "assigned", "background too warm", "foreground too cold",
                          "wrong [% of assigned]"};
  const Renderer renderer(ScaleOf(scan.scene()), ThermalOptions());
  const RigidTransform T_world_depth = scan.PoseAt(scan.depth_times().front().exposure);
  const ThermalOptions limits = WithAnglesOfMaterial(ThermalOptions());
  double coverage_percent = 0.0;  // With visibility.
  for (const Method& method : methods) {
    const std::vector<CheckedPoint> points =
        CheckModel(scan.scene(), scan.band(), model.tsdf(), *method.thermal, pool);
    const AssignmentCheck check = CheckAssignment(points);
    if (&method == &methods.back()) coverage_percent = CoveragePercent(scan, points, limits);
    report.table.rows.push_back(
        {method.label,
         {static_cast<double>(check.points), static_cast<double>(check.assigned),
          static_cast<double>(check.too_warm), static_cast<double>(check.too_cold),
          check.WrongPercent()}});
    report.renderings.push_back(
        {method.rendering, renderer.Thermal(LookAtModel(model.tsdf(), *method.thermal,
                                                        *scan.rig().depth, T_world_depth, pool))});
  }
  const auto wrong_percent = [&](std::size_t row) { return report.table.rows[row].values.back(); };
  report.requirements = {
      {"wrongly assigned with visibility", wrong_percent(2), Requirement::Sense::kAtMost,
       setup.max_wrong_percent, "%"},
      {"assigned of what was truly seen under acceptable conditions", coverage_percent,
       Requirement::Sense::kAtLeast, 90.0, "%"},
  };
  if (setup.algorithm4_wrong_percent > 0.0) {
    report.requirements.push_back({"wrongly assigned with algorithm 4, which fails here",
                                   wrong_percent(1), Requirement::Sense::kAtLeast,
                                   setup.algorithm4_wrong_percent, "%"});
  }
  return report;
}

}  // namespace

Result<ExperimentReport> CompareParallaxFilters(const HiddenSurfaceSetup& setup, ThreadPool& pool) {
  const auto scan = SimulatedScan::Create(ExperimentCameras(setup.duration_s), setup.staged);
  if (!scan) return Err(scan.error());
  const GroundOptions options;
  auto pipeline = StartPipeline(options, **scan, pool);
  if (!pipeline) return Err(pipeline.error());
  const ScanModel model = (*pipeline)->model();
  ThesisFusion unfiltered(options, (*scan)->rig(), model, ParallaxFilter::kNone);
  ThesisFusion algorithm4(options, (*scan)->rig(), model, ParallaxFilter::kAlgorithm4);
  PlayScan(**scan, pool,
           {[&](const DepthFrame& frame) {
              (*pipeline)->ProcessDepth(frame);
              unfiltered.AfterDepth(pool);
              algorithm4.AfterDepth(pool);
            },
            [&](const ThermalFramePtr& frame) {
              (*pipeline)->ProcessThermal(frame);
              unfiltered.AddThermal(frame);
              algorithm4.AddThermal(frame);
            }});
  (*pipeline)->Finish();
  if (Status status = CheckTracked(model); !status.ok()) return Err(status);
  return Compare(setup, **scan, model,
                 {{"no filter", "no_filter", &unfiltered.thermal()},
                  {"algorithm 4", "algorithm4", &algorithm4.thermal()},
                  {"visibility", "visibility", &model.thermal()}},
                 pool);
}

}  // namespace isotherm
