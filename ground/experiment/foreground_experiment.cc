#include "common/simulation/scene_builder.h"
#include "ground/experiment/hidden_surface_experiment.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 3.5, kFocus_m = 0.75;

/// A hot plate in front of a wall. The rig passes it to the right and comes closer, so that the
/// plate leaves the depth camera's view over the left border while the thermal camera, which is
/// further left, still sees it, and comes closer than the depth camera can measure. Black bodies.
StagedScene PlateBeforeWall() {
  SceneBuilder scene(23.0);
  scene.UseMaterial({1.0, 1.0, 0.0, false});
  scene.Box("wall", {0.02, 0.02, 0.74}, {0.94, 0.94, 0.80}).temperature = Uniform(24.0);
  scene.Box("sill", {0.02, 0.80, 0.62}, {0.94, 0.86, 0.74}).temperature = Uniform(24.0);
  scene.Box("post", {0.60, 0.02, 0.66}, {0.66, 0.80, 0.74}).temperature = Uniform(24.0);
  scene.Sphere("knob", {0.80, 0.55, 0.70}, 0.06).temperature = Uniform(24.0);
  scene.RotatedBox("carton", {0.40, 0.64, 0.68}, {0.10, 0.12, 0.10}, {10, 30, 0}).temperature =
      Uniform(24.0);
  scene.Box("plate", {0.20, 0.24, 0.36}, {0.36, 0.44, 0.37}).temperature = Uniform(80.0);
  ScanPath path;
  path.target_x_m = FromTo(0.32, 0.64, kDuration_s);
  path.target_y_m = {0.48};
  path.target_z_m = {0.74};
  path.distance_m = FromTo(0.82, 0.70, kDuration_s);
  return {scene.Build("plate before wall"), path, {}};
}

}  // namespace

Result<ExperimentReport> RunForegroundExperiment(ThreadPool& pool) {
  return CompareParallaxFilters({PlateBeforeWall(), kDuration_s, kFocus_m, 0.2, true}, pool);
}

}  // namespace isotherm
