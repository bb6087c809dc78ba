#include "common/simulation/scene_builder.h"
#include "ground/experiment/hidden_surface_experiment.h"

namespace isotherm {
namespace {

/// On the wall, about where the thesis focused for its calibration (5.2).
constexpr double kFocus_m = 0.75;

/// The thesis's arrangement: a calibrator half a metre away on a table, a wall behind it. All parts
/// are black bodies, so that a temperature is wrong only if it is another surface's.
StagedScene CalibratorBeforeWall() {
  SceneBuilder scene(23.0);
  scene.UseMaterial({1.0, 1.0, 0.0, false});
  scene.Box("wall", {0.02, 0.02, 0.84}, {0.94, 0.94, 0.90}).temperature = Uniform(24.0);
  scene.Box("table", {0.02, 0.78, 0.30}, {0.94, 0.84, 0.84}).temperature = Uniform(24.0);
  scene.RotatedBox("carton", {0.17, 0.68, 0.70}, {0.18, 0.20, 0.16}, {0, 24, 0}).temperature =
      Uniform(24.0);
  scene.Box("calibrator", {0.36, 0.42, 0.50}, {0.60, 0.78, 0.66}).temperature = Uniform(80.0);
  ScanPath path;
  path.target_x_m = {0.48, 0.02, 3.0};
  path.target_y_m = {0.52, 0.02, 2.5};
  path.target_z_m = {0.52};
  path.azimuth_rad = {0.0, 0.06, 2.8};
  path.elevation_rad = {0.15, 0.03, 3.5};
  path.distance_m = {0.50};
  return {scene.Build("calibrator before wall"), path, {}};
}

}  // namespace

Result<ExperimentReport> RunParallaxExperiment(ThreadPool& pool) {
  return CompareParallaxFilters({CalibratorBeforeWall(), 2.0, kFocus_m, 0.1, false}, pool);
}

}  // namespace isotherm
