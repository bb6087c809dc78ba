#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

/// How a lens turns directions into pixels. The models and their coefficients are OpenCV's.
enum class LensKind : std::uint8_t {
  kBrownConrady,  ///< k1 k2 p1 p2 k3
  kRational,      ///< k1 k2 p1 p2 k3 k4 k5 k6, for wide lenses
  kFisheye,       ///< k1 k2 k3 k4 of the angle from the axis, for very wide lenses
};
inline constexpr LensKind kLastLensKind = LensKind::kFisheye;

/// Camera with one of OpenCV's distortions (same order and meaning). Pixel centres are at integer
/// coordinates: pixel (u, v) covers [u - 0.5, u + 0.5). Coordinate frame: optical (x right, y down,
/// z forward). Thermal and depth cameras use the same model (thesis 2.3.5).
struct CameraModel {
  int width = 0;
  int height = 0;
  double fx = std::numeric_limits<double>::quiet_NaN();
  double fy = std::numeric_limits<double>::quiet_NaN();
  double cx = std::numeric_limits<double>::quiet_NaN();
  double cy = std::numeric_limits<double>::quiet_NaN();
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
  double k4 = 0.0, k5 = 0.0, k6 = 0.0;  ///< As far as the lens has them, else 0.
  LensKind lens = LensKind::kBrownConrady;

  /// A fisheye lens always has: without coefficients it is no pinhole.
  bool HasDistortion() const;
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
/// and distortion that is finite and none that the lens does not have. `name` is the camera's field
/// in the rig file, for the message.
Status Validate(const CameraModel& intrinsics, std::string_view name);

/// Normalised image coordinates (x/z, y/z) -> distorted pixel coordinates.
Eigen::Vector2d ProjectNormalized(const CameraModel& camera, const Eigen::Vector2d& normalized);

/// Holds what ProjectNormalized returns, and its derivative by the normalised coordinates.
struct ProjectedPixel {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d by_normalized;
};
ProjectedPixel ProjectWithDerivative(const CameraModel& camera, const Eigen::Vector2d& normalized);

/// Point in the camera's optical frame (metres) -> distorted pixel coordinates; nullopt behind the
/// camera.
std::optional<Eigen::Vector2d> Project(const CameraModel& camera, const Eigen::Vector3d& p_camera);

/// Pixel coordinates (distorted) -> normalised image coordinates without distortion. A pixel beyond
/// the fold of the distortion's polynomial sees no point, nor does one of a fisheye lens that looks
/// 90 degrees aside, and what is returned projects elsewhere.
Eigen::Vector2d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);

}  // namespace isotherm
