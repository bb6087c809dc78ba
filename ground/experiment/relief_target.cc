#include "ground/experiment/relief_target.h"

#include <cmath>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "ground/experiment/model_check.h"

namespace isotherm {
namespace {

// The board's plane along z, and ridges of 5 mm on it, 6 mm wide with 6 mm between them: voxels of
// 1.5 mm keep all of their height, of 4.5 mm 82 % (docs/experiments.md). Beside the ridges the
// board is flat.
constexpr double kPanelZ = 0.60, kRelief_m = 0.005;
constexpr double kRidge_m = 0.006, kPeriod_m = 0.012, kFirstRidge_m = 0.40;
constexpr int kRidges = 6;
constexpr double kTop = 0.46, kBottom = 0.58;
constexpr double kFlatFrom_m = 0.50, kFlatTo_m = 0.57;

class RootMeanSquare {
 public:
  void Add(double value) {
    squares_ += value * value;
    ++count_;
  }
  double value() const {
    return count_ == 0 ? std::nan("") : std::sqrt(squares_ / static_cast<double>(count_));
  }

 private:
  double squares_ = 0.0;
  std::size_t count_ = 0;
};

class Mean {
 public:
  void Add(double value) {
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ == 0 ? std::nan("") : sum_ / static_cast<double>(count_); }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace

StagedScene MakeReliefTarget(const ScanPath& path) {
  SceneBuilder scene(23.0);
  scene.UseMaterial({});
  scene.Box("wall", {0.02, 0.02, 0.84}, {0.94, 0.94, 0.90});
  scene.Box("table", {0.02, 0.70, 0.20}, {0.94, 0.76, 0.84});
  scene.Box("board", {0.36, 0.34, kPanelZ}, {0.60, 0.70, 0.74});
  for (int i = 0; i < kRidges; ++i) {
    const double x = kFirstRidge_m + kPeriod_m * i;
    scene.Box("ridge", {x, kTop, kPanelZ - kRelief_m}, {x + kRidge_m, kBottom, kPanelZ + 0.01});
  }
  scene.Cylinder("knob", {0.40, 0.66, kPanelZ - 0.03}, {0.40, 0.66, kPanelZ + 0.002}, 0.02);
  scene.RotatedBox("carton", {0.22, 0.62, 0.68}, {0.14, 0.16, 0.14}, {0, 30, 0});
  scene.Sphere("ball", {0.70, 0.64, 0.62}, 0.06);
  scene.RotatedBox("book", {0.48, 0.40, kPanelZ}, {0.10, 0.05, 0.04}, {0, 0, 20});
  return {scene.Build("relief target"), path, {}};
}

ScanPath TowardsRelief(const Swing& distance_m) {
  ScanPath path;
  path.target_x_m = {0.48};
  path.target_y_m = {0.52};
  path.target_z_m = {kPanelZ};
  path.distance_m = distance_m;
  return path;
}

ReliefCheck MeasureRelief(const SimulatedScan& scan, const ScanModel& model, ThreadPool& pool) {
  // Heights are taken in the middle millimetres of ridges and grooves, away from the ends.
  constexpr double kMiddle_m = 0.001, kBorder_m = 0.01, kReach_m = 0.012;
  Mean ridges_z, grooves_z;
  RootMeanSquare flat_m, scene_m;
  const std::vector<CheckedPoint> points =
      CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool);
  for (const CheckedPoint& point : points) {
    const Eigen::Vector3d p = point.point.position_m.cast<double>();
    scene_m.Add((p - point.truth.p_world).dot(point.point.normal.cast<double>()));
    if (p.y() < kTop + kBorder_m || p.y() > kBottom - kBorder_m ||
        std::abs(p.z() - kPanelZ) > kReach_m)
      continue;
    if (p.x() > kFlatFrom_m && p.x() < kFlatTo_m) flat_m.Add(p.z() - kPanelZ);
    const double periods = (p.x() - kFirstRidge_m - 0.5 * kRidge_m) / kPeriod_m;
    // The outer flanks have no groove beside them.
    if (periods < 0.25 || periods > kRidges - 1.25) continue;
    const double from_ridge_m = std::abs(periods - std::round(periods)) * kPeriod_m;
    if (from_ridge_m < kMiddle_m) ridges_z.Add(p.z());
    if (from_ridge_m > 0.5 * kPeriod_m - kMiddle_m) grooves_z.Add(p.z());
  }
  return {100.0 * (grooves_z.value() - ridges_z.value()) / kRelief_m, kMmPerM * flat_m.value(),
          kMmPerM * scene_m.value(), static_cast<double>(points.size())};
}

}  // namespace isotherm
