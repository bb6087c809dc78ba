#include <cmath>
#include <numbers>
#include <string>

#include "common/simulation/scene_builder.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

constexpr double kWallZ = 0.86;            // Front of the wall.
constexpr double kFrameZ = 0.815;          // Front of the frame.
constexpr double kDoorZ = 0.795;           // Front of the door leaf.
const Vector3d kPort(0.44, 0.44, kDoorZ);  // Middle of the observation port.
const Vector3d kForward(0.0, 0.0, -1.0);   // Towards the operator.

Material PaintedSteel() { return {0.96, 1.5, 0.0, false}; }
Material PolishedSteel() { return {0.25, 12.0, 40.0, true}; }

void AddWall(SceneBuilder& scene) {
  Primitive& wall = scene.Box("wall", {0.01, 0.01, kWallZ}, {0.95, 0.95, 0.94});
  wall.temperature = Linear(wall, {0.48, 0.95, kWallZ}, 31.0, {0.48, 0.01, kWallZ}, 48.0);
  Primitive& duct = scene.Box("cable duct", {0.06, 0.035, 0.80}, {0.70, 0.085, kWallZ});
  duct.temperature = Linear(duct, {0.06, 0.06, 0.8}, 36.0, {0.70, 0.06, 0.8}, 44.0);
  scene.Box("sill", {0.03, 0.89, 0.74}, {0.78, 0.925, kWallZ}).temperature = Uniform(38.0);
}

void AddFrame(SceneBuilder& scene) {
  const auto beam = [&](const std::string& name, const Vector3d& low, const Vector3d& high) {
    Primitive& part = scene.Box(name, low, high);
    part.temperature = Radial(part, kPort, kForward, 92.0, 0.45, 55.0);
  };
  beam("frame left", {0.115, 0.125, kFrameZ}, {0.175, 0.805, kWallZ});
  beam("frame right", {0.675, 0.125, kFrameZ}, {0.735, 0.805, kWallZ});
  beam("frame top", {0.175, 0.125, kFrameZ}, {0.675, 0.185, kWallZ});
  beam("frame bottom", {0.175, 0.745, kFrameZ}, {0.675, 0.805, kWallZ});
}

void AddLeaf(SceneBuilder& scene) {
  Primitive& leaf = scene.Box("door leaf", {0.19, 0.20, kDoorZ}, {0.66, 0.73, 0.85});
  leaf.temperature = Radial(leaf, kPort, kForward, 215.0, 0.36, 88.0);
  // Louvre in the lower part.
  for (int i = 0; i < 4; ++i) {
    Primitive& slat = scene.RotatedBox("slat", {0.34, 0.610 + 0.028 * i, kDoorZ - 0.010},
                                       {0.22, 0.004, 0.030}, {-48.0, 0.0, 0.0});
    slat.temperature = Linear(slat, {0.34, 0.6, kDoorZ}, 104.0, {0.34, 0.6, kDoorZ - 0.02}, 84.0);
  }
  Primitive& brace = scene.RotatedBox("brace", {0.575, 0.655, kDoorZ - 0.005}, {0.17, 0.022, 0.012},
                                      {0.0, 0.0, -38.0});
  brace.temperature = Radial(brace, kPort, kForward, 180.0, 0.36, 84.0);
}

void AddPort(SceneBuilder& scene, double hot_celsius) {
  Primitive& flange =
      scene.Cylinder("flange", kPort + 0.014 * kForward, kPort - 0.01 * kForward, 0.125);
  flange.temperature = Radial(flange, kPort, kForward, 0.85 * hot_celsius, 0.13, 165.0);
  Primitive& disc = scene.Cylinder("hot disc", kPort + 0.022 * kForward, kPort, 0.075);
  disc.temperature = Radial(disc, kPort, kForward, hot_celsius, 0.075, 0.93 * hot_celsius);
  Primitive& rim = scene.Tube("rim", kPort + 0.040 * kForward, kPort, 0.088, 0.0755);
  rim.temperature =
      Linear(rim, kPort, 0.8 * hot_celsius, kPort + 0.04 * kForward, 0.6 * hot_celsius);
  constexpr int kBolts = 8;
  for (int i = 0; i < kBolts; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kBolts;
    const Vector3d center = kPort + 0.107 * Vector3d(std::cos(angle), std::sin(angle), 0.0);
    scene.Cylinder("bolt", center + 0.024 * kForward, center, 0.0075).temperature = Uniform(150.0);
  }
}

void AddHinges(SceneBuilder& scene) {
  for (const double y : {0.29, 0.62}) {
    const Vector3d low(0.181, y, kDoorZ - 0.012);
    scene.Box("hinge plate", {0.135, y + 0.012, kFrameZ - 0.008}, {0.178, y + 0.078, kFrameZ})
        .temperature = Uniform(72.0);
    Primitive& leaf =
        scene.Box("hinge leaf", {0.184, y + 0.012, kDoorZ - 0.006}, {0.24, y + 0.078, kDoorZ});
    leaf.temperature = Linear(leaf, {0.184, y, kDoorZ}, 84.0, {0.24, y, kDoorZ}, 112.0);
    scene.Cylinder("hinge pin", low, low + Vector3d(0.0, 0.09, 0.0), 0.014).temperature =
        Uniform(80.0);
    scene.Sphere("hinge knob", low - Vector3d(0.0, 0.004, 0.0), 0.012).temperature = Uniform(76.0);
  }
}

