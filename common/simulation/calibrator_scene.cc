#include <cmath>
#include <string>

#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

// The thesis's calibrator (appendix C: target 15.2 cm, emissivity 0.95) on a table in front of a
// wall.
constexpr double kTableY = 0.80;
constexpr double kPanelZ = 0.52;  // Front panel.
constexpr double kLeft = 0.37, kRight = 0.61, kTop = 0.43, kBottom = kTableY - 0.015;
const Vector3d kTarget(0.49, 0.565, kPanelZ);
const Vector3d kTowardsOperator(0.0, 0.0, -1.0);
constexpr double kTargetRadius = 0.076;

void AddRoom(SceneBuilder& scene) {
  Primitive& wall = scene.Box("wall", {0.01, 0.01, 0.90}, {0.95, 0.95, 0.95});
  wall.temperature = Linear(wall, {0.48, 0.95, 0.9}, 21.5, {0.48, 0.01, 0.9}, 24.5);
  scene.Box("table", {0.02, kTableY, 0.24}, {0.94, kTableY + 0.04, 0.90}).temperature =
      Uniform(22.5);
  scene.RotatedBox("carton", {0.185, 0.70, 0.72}, {0.20, 0.20, 0.16}, {0, 24, 0}).temperature =
      Uniform(23.6);
  scene.RotatedBox("book", {0.20, 0.785, 0.44}, {0.17, 0.03, 0.22}, {0, -17, 0}).temperature =
      Uniform(22.9);
}

void AddBody(SceneBuilder& scene, double hot_celsius) {
  const double warm = 24.0 + 0.12 * (hot_celsius - 24.0);
  Primitive& body = scene.Box("housing", {kLeft, kTop, kPanelZ + 0.012}, {kRight, kBottom, 0.74});
  body.temperature = Linear(body, {0.5, kTop, 0.6}, warm + 3.0, {0.5, kBottom, 0.6}, warm - 4.0);
  for (const double x : {kLeft + 0.02, kRight - 0.05}) {
    for (const double z : {kPanelZ + 0.02, 0.70}) {
      scene.Box("foot", {x, kBottom, z}, {x + 0.03, kTableY, z + 0.03}).temperature = Uniform(24.0);
    }
  }
  // Handle above.
  for (const double x : {kLeft + 0.03, kRight - 0.03}) {
    scene.Cylinder("handle post", {x, kTop, 0.62}, {x, kTop - 0.035, 0.62}, 0.008).temperature =
        Uniform(warm - 1.0);
  }
  scene
      .Cylinder("handle", {kLeft + 0.03, kTop - 0.035, 0.62}, {kRight - 0.03, kTop - 0.035, 0.62},
                0.010)
      .temperature = Uniform(warm - 3.0);
  // Ribs on both sides.
  for (int i = 0; i < 5; ++i) {
    const double z = 0.575 + 0.030 * i;
    for (const double x : {kLeft - 0.006, kRight}) {
      scene.Box("rib", {x, 0.50, z}, {x + 0.006, 0.70, z + 0.012}).temperature = Uniform(warm);
    }
  }
}

/// The front panel is made of pieces around ventilation slots through which the housing behind
/// shows.
void AddPanel(SceneBuilder& scene, double hot_celsius) {
  const double warm = 24.0 + 0.16 * (hot_celsius - 24.0);
  const auto piece = [&](const std::string& name, const Vector3d& low, const Vector3d& high) {
    Primitive& part = scene.Box(name, low, high);
    part.temperature = Radial(part, kTarget, kTowardsOperator, warm + 8.0, 0.22, warm - 5.0);
  };
  const double back = kPanelZ + 0.012, slots = 0.690;
  piece("panel", {kLeft, kTop, kPanelZ}, {kRight, slots, back});
  for (int i = 0; i < 5; ++i) {
    const double y = slots + 0.010 + 0.0165 * i;
    piece("panel bar", {kLeft, y, kPanelZ}, {kRight, y + 0.0085, back});
  }
  piece("panel edge", {kLeft, slots + 0.010 + 0.0165 * 5 - 0.002, kPanelZ},
        {kRight, kBottom, back});
  piece("panel middle", {0.48, slots, kPanelZ + 0.001}, {0.50, slots + 0.088, back});
  piece("panel left", {kLeft, slots, kPanelZ + 0.001}, {kLeft + 0.014, slots + 0.088, back});
  piece("panel right", {kRight - 0.014, slots, kPanelZ + 0.001}, {kRight, slots + 0.088, back});

  // The inside is warmer than the panel and shows through the slots.
  scene
      .Box("inside", {kLeft + 0.01, slots, back - 0.001},
           {kRight - 0.01, slots + 0.09, back + 0.004})
      .temperature = Uniform(warm + 9.0);

  Primitive& display =
      scene.Box("display", {0.395, 0.445, kPanelZ - 0.006}, {0.475, 0.473, kPanelZ});
  display.temperature = Uniform(warm + 4.0);
  for (int i = 0; i < 4; ++i) {
    const Vector3d center(0.505 + 0.026 * i, 0.459, kPanelZ);
    scene.Cylinder("button", center + 0.007 * kTowardsOperator, center, 0.0085).temperature =
        Uniform(warm - 2.0);
  }
}

