#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/camera.h"

// Our cameras as OpenCV wants them: simulation and reconstruction share one distortion model, so
// only somebody else's can tell whether it is the one that calibrations are made for.
namespace isotherm::testing {

inline cv::Matx33d OpencvMatrix(const CameraModel& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

inline std::vector<double> OpencvDistortion(const CameraModel& c) {
  if (c.lens == LensKind::kFisheye) return {c.k1, c.k2, c.k3, c.k4};
  if (c.lens == LensKind::kRational) return {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6};
  return {c.k1, c.k2, c.p1, c.p2, c.k3};
}

/// The pixels of `camera` that see points of a frame that is turned and moved before it.
inline std::vector<cv::Point2d> OpencvProject(const CameraModel& camera,
                                              const std::vector<cv::Point3d>& points,
                                              const cv::Vec3d& axis_angle,
                                              const cv::Vec3d& translation) {
  std::vector<cv::Point2d> pixels;
  if (camera.lens == LensKind::kFisheye) {
    cv::fisheye::projectPoints(points, pixels, axis_angle, translation, OpencvMatrix(camera),
                               OpencvDistortion(camera));
  } else {
    cv::projectPoints(points, axis_angle, translation, OpencvMatrix(camera),
                      OpencvDistortion(camera), pixels);
  }
  return pixels;
}

/// Where `ideal`, a camera without distortion, sees what pixels of `camera` show.
inline std::vector<cv::Point2d> OpencvUndistort(const CameraModel& camera,
                                                const std::vector<cv::Point2d>& pixels,
                                                const cv::Matx33d& ideal) {
  std::vector<cv::Point2d> undistorted;
  const cv::TermCriteria to_the_end(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12);
  if (camera.lens == LensKind::kFisheye) {
    cv::fisheye::undistortPoints(pixels, undistorted, OpencvMatrix(camera),
                                 OpencvDistortion(camera), cv::noArray(), ideal, to_the_end);
  } else {
    cv::undistortPoints(pixels, undistorted, OpencvMatrix(camera), OpencvDistortion(camera),
                        cv::noArray(), ideal, to_the_end);
  }
  return undistorted;
}

/// The pixel of `camera` that each pixel of `ideal`, a camera without distortion, shows, by OpenCV,
/// in single precision.
struct OpencvRectification {
  cv::Mat1f x, y;

  OpencvRectification(const CameraModel& camera, const CameraModel& ideal) {
    const cv::Size size(ideal.width, ideal.height);
    if (camera.lens == LensKind::kFisheye) {
      cv::fisheye::initUndistortRectifyMap(OpencvMatrix(camera), OpencvDistortion(camera),
                                           cv::Matx33d::eye(), OpencvMatrix(ideal), size, CV_32FC1,
                                           x, y);
    } else {
      cv::initUndistortRectifyMap(OpencvMatrix(camera), OpencvDistortion(camera), cv::noArray(),
                                  OpencvMatrix(ideal), size, CV_32FC1, x, y);
    }
  }
};

}  // namespace isotherm::testing
