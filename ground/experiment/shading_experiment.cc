#include <fmt/format.h>

#include <cmath>

#include "common/simulation/scenes.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 1.6;

RendererOptions ScaleFor(double hot_celsius, bool shading) {
  RendererOptions options = FixedScale(20.0, hot_celsius);
  options.mutable_expert()->set_shading(shading);
  options.mutable_expert()->set_legend(false);  // The rendering's pixels are the view's.
  return options;
}

/// Brightness of a colour, 0..255 (weights of ITU-R BT.709).
double Luma(Rgb8 colour) { return 0.2126 * colour.r + 0.7152 * colour.g + 0.0722 * colour.b; }

/// Holds what a pixel truly shows.
struct TruePixel {
  double celsius;
  double cosine;  ///< Between the surface's normal and the line of sight.
  double z_m;
};

std::optional<TruePixel> TruthAt(const Scene& scene, const CameraModel& camera,
                                 const RigidTransform& T_world_depth, int x, int y) {
  const Eigen::Vector3d ray =
      T_world_depth.linear() * Unproject(camera, Eigen::Vector2d(x, y)).homogeneous();
  const auto hit = scene.Intersect(T_world_depth.translation(), ray);
  if (!hit) return std::nullopt;
  return TruePixel{hit->point.celsius, std::abs(hit->point.n_world.dot(ray.normalized())),
                   hit->distance};
}

/// Edges between faces of one temperature that differ in slant, and how many of them a rendering
/// shows.
struct EdgeCount {
  double all = 0.0;    ///< All edges, also those with no temperature on a side.
  double edges = 0.0;  ///< Edges with temperatures on both sides.
  double visible_flat = 0.0, visible_shaded = 0.0;  ///< How many of `edges` the rendering shows.
};

EdgeCount CountEdges(const Scene& scene, const CameraModel& camera,
                     const RigidTransform& T_world_depth, const ViewMaps& view, double range_kelvin,
                     const RgbImage& flat, const RgbImage& shaded) {
  // Beside an edge to a steep face there are no temperatures: three voxels on either side.
  constexpr int kAcross_px = 18;
  constexpr double kOneTemperature = 0.02;  // Of the range.
  constexpr double kSlantCosine = 0.2;
  constexpr double kTouching_m = 0.02;
  constexpr double kVisible = 10.0;  // Steps of brightness.
  EdgeCount count;
  const auto compare = [&](int x, int y, int other_x, int other_y) {
    const auto a = TruthAt(scene, camera, T_world_depth, x, y);
    const auto b = TruthAt(scene, camera, T_world_depth, other_x, other_y);
    if (!a || !b || std::abs(a->z_m - b->z_m) > kTouching_m) return;
    if (std::abs(a->celsius - b->celsius) > kOneTemperature * range_kelvin) return;
    if (std::abs(a->cosine - b->cosine) < kSlantCosine) return;
    count.all += 1.0;
    if (std::isnan(view.celsius.At(x, y)) || std::isnan(view.celsius.At(other_x, other_y))) return;
    count.edges += 1.0;
    const auto is_visible = [&](const RgbImage& rendering) {
      return std::abs(Luma(rendering.At(x, y)) - Luma(rendering.At(other_x, other_y))) >= kVisible;
    };
    count.visible_flat += is_visible(flat) ? 1.0 : 0.0;
    count.visible_shaded += is_visible(shaded) ? 1.0 : 0.0;
  };
  for (int y = 0; y + kAcross_px < camera.height; ++y) {
    for (int x = 0; x + kAcross_px < camera.width; ++x) {
      compare(x, y, x + kAcross_px, y);
      compare(x, y, x, y + kAcross_px);
    }
  }
  return count;
}

Status AddRange(const char* name, double hot_celsius, ThreadPool& pool, ExperimentReport& report) {
  SceneOptions scene_options;
  scene_options.set_scene(CALIBRATOR);
  scene_options.set_hot_celsius(hot_celsius);
  const auto played = Play(ExperimentCameras(kDuration_s, kSharpEverywhere),
                           MakeScene(scene_options), {OptionsForSlantedSurfaces()}, pool);
  if (!played) return played.error();
  const ScanModel model = played->pipelines.front()->model();
  const CameraModel& camera = *played->scan->rig().depth;
  const RigidTransform T_world_depth =
      played->scan->PoseAt(played->scan->depth_times().back().exposure);
  const ViewMaps view = LookAtModel(model.tsdf(), model.thermal(), camera, T_world_depth, pool);
  const RgbImage flat = Renderer(ScaleFor(hot_celsius, false), {}).Thermal(view);
  const RgbImage shaded = Renderer(ScaleFor(hot_celsius, true), {}).Thermal(view);
  const EdgeCount count = CountEdges(played->scan->scene(), camera, T_world_depth, view,
                                     hot_celsius - 20.0, flat, shaded);
  const double flat_percent = 100.0 * count.visible_flat / count.edges;
  const double shaded_percent = 100.0 * count.visible_shaded / count.edges;
  report.table.rows.push_back(
      {fmt::format("{} (20 to {:.0f} °C)", name, hot_celsius),
       {count.edges, flat_percent, shaded_percent, 100.0 * count.edges / count.all}});
  const Requirement visible = {fmt::format("edges visible with shading, {} range", name),
                               shaded_percent, Requirement::Sense::kAtLeast, 85.0, "%"};
  report.requirements.push_back(visible);
  report.requirements.push_back(NegativeControl(
      visible, fmt::format("edges visible without shading, {} range", name), flat_percent));
  report.requirements.push_back({fmt::format("the same, {} range", name), flat_percent,
                                 Requirement::Sense::kAtMost, 20.0, "%"});
  report.renderings.push_back({fmt::format("{}_flat", name), flat});
  report.renderings.push_back({fmt::format("{}_shaded", name), shaded});
  return OkStatus();
}

}  // namespace

Result<ExperimentReport> RunShadingExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "temperature range";
  report.table.columns = {"pixels across edges of one temperature", "visible without shading [%]",
                          "visible with shading [%]", "coverage [%]"};
  for (const auto& [name, hot_celsius] : {std::pair{"small", 30.0}, std::pair{"large", 100.0}}) {
    if (Status status = AddRange(name, hot_celsius, pool, report); !status.ok()) return Err(status);
  }
  return report;
}

}  // namespace isotherm
