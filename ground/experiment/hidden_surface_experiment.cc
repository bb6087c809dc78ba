#include "ground/experiment/hidden_surface_experiment.h"

#include <algorithm>

#include "ground/experiment/model_check.h"
#include "ground/experiment/thesis_fusion.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

struct Method {
  const char* label;
  const char* picture;
  const ThermalVolume* thermal;
};

RendererOptions FixedScale(const Scene& scene) {
  double low = scene.surround_celsius(), high = low;
  for (const Primitive& primitive : scene.primitives()) {
    low = std::min(low, primitive.temperature.near_celsius);
    high = std::max(high, primitive.temperature.near_celsius);
  }
  RendererOptions options;
  options.set_scale(FIXED);
  options.set_scale_min_celsius(low);
  options.set_scale_max_celsius(high);
  return options;
}

ExperimentReport Compare(const HiddenSurfaceSetup& setup, const SimulatedScan& scan,
                         const GroundPipeline& pipeline, const std::vector<Method>& methods,
                         ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "method";
  report.table.columns = {"points", "assigned", "background too warm", "foreground too cold",
                          "wrong [% of assigned]"};
  const Renderer renderer(FixedScale(scan.scene()), ThermalOptions());
  const RigidTransform T_world_depth = scan.PoseAt(scan.depth_times().front().exposure);
  for (const Method& method : methods) {
    const AssignmentCheck check = CheckAssignment(
        CheckModel(scan.scene(), scan.band(), pipeline.tsdf(), *method.thermal, pool));
    report.table.rows.push_back(
        {method.label,
         {static_cast<double>(check.points), static_cast<double>(check.assigned),
          static_cast<double>(check.too_warm), static_cast<double>(check.too_cold),
          check.WrongPercent()}});
    report.pictures.push_back(
        {method.picture, renderer.Thermal(LookAtModel(pipeline.tsdf(), *method.thermal,
                                                      *scan.rig().depth, T_world_depth, pool))});
  }
  const auto wrong_percent = [&](std::size_t row) { return report.table.rows[row].values.back(); };
  report.requirements = {
      {"wrongly assigned with visibility", wrong_percent(2), Requirement::Sense::kAtMost,
       setup.max_wrong_percent, "%"},
      // The filter must not win by leaving surfaces without temperatures.
      {"assigned with visibility, of what algorithm 4 assigns",
       100.0 * report.table.rows[2].values[1] / report.table.rows[1].values[1],
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
  ThesisFusion unfiltered(options, (*scan)->rig(), **pipeline, ParallaxFilter::kNone);
  ThesisFusion algorithm4(options, (*scan)->rig(), **pipeline, ParallaxFilter::kAlgorithm4);
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
  if (Status status = CheckTracked(**pipeline); !status.ok()) return Err(status);
  return Compare(setup, **scan, **pipeline,
                 {{"no filter", "no_filter", &unfiltered.thermal()},
                  {"algorithm 4", "algorithm4", &algorithm4.thermal()},
                  {"visibility", "visibility", &(*pipeline)->thermal()}},
                 pool);
}

}  // namespace isotherm
