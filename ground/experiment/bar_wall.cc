#include "ground/experiment/bar_wall.h"

namespace isotherm {

SceneBuilder BarWall::Make() {
  SceneBuilder scene(23.0);
  scene.UseMaterial({1.0, 1.0, 0.0, false});
  // They fill the wall from 0.02 to 0.95 m.
  constexpr int kBars = 58;
  for (int i = 0; i < kBars; ++i) {
    const double x = kFirst_m + i * kBar_m;
    const bool hot = i % 2 == 1;
    scene.Box(hot ? "hot bar" : "cold bar", {x, 0.02, kWall_m}, {x + kBar_m, 0.76, kWall_m + 0.05})
        .temperature = Uniform(hot ? kHot_celsius : kCold_celsius);
  }
  // The tracker holds on to these.
  scene.Box("sill", {0.02, 0.76, 0.62}, {0.94, 0.82, 0.86}).temperature = Uniform(kCold_celsius);
  scene.RotatedBox("carton", {0.24, 0.68, 0.70}, {0.12, 0.14, 0.10}, {0, 30, 0}).temperature =
      Uniform(kCold_celsius);
  scene.Sphere("knob", {0.66, 0.70, 0.72}, 0.06).temperature = Uniform(kCold_celsius);
  scene.RotatedBox("box", {0.48, 0.71, 0.70}, {0.08, 0.10, 0.08}, {0, 15, 0}).temperature =
      Uniform(kCold_celsius);
  return scene;
}

}  // namespace isotherm
