#include "ground/experiment/raster_path.h"

#include <algorithm>
#include <cmath>

#include "common/base/quantile.h"
#include "common/base/units.h"
#include "common/simulation/scenes.h"

namespace isotherm {
namespace {

/// Neighbouring rows share this fraction of their width.
constexpr double kOverlap = 0.2;

/// The rig is never held nearer than this to anything.
constexpr double kClearance_m = 0.12;

double RasterDistance(const ThermalOptions& limits) {
  return 0.5 * (limits.distance().min_m() + limits.distance().good_m());
}

/// Values from `low` to `high` so that views of `size` around them cover everything, with overlap.
std::vector<double> Rows(double low, double high, double size) {
  const double first = low + size / 2.0, last = high - size / 2.0;
  if (last <= first) return {0.5 * (low + high)};
  const int gaps = static_cast<int>(std::ceil((last - first) / ((1.0 - kOverlap) * size)));
  std::vector<double> rows;
  for (int i = 0; i <= gaps; ++i) rows.push_back(first + (last - first) * i / gaps);
  return rows;
}

/// Says whether a rig can be at `viewer` and see `target`.
bool CanLookFrom(const Scene& scene, const Eigen::Vector3d& viewer, const Eigen::Vector3d& target) {
  if (scene.IsCovered(viewer, -1, kClearance_m)) return false;
  const auto hit = scene.Intersect(viewer, target - viewer);
  constexpr double kNearly = 0.6;  // Something before the target may well be the object.
  return !hit || hit->distance > kNearly;
}

/// A pass over the front with the cameras turned.
class Pass {
 public:
  Pass(const Scene& scene, const Rig& rig, const ThermalOptions& limits,
       const Eigen::Matrix3d& R_world_thermal)
      : scene_(scene),
        rig_(rig),
        R_world_thermal_(R_world_thermal),
        front_(FrontOf(scene)),
        distance_m_(RasterDistance(limits)) {}

  void AddTo(std::vector<Waypoint>& path, double speed_m_s) const {
    const CameraModel& camera = *rig_.thermal;
    const double width = distance_m_ * camera.width / camera.fx;
    const double height = distance_m_ * camera.height / camera.fy;
    const Eigen::Vector2d low = front_.region_m.min(), high = front_.region_m.max();
    const std::vector<double> columns = Rows(low.x(), high.x(), width);
    bool is_first = true, to_the_right = true;
    for (const double y : Rows(low.y(), high.y(), height)) {
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const double x = columns[to_the_right ? i : columns.size() - 1 - i];
        const Eigen::Vector3d target(x, y, front_.median_z_m);
        RigidTransform T_world_thermal = RigidTransform::Identity();
        T_world_thermal.linear() = R_world_thermal_;
        T_world_thermal.translation() = target - distance_m_ * R_world_thermal_.col(2);
        if (!CanLookFrom(scene_, T_world_thermal.translation(), target)) continue;
        // The way to a pass measures nothing: it is gone at a walking pace.
        constexpr OperatorTraits kWalk;
        path.push_back({T_world_thermal * *rig_.T_thermal_depth,
                        is_first ? kWalk.speed_m_s : speed_m_s, kWalk.rotation_rate_deg_s});
        is_first = false;
      }
      to_the_right = !to_the_right;
    }
  }

 private:
  const Scene& scene_;
  const Rig& rig_;
  const Eigen::Matrix3d R_world_thermal_;
  const SceneFront front_;
  const double distance_m_;
};

}  // namespace

SceneFront FrontOf(const Scene& scene) {
  // Finer than the parts that scenes are made of.
  constexpr double kStep_m = 0.01;
  SceneFront front;
  std::vector<double> depths_m;
  for (double y = 0.5 * kStep_m; y < kSceneCube_m; y += kStep_m) {
    for (double x = 0.5 * kStep_m; x < kSceneCube_m; x += kStep_m) {
      const Eigen::Vector3d origin(x, y, -1.0);
      const auto hit = scene.Intersect(origin, Eigen::Vector3d::UnitZ());
      if (!hit) continue;
      front.region_m.extend(Eigen::Vector2d(x, y));
      depths_m.push_back(origin.z() + hit->distance);
    }
  }
  if (!depths_m.empty()) front.median_z_m = TakeMedian(depths_m);
  return front;
}

double RasterSpeed(const Rig& rig, const ThermalOptions& limits) {
  // A fifth below the speed at which temperatures cease to be sharp.
  constexpr double kOfGood = 0.8;
  const double smear_per_m = rig.thermal->fx / RasterDistance(limits);  // Pixels.
  return kOfGood * limits.expert().motion().smear_good_px() /
         (rig.thermal_sensor.time_constant_s * smear_per_m);
}

std::vector<Waypoint> RasterPath(const Scene& scene, const Rig& rig, const ThermalOptions& limits,
                                 double speed_m_s) {
  const double askew_rad = (90.0 - limits.angle().good_deg()) * kRadPerDeg;
  std::vector<Waypoint> path;
  const auto turned = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  // Straight on, then from the left, the right, above and below.
  for (const Eigen::Matrix3d& R_world_thermal :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turned(askew_rad, Eigen::Vector3d::UnitY()),
        turned(-askew_rad, Eigen::Vector3d::UnitY()), turned(-askew_rad, Eigen::Vector3d::UnitX()),
        turned(askew_rad, Eigen::Vector3d::UnitX())}) {
    Pass(scene, rig, limits, R_world_thermal).AddTo(path, speed_m_s);
  }
  return path;
}

}  // namespace isotherm
