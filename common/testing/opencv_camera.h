#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include "common/geometry/camera.h"

// Our cameras as OpenCV wants them: simulation and reconstruction share one distortion model, so
// only somebody else's can tell whether it is the one that calibrations are made for.
namespace isotherm::testing {

inline cv::Matx33d OpencvMatrix(const CameraModel& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

inline cv::Vec<double, 5> OpencvDistortion(const CameraModel& camera) {
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
}

/// The pixel of `camera` that each pixel of `ideal`, a camera without distortion, shows, by OpenCV,
/// in single precision.
struct OpencvRectification {
  cv::Mat1f x, y;

  OpencvRectification(const CameraModel& camera, const CameraModel& ideal) {
    cv::initUndistortRectifyMap(OpencvMatrix(camera), OpencvDistortion(camera), cv::noArray(),
                                OpencvMatrix(ideal), {ideal.width, ideal.height}, CV_32FC1, x, y);
  }
};

}  // namespace isotherm::testing
