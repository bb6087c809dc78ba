#pragma once

#include <cstdint>
#include <vector>

#include "common/simulation/perforated_board.h"
#include "common/simulation/target_camera.h"
#include "common/simulation/target_views.h"
#include "ground/camera_calibration/target_calibration.h"

namespace isotherm {

/// The thesis's cameras (table 5.1), and the thermal camera's pose relative to the depth camera.
CameraModel ThesisThermal();
CameraModel ThesisDepth();
RigidTransform ThesisThermalFromDepth();

/// The same camera as the calibration has it.
BundleCamera ToBundle(const CameraModel& camera);

/// Describes what a simulated calibration is taken from.
struct TargetSession {
  PerforatedBoard board;
  TargetCameraOptions cameras;
  TargetViewOptions views;
  int count = 30;
  std::uint64_t seed = 1;
  bool thermal = true, depth = false;
  CameraModel thermal_camera = ThesisThermal();
  /// kDepth: images of the holes from eight depth images each (BoardImage).
  enum class DepthImages { kInfrared, kDepth } depth_images = DepthImages::kInfrared;
};

/// Views of the thesis's target by the thesis's cameras: "depth" first, if both are asked for.
CalibrationInput TakeViews(const TargetSession& session, ThreadPool& pool);

/// A board with a bowl, a twist and a bend that differ from seed to seed, up to `max_m` in all.
PerforatedBoard WarpedBoard(double max_m, std::uint64_t seed);

}  // namespace isotherm
