#pragma once

#include <cstdint>
#include <functional>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/radiometry/radiometry.h"
#include "common/simulation/perforated_board.h"

namespace isotherm {

/// Says what a camera that looks at a calibration target adds to what is there.
struct TargetCameraOptions {
  double blur_px = 0.6;         ///< Standard deviation of the optical blur.
  double netd_k = 0.05;         ///< Thermal noise.
  double infrared_noise = 1.5;  ///< In units of the 8-bit image.
  double disparity_noise_px = 0.085;
  double baseline_m = 0.075;  ///< From the depth camera to its projector, which is to its right.
};

/// Takes images of a calibration target: each pixel is the mean over its area, where the image is
/// uneven, then come blur, noise and rounding. Stands still. Thread-safe (immutable).
class TargetCamera {
 public:
  TargetCamera(const CameraModel& camera, const TargetCameraOptions& options);

  /// Apparent temperature in centi-kelvin. The same `noise_stream` gives the same noise.
  Image<std::uint16_t> Thermal(const PerforatedBoard& board, const RigidTransform& T_camera_board,
                               std::uint64_t noise_stream) const;
  /// Brightness, 0 to 255: a light board, dark behind its holes, lit from the camera.
  Image<std::uint8_t> Infrared(const PerforatedBoard& board, const RigidTransform& T_camera_board,
                               std::uint64_t noise_stream) const;
  /// Depth in millimetres by disparities that blocks of pixels agree on, 0 = no return, as in the
  /// projector's shadow.
  Image<std::uint16_t> Depth(const PerforatedBoard& board, const RigidTransform& T_camera_board,
                             std::uint64_t noise_stream) const;

 private:
  using Shade = std::function<double(const BoardHit&)>;

  BoardHit HitAt(const PerforatedBoard& board, const RigidTransform& T_board_camera, int x, int y,
                 double right, double down) const;
  /// The mean of `shade` over each pixel, blurred.
  Image<float> Render(const PerforatedBoard& board, const RigidTransform& T_camera_board,
                      const Shade& shade) const;
  double MeanOverPixel(const PerforatedBoard& board, const RigidTransform& T_board_camera, int x,
                       int y, const Shade& shade) const;

  const CameraModel camera_;
  const TargetCameraOptions options_;
  const BandRadiance band_;
  Image<Eigen::Vector2d> corners_;  ///< Normalised coordinates of the pixels' upper left corners.
};

}  // namespace isotherm