void AddHandle(SceneBuilder& scene) {
  const Vector3d top(0.615, 0.345, kDoorZ - 0.058), bottom(0.615, 0.535, kDoorZ - 0.058);
  for (const Vector3d& end : {top, bottom}) {
    Primitive& post = scene.Cylinder("handle post", {end.x(), end.y(), kDoorZ}, end, 0.0095);
    post.temperature = Linear(post, {end.x(), end.y(), kDoorZ}, 128.0, end, 70.0);
    scene.Sphere("handle end", end, 0.0125).temperature = Uniform(66.0);
  }
  scene.Cylinder("handle", top, bottom, 0.0125).temperature = Uniform(58.0);
  scene.RotatedBox("latch", {0.668, 0.44, kDoorZ - 0.012}, {0.085, 0.032, 0.016}, {0.0, 0.0, 12.0})
      .temperature = Uniform(82.0);
}

void AddPipe(SceneBuilder& scene) {
  const Vector3d top(0.845, 0.13, 0.775), bottom(0.845, 0.945, 0.775);
  Primitive& pipe = scene.Cylinder("pipe", top, bottom, 0.030);
  pipe.temperature = Linear(pipe, top, 138.0, bottom, 62.0);
  scene.Sphere("elbow", top, 0.0335).temperature = Uniform(138.0);
  Primitive& inlet = scene.Cylinder("inlet", top, Vector3d(top.x(), top.y(), kWallZ), 0.030);
  inlet.temperature = Uniform(139.0);
  for (const double y : {0.33, 0.70}) {
    const Vector3d from(top.x(), y, top.z()), to(top.x(), y + 0.018, top.z());
    scene.Cylinder("pipe flange", from, to, 0.050).temperature = Uniform(120.0 - 75.0 * (y - 0.33));
    scene.Cylinder("pipe flange", to + Vector3d(0, 0.003, 0), to + Vector3d(0, 0.021, 0), 0.050)
        .temperature = Uniform(118.0 - 75.0 * (y - 0.33));
  }
  Primitive& wheel =
      scene.Tube("valve wheel", {0.845, 0.52, 0.690}, {0.845, 0.52, 0.701}, 0.045, 0.036);
  wheel.temperature = Uniform(48.0);
  Primitive& spoke = scene.Box("valve spoke", {0.803, 0.515, 0.692}, {0.887, 0.525, 0.699});
  spoke.temperature = Uniform(52.0);
  Primitive& stem = scene.Cylinder("valve stem", {0.845, 0.52, 0.775}, {0.845, 0.52, 0.688}, 0.009);
  stem.temperature = Linear(stem, {0.845, 0.52, 0.745}, 94.0, {0.845, 0.52, 0.69}, 55.0);
}

void AddPlate(SceneBuilder& scene, bool polished) {
  if (polished) scene.UseMaterial(PolishedSteel());
  // In front of the wall below the door, turned towards the port so that a mirror would show it.
  Primitive& plate =
      scene.RotatedBox("plate", {0.40, 0.848, 0.735}, {0.20, 0.13, 0.005}, {-38, 9, 3});
  plate.temperature = Linear(plate, {0.3, 0.85, 0.735}, 33.0, {0.5, 0.85, 0.735}, 37.0);
  if (polished) scene.UseMaterial(PaintedSteel());
  scene.RotatedBox("name plate", {0.31, 0.243, kDoorZ - 0.004}, {0.13, 0.05, 0.008}, {0, 0, 0})
      .temperature = Uniform(96.0);
  // A gauge on the frame.
  const Vector3d gauge(0.60, 0.155, kFrameZ);
  scene.Cylinder("gauge", gauge + 0.032 * kForward, gauge, 0.038).temperature = Uniform(52.0);
  scene.Tube("gauge rim", gauge + 0.038 * kForward, gauge, 0.042, 0.0385).temperature =
      Uniform(56.0);
}

ScanPath MakePath() {
  ScanPath path;
  path.target_x_m = {0.48, 0.12, 17.0, 0.3, 0.02, 7.0};
  path.target_y_m = {0.48, 0.12, 13.0, 2.2, 0.02, 9.0};
  path.target_z_m = {0.79};
  path.azimuth_rad = {0.0, 0.52, 20.0, -0.9, 0.06, 37.0};
  path.elevation_rad = {0.08, 0.30, 13.0, 0.8, 0.04, 29.0};
  path.distance_m = {0.60, 0.10, 16.0, 1.0, 0.02, 11.0};
  path.roll_rad = {0.0, 0.05, 11.0, 0.4};
  return path;
}

}  // namespace

StagedScene MakeFurnaceDoorScene(const SceneOptions& options) {
  constexpr double kDefaultHot_celsius = 280.0;
  const double hot_celsius =
      options.has_hot_celsius() ? options.hot_celsius() : kDefaultHot_celsius;
  SceneBuilder scene(options.surround_celsius());
  scene.UseMaterial(PaintedSteel());
  AddWall(scene);
  AddFrame(scene);
  AddLeaf(scene);
  AddPort(scene, hot_celsius);
  AddHinges(scene);
  AddHandle(scene);
  AddPipe(scene);
  AddPlate(scene, options.specular_reflections());
  return {scene.Build("furnace-door"), MakePath(), {}};
}

}  // namespace isotherm
