#include "common/simulation/scan_path.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

/// Time that runs slowly at first: the speed is 1 - exp(-t / tau).
double EaseIn(double time_s) {
  // A person sets a rig in motion within a second; with a jump in speed the first frames would be
  // lost.
  constexpr double kTau_s = 0.3;
  const double t = std::max(0.0, time_s);
  return t - kTau_s * (1.0 - std::exp(-t / kTau_s));
}

}  // namespace

double Swing::At(double time_s) const {
  return center + amplitude * std::sin(kFullCircle_rad * time_s / period_s + phase_rad) +
         second_amplitude * std::sin(kFullCircle_rad * time_s / second_period_s);
}

RigidTransform ScanPath::PoseAt(double time_s) const {
  const double t = EaseIn(time_s);
  const Eigen::Vector3d target(target_x_m.At(t), target_y_m.At(t), target_z_m.At(t));
  const double azimuth = azimuth_rad.At(t), elevation = elevation_rad.At(t);
  const Eigen::Vector3d backward(std::sin(azimuth) * std::cos(elevation), -std::sin(elevation),
                                 -std::cos(azimuth) * std::cos(elevation));
  // Optical axes in `world`, whose y points down: z forward, x right, y down.
  const Eigen::Vector3d z = -backward;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Matrix3d R_world_level;
  R_world_level << x, z.cross(x), z;
  const Eigen::AngleAxisd roll(roll_rad.At(t), Eigen::Vector3d::UnitZ());
  RigidTransform T_world_depth = RigidTransform::Identity();
  T_world_depth.linear() = R_world_level * roll.toRotationMatrix();
  T_world_depth.translation() = target + distance_m.At(t) * backward;
  return T_world_depth;
}

}  // namespace isotherm
