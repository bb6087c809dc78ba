#pragma once

#include <Eigen/Core>
#include <optional>

#include "ground/camera_calibration/lens_projection.h"

namespace isotherm {

/// A camera's lens as calibrations have it, and back.
LensParameters ParametersOf(const CameraModel& camera);
CameraModel CameraOf(LensKind kind, const LensParameters& lens, const Eigen::Vector2i& size_px);

/// Pixel at which a lens shows a direction of its camera's optical frame; NaN behind it.
Eigen::Vector2d ProjectRay(LensKind kind, const LensParameters& lens, const Eigen::Vector3d& ray);

/// The direction, with z = 1, that a lens shows at a pixel; nullopt where the lens shows nothing
/// (its polynomial folds back).
std::optional<Eigen::Vector3d> RayThrough(LensKind kind, const LensParameters& lens,
                                          const Eigen::Vector2d& pixel);

/// How a direction's pixel moves with each parameter of the lens (2 x LensParameterCount).
Eigen::Matrix2Xd ProjectionByLens(LensKind kind, const LensParameters& lens,
                                  const Eigen::Vector3d& ray);

/// How it moves when the camera is rotated by a small rotation vector.
Eigen::Matrix<double, 2, 3> ProjectionByRotation(LensKind kind, const LensParameters& lens,
                                                 const Eigen::Vector3d& ray);

/// Returns whether a pixel is in the inner 80 % of the image, in either direction, where
/// requirements on calibrations hold.
bool IsInner(const Eigen::Vector2d& pixel, const Eigen::Vector2i& size_px);

}  // namespace isotherm
