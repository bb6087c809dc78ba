#include "ground/experiment/corner_scene.h"

#include <utility>

#include "common/simulation/scene_builder.h"

namespace isotherm {

StagedScene CornerScene(std::string name, const CornerTemperatures& celsius) {
  SceneBuilder scene(23.0);
  scene.UseMaterial({});
  scene.Box("back wall", {0.02, 0.02, 0.86}, {0.94, 0.94, 0.92}).temperature =
      Uniform(celsius.back_wall);
  scene.Box("side wall", {0.02, 0.02, 0.40}, {0.08, 0.94, 0.86}).temperature =
      Uniform(celsius.side_wall);
  scene.Box("floor", {0.08, 0.80, 0.40}, {0.94, 0.86, 0.86}).temperature = Uniform(celsius.floor);
  scene.Sphere("sphere", {0.48, 0.64, 0.66}, 0.14).temperature = Uniform(celsius.sphere);
  ScanPath path;
  path.target_x_m = {0.44, 0.04, 7.0};
  path.target_y_m = {0.56, 0.03, 5.0};
  path.target_z_m = {0.72};
  path.azimuth_rad = {0.2, 0.12, 6.0};
  path.elevation_rad = {0.30, 0.06, 4.5};
  path.distance_m = {0.60};
  return {scene.Build(std::move(name)), path, {}};
}

}  // namespace isotherm
