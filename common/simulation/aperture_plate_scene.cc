#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {

StagedScene MakeAperturePlateScene(const SceneOptions& options) {
  // As in the thesis (5.1.3): cardboard at room temperature, 22 cm in front of the camera.
  constexpr double kDistance_m = 0.22, kMiddle_m = kSceneCube_m / 2.0, kPlateZ_m = 0.5;
  constexpr double kDefaultHot_celsius = 120.0, kPlate_celsius = 24.0;
  constexpr double kEmissivity = 0.95, kIndex = 1.5;
  const Eigen::Vector3d middle(kMiddle_m, kMiddle_m, kPlateZ_m);
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial({kEmissivity, kIndex, 0.0, false});
  scene.Box("plate", {0.0, 0.0, kPlateZ_m}, {kSceneCube_m, kSceneCube_m, kPlateZ_m + 0.01})
      .temperature = Uniform(kPlate_celsius);
  // What shows through a hole is what a disc on the plate shows.
  const Eigen::Vector3d thickness(0.0, 0.0, 0.0001);
  scene.Cylinder("disc", middle - thickness, middle, options.hole_radius_m()).temperature =
      Uniform(options.has_hot_celsius() ? options.hot_celsius() : kDefaultHot_celsius);
  ScanPath path;
  path.target_x_m = {kMiddle_m};
  path.target_y_m = {kMiddle_m};
  path.target_z_m = {kPlateZ_m};
  path.distance_m = {kDistance_m};
  return {scene.Build("aperture-plate"), path, {}};
}

}  // namespace isotherm
