#include "common/simulation/scenes.h"

#include <utility>

#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {

StagedScene MakeScene(const SceneOptions& options) {
  switch (options.scene()) {
    case CALIBRATOR:
      return MakeCalibratorScene(options);
    case PLANE:
      return MakePlaneScene(options);
    case FLAT_WALL:
      return MakeFlatWallScene(options);
    case APERTURE_PLATE:
      return MakeAperturePlateScene(options);
    case CORNER_SPHERE:
      return MakeCornerSphereScene(options);
    case FURNACE_DOOR:
      break;
  }
  return MakeFurnaceDoorScene(options);
}

Scene SceneAround(const StagedScene& staged, const RigidTransform& T_world_depth) {
  std::vector<Primitive> primitives = staged.scene.primitives();
  for (const Primitive& carried : staged.carried) {
    primitives.push_back(carried);
    primitives.back().T_world_primitive = T_world_depth * carried.T_world_primitive;
  }
  return Scene(staged.scene.name(), std::move(primitives), staged.scene.materials(),
               staged.scene.surround_celsius());
}

StagedScene MakePlaneScene(const SceneOptions& options) {
  constexpr double kDefault_celsius = 30.0;
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial({1.0, 1.0, 0.0, false});  // Black.
  scene.Box("wall", {0.0, 0.0, 0.6}, {kSceneCube_m, kSceneCube_m, 0.7}).temperature =
      Uniform(options.has_hot_celsius() ? options.hot_celsius() : kDefault_celsius);
  ScanPath path;
  path.target_x_m = {kSceneCube_m / 2.0};
  path.target_y_m = {kSceneCube_m / 2.0};
  path.target_z_m = {0.6};
  path.distance_m = {0.6};
  return {scene.Build("plane"), path, {}};
}

StagedScene MakeFlatWallScene(const SceneOptions& options) {
  constexpr double kDefault_celsius = 30.0, kSide_m = 3.0, kMiddle_m = kSceneCube_m / 2.0;
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial({});
  scene.RotatedBox("wall", {kMiddle_m, kMiddle_m, 0.9}, {kSide_m, kSide_m, 0.1}, {0.0, 0.0, 0.0})
      .temperature = Uniform(options.has_hot_celsius() ? options.hot_celsius() : kDefault_celsius);
  ScanPath path;
  path.target_x_m = {kMiddle_m, 0.05, 7.0};
  path.target_y_m = {kMiddle_m, 0.05, 9.0};
  path.target_z_m = {0.85};
  path.azimuth_rad = {0.0, 0.3, 14.0, 0.5};
  path.elevation_rad = {0.0, 0.25, 11.0, 0.2};
  path.distance_m = {0.8, 0.35, 20.0, -1.2};
  path.roll_rad = {0.0, 0.2, 13.0};
  return {scene.Build("flat-wall"), path, {}};
}

StagedScene MakeCornerSphereScene(const SceneOptions& options) {
  constexpr double kDefault_celsius = 80.0;
  const double hot_celsius = options.has_hot_celsius() ? options.hot_celsius() : kDefault_celsius;
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial({});
  scene.Box("back wall", {0.02, 0.02, 0.86}, {0.94, 0.94, 0.92}).temperature = Uniform(24.0);
  scene.Box("side wall", {0.02, 0.02, 0.40}, {0.08, 0.94, 0.86}).temperature = Uniform(28.0);
  scene.Box("floor", {0.08, 0.80, 0.40}, {0.94, 0.86, 0.86}).temperature = Uniform(26.0);
  Primitive& sphere = scene.Sphere("sphere", {0.48, 0.64, 0.66}, 0.14);
  sphere.temperature =
      Linear(sphere, {0.48, 0.50, 0.66}, hot_celsius, {0.48, 0.78, 0.66}, hot_celsius - 20.0);
  ScanPath path;
  path.target_x_m = {0.44, 0.04, 17.0, 0.3};
  path.target_y_m = {0.56, 0.04, 13.0, 2.2};
  path.target_z_m = {0.72};
  path.azimuth_rad = {0.25, 0.35, 15.0, -0.9};
  path.elevation_rad = {0.35, 0.18, 11.0, 0.8};
  path.distance_m = {0.60, 0.08, 13.0, 1.0};
  return {scene.Build("corner-sphere"), path, {}};
}

}  // namespace isotherm
