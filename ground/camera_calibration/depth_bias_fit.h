#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/rig/depth_bias.h"
#include "ground/camera_calibration/wall_view.h"

namespace isotherm {

/// Holds what a wall that is known to be flat tells of a depth camera.
struct DepthBiasReport {
  DepthBias bias;                    ///< By what distances have to be multiplied.
  std::size_t frames = 0;            ///< Were looked at.
  std::size_t walls = 0;             ///< Show a wall, and nothing before it, in most of the image.
  double near_m = 0.0, far_m = 0.0;  ///< Distances of the wall.
  /// Nodes that the wall was seen at, and all. The others take after their neighbours.
  int seen_nodes = 0, nodes = 0;
  /// How far the wall is from a plane, as a fraction of the distance, root mean square over the
  /// image and the distances, without noise: in frames that were held out, as the calibration at
  /// hand corrects them and as this one does.
  double before_rms = 0.0, after_rms = 0.0;
  /// Difference of the multipliers that two halves of the scan give, root mean square.
  double halves_rms = 0.0;

  /// Says whether it is worth to be written.
  bool Improves() const { return after_rms < 0.9 * before_rms; }
};

/// Finds by what a depth camera's distances are wrong from images of a flat wall at several
/// distances and angles. The inverse depth of a plane is linear over the image, so multipliers and
/// planes solve linear equations together; what is not the wall is left out step by step.
/// A wall tells neither how far away it is nor how it is turned: distances in the middle of the
/// image are taken as right, and so is what grows across or down the image with the distance.
/// Thread-compatible.
class DepthBiasFit {
 public:
  /// `before`: what the calibration at hand says, to compare with.
  DepthBiasFit(const CameraModel& depth_camera, DepthBias before);

  /// `depth_m`: as measured, in the camera's size (CHECK); 0 or NaN = no return. Of many frames
  /// some are kept.
  void Add(double time_s, const Image<float>& depth_m);

  /// Fails with what is missing. `progress` gets the fraction done, 0..1.
  Result<DepthBiasReport> Solve(const std::function<void(double)>& progress) const;

 private:
  const CameraModel camera_;
  const DepthBias before_;
  std::vector<WallView> views_;
  std::size_t frames_ = 0, stride_ = 1;
};

}  // namespace isotherm