void AddTarget(SceneBuilder& scene, double hot_celsius) {
  Primitive& rim = scene.Tube("rim", kTarget + 0.026 * kTowardsOperator, kTarget,
                              kTargetRadius + 0.012, kTargetRadius + 0.0005);
  rim.temperature = Linear(rim, kTarget, 23.0 + 0.45 * (hot_celsius - 23.0),
                           kTarget + 0.026 * kTowardsOperator, 23.0 + 0.22 * (hot_celsius - 23.0));
  scene.UseMaterial({0.95, 1.5, 0.0, false});
  Primitive& disc =
      scene.Cylinder("hot disc", kTarget + 0.006 * kTowardsOperator, kTarget, kTargetRadius);
  disc.temperature = Radial(disc, kTarget, kTowardsOperator, hot_celsius, kTargetRadius,
                            hot_celsius - 0.002 * (hot_celsius - 23.0));
  scene.UseMaterial({0.96, 1.5, 0.0, false});
}

void AddMug(SceneBuilder& scene) {
  const Vector3d base(0.75, kTableY, 0.50);
  const Vector3d top = base - Vector3d(0.0, 0.095, 0.0);
  Primitive& wall = scene.Tube("mug", base, top, 0.041, 0.037);
  wall.temperature = Linear(wall, base, 52.0, top, 38.0);
  scene.Cylinder("coffee", base, base - Vector3d(0.0, 0.07, 0.0), 0.0368).temperature =
      Uniform(58.0);
  const Vector3d upper = base + Vector3d(0.058, -0.07, 0.0),
                 lower = base + Vector3d(0.058, -0.03, 0.0);
  scene.Cylinder("mug handle", upper, lower, 0.006).temperature = Uniform(33.0);
  scene.Cylinder("mug handle", upper, base + Vector3d(0.038, -0.07, 0), 0.006).temperature =
      Uniform(35.0);
  scene.Cylinder("mug handle", lower, base + Vector3d(0.038, -0.03, 0), 0.006).temperature =
      Uniform(36.0);
  scene.Sphere("mug handle", upper, 0.006).temperature = Uniform(34.0);
  scene.Sphere("mug handle", lower, 0.006).temperature = Uniform(35.0);
}

ScanPath MakeCalibratorPath() {
  ScanPath path;
  path.target_x_m = {0.48, 0.09, 17.0, 0.5, 0.02, 7.0};
  path.target_y_m = {0.60, 0.05, 13.0, 2.2, 0.02, 9.0};
  path.target_z_m = {0.56};
  path.azimuth_rad = {0.0, 0.50, 20.0, -0.9, 0.06, 37.0};
  path.elevation_rad = {0.33, 0.20, 13.0, 0.8, 0.04, 29.0};
  path.distance_m = {0.65, 0.08, 16.0, 1.0, 0.02, 11.0};
  path.roll_rad = {0.0, 0.05, 11.0, 0.4};
  return path;
}

}  // namespace

StagedScene MakeCalibratorScene(const SceneOptions& options) {
  constexpr double kDefaultHot_celsius = 100.0;
  const double hot_celsius =
      options.has_hot_celsius() ? options.hot_celsius() : kDefaultHot_celsius;
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial({0.96, 1.5, 0.0, false});
  AddRoom(scene);
  AddBody(scene, hot_celsius);
  AddPanel(scene, hot_celsius);
  AddTarget(scene, hot_celsius);
  AddMug(scene);
  return {scene.Build("calibrator"), MakeCalibratorPath(), {}};
}

}  // namespace isotherm
