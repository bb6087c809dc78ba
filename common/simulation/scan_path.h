#pragma once

#include <Eigen/Core>

#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// A value that swings around a centre: two sines, so that a long scan does not repeat itself.
struct Swing {
  double center = 0.0;
  double amplitude = 0.0;
  double period_s = 10.0;
  double phase_rad = 0.0;
  double second_amplitude = 0.0;
  double second_period_s = 10.0;

  double At(double time_s) const;
};

/// Says where the rig is during a scan: on an arc around a point of the scene that it looks at, as
/// an operator moves it. Smooth; starts from rest and reaches full speed within about a second.
/// Thread-safe (immutable).
struct ScanPath {
  Swing target_x_m, target_y_m, target_z_m;  ///< The point looked at, in `world`.
  Swing azimuth_rad;                         ///< To the right of the line that looks along +z.
  Swing elevation_rad;                       ///< Above it (towards -y).
  Swing distance_m;                          ///< From the point looked at.
  Swing roll_rad;                            ///< Around the line of sight.

  /// T_world_depth at `time_s` after the start; before the start it is at rest.
  RigidTransform PoseAt(double time_s) const;
};

}  // namespace isotherm
