#pragma once

#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/bundle.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// Holds what OpenCV's calibration makes of centres of images of features, the board taken as flat.
struct OpenCvCalibration {
  LensParameters lens{};
  std::vector<RigidTransform> T_camera_board;  ///< By view.
  double rms_px = 0.0;
};

/// OpenCV's calibrateCamera, or fisheye::calibrate, with all the coefficients that the lens has.
Result<OpenCvCalibration> CalibrateWithOpenCv(
    const CalibrationTarget& target, const std::vector<std::vector<Eigen::Vector2d>>& views,
    const Eigen::Vector2i& size_px, LensKind kind);

/// Two radial coefficients of Brown and Conrady's and the focal lengths alone, which few or poor
/// views determine as well: where others start.
Result<OpenCvCalibration> StartWithOpenCv(const CalibrationTarget& target,
                                          const std::vector<std::vector<Eigen::Vector2d>>& views,
                                          const Eigen::Vector2i& size_px);

/// The pose of a flat target before a camera with a known lens, from centres of images of features.
RigidTransform FindPose(const CalibrationTarget& target,
                        const std::vector<Eigen::Vector2d>& features, const LensParameters& lens);

}  // namespace isotherm
