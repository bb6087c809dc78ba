#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

/// Pinhole camera with OpenCV's five-parameter distortion (same order and meaning). Pixel centres
/// are at integer coordinates: pixel (u, v) covers [u - 0.5, u + 0.5). Coordinate frame: optical (x
/// right, y down, z forward). Thermal and depth cameras use the same model (thesis 2.3.5).
struct CameraModel {
  int width = 0;
  int height = 0;
  double fx = std::numeric_limits<double>::quiet_NaN();
  double fy = std::numeric_limits<double>::quiet_NaN();
  double cx = std::numeric_limits<double>::quiet_NaN();
  double cy = std::numeric_limits<double>::quiet_NaN();
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  bool HasDistortion() const {
    return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0;
  }
  /// The same camera without lens distortion (what a rectified image has).
  CameraModel WithoutDistortion() const;
  /// The camera of an image halved `levels` times by 2x2 averaging; sizes round down.
  CameraModel Downscaled(int levels) const;
};

/// A camera without its lens distortion in single precision, as kernels take it.
struct CameraF {
  float fx, fy, cx, cy;
  int width, height;
  explicit CameraF(const CameraModel& c)
      : fx(static_cast<float>(c.fx)),
        fy(static_cast<float>(c.fy)),
        cx(static_cast<float>(c.cx)),
        cy(static_cast<float>(c.cy)),
        width(c.width),
        height(c.height) {}
};

/// Checks sizes (1..16384), finite and positive focal lengths, a principal point inside the image,
/// and finite distortion. `name` is the camera's field in the rig file, for the message.
Status Validate(const CameraModel& intrinsics, std::string_view name);

/// Normalised image coordinates (x/z, y/z) -> distorted pixel coordinates.
Eigen::Vector2d ProjectNormalized(const CameraModel& camera, const Eigen::Vector2d& normalized);

/// Point in the camera's optical frame (metres) -> distorted pixel coordinates; nullopt behind the
/// camera.
std::optional<Eigen::Vector2d> Project(const CameraModel& camera, const Eigen::Vector3d& p_camera);

/// Pixel coordinates (distorted) -> normalised image coordinates without distortion. A pixel beyond
/// the fold of the distortion's polynomial sees no point, and what is returned projects elsewhere.
Eigen::Vector2d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);

}  // namespace isotherm
