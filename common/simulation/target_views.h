#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/perforated_board.h"

namespace isotherm {

/// A camera that must see all holes of a target, and where it is.
struct TargetObserver {
  CameraModel camera;
  RigidTransform T_camera_rig = RigidTransform::Identity();
};

/// How a target is held before the cameras.
struct TargetViewOptions {
  double min_distance_m = 0.6, max_distance_m = 1.0;
  double max_tilt_deg = 42.0;
  double border_px = 4.0;  ///< The holes' rims stay this far from the image's border.
};

/// Poses T_rig_board as a careful person takes them: every part of the image, near and far, tilted
/// about every axis, each hole complete in each camera. The same for the same seed.
std::vector<RigidTransform> SampleTargetViews(const PerforatedBoard& board,
                                              std::span<const TargetObserver> observers, int count,
                                              const TargetViewOptions& options, std::uint64_t seed);

}  // namespace isotherm
