#include "ground/experiment/resolution_target.h"

#include <array>
#include <cmath>
#include <string>

#include "common/simulation/scene_builder.h"
#include "ground/experiment/model_check.h"

namespace isotherm {
namespace {

// The panel's plane, along z; five pairs of bars of each width lie in it.
constexpr double kPanelZ = 0.60;
constexpr int kPeriods = 5;

}  // namespace

StagedScene MakeResolutionTarget(std::span<const double> bar_widths_m, const Swing& distance_m) {
  SceneBuilder scene(23.0);
  scene.UseMaterial({1.0, 1.0, 0.0, false});
  scene.Box("wall", {0.02, 0.02, 0.84}, {0.94, 0.94, 0.90}).temperature = Uniform(24.0);
  scene.Box("table", {0.02, 0.70, 0.20}, {0.94, 0.76, 0.84}).temperature = Uniform(24.0);
  scene.Box("panel", {0.36, 0.34, kPanelZ + 0.002}, {0.60, 0.70, 0.74}).temperature =
      Uniform(kColdBar_celsius);
  scene.Cylinder("knob", {0.40, 0.66, kPanelZ - 0.03}, {0.40, 0.66, kPanelZ + 0.002}, 0.02)
      .temperature = Uniform(kColdBar_celsius);
  scene.RotatedBox("carton", {0.22, 0.62, 0.68}, {0.14, 0.16, 0.14}, {0, 30, 0}).temperature =
      Uniform(24.0);
  double x = 0.42;
  for (const double width : bar_widths_m) {
    for (int bar = 0; bar < 2 * kPeriods; ++bar, x += width) {
      const bool hot = bar % 2 == 0;
      scene.Box(hot ? "hot bar" : "cold bar", {x, 0.47, kPanelZ}, {x + width, 0.57, kPanelZ + 0.01})
          .temperature = Uniform(hot ? kHotBar_celsius : kColdBar_celsius);
    }
    x += 0.010;
  }
  ScanPath path;
  path.target_x_m = {0.48, 0.005, 1.5};
  path.target_y_m = {0.52, 0.005, 1.1};
  path.target_z_m = {kPanelZ};
  path.distance_m = distance_m;
  return {scene.Build("resolution target"), path, {}};
}

std::vector<BarGroup> MeasureBars(const SimulatedScan& scan, const ScanModel& model,
                                  std::span<const double> bar_widths_m, ThreadPool& pool) {
  constexpr double kMiddleFraction = 0.15;  // Of a bar's width, to either side of its middle.
  struct Sum {
    double celsius = 0.0;
    std::size_t count = 0, points = 0;
    double Mean() const { return count == 0 ? std::nan("") : celsius / static_cast<double>(count); }
  };
  std::vector<std::array<Sum, 2>> sums(bar_widths_m.size());
  for (const CheckedPoint& point :
       CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool)) {
    const Primitive& part =
        scan.scene().primitives()[static_cast<std::size_t>(point.truth.primitive)];
    if (!part.name.ends_with("bar")) continue;
    const Eigen::Vector3d p = part.T_world_primitive.inverse() * point.truth.p_world;
    // `size` has half lengths.
    if (std::abs(p.x()) > 2.0 * kMiddleFraction * part.size.x()) continue;
    if (std::abs(p.y()) > 0.8 * part.size.y()) continue;
    for (std::size_t group = 0; group < bar_widths_m.size(); ++group) {
      if (std::abs(2.0 * part.size.x() - bar_widths_m[group]) > 1e-4) continue;
      Sum& sum = sums[group][part.name == "hot bar" ? 1 : 0];
      ++sum.points;
      if (!point.measured()) continue;
      sum.celsius += static_cast<double>(point.point.celsius);
      ++sum.count;
    }
  }
  std::vector<BarGroup> groups(bar_widths_m.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    const auto& [cold, hot] = sums[group];
    groups[group] = {(hot.Mean() - cold.Mean()) / (kHotBar_celsius - kColdBar_celsius),
                     Percent(cold.count + hot.count, cold.points + hot.points)};
  }
  return groups;
}

}  // namespace isotherm
