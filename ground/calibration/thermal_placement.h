#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"

namespace isotherm {

/// The values that a scan may correct: where the thermal camera sits, how it looks, and when, and
/// what the radiation on other pixels adds to each one.
struct ThermalPlacement {
  CameraModel camera;  ///< As images come, with distortion.
  RigidTransform T_thermal_depth = RigidTransform::Identity();
  double delay_s = 0.0;      ///< To be added to the stamps that the recording has.
  SceneInfluence influence;  ///< Images are compared without it.
};

/// Numbers the corrections of a placement: a rotation vector in thermal coordinates (radians,
/// turned after the placement's own rotation), a shift of the translation (metres), a delay
/// (seconds), a shift of the principal point (pixels) and changes of the fractions of the scene's
/// influence.
enum PlacementParameter : std::uint8_t {
  kRotationX,
  kRotationY,
  kRotationZ,
  kTranslationX,
  kTranslationY,
  kTranslationZ,
  kDelay,
  kPrincipalX,
  kPrincipalY,
  kNearInfluence,
  kTotalInfluence,
};
inline constexpr int kPlacementParameters = 11;
/// Their names in files, in their order.
inline constexpr std::string_view kPlacementParameterNames =
    "rx ry rz tx ty tz delay cx cy near total";

using PlacementVector = Eigen::Matrix<double, kPlacementParameters, 1>;
using PlacementMatrix = Eigen::Matrix<double, kPlacementParameters, kPlacementParameters>;

/// The placement corrected by `correction`.
ThermalPlacement Corrected(const ThermalPlacement& placement, const PlacementVector& correction);

/// The correction that makes `to` of `from`; their cameras differ by the principal point only.
PlacementVector CorrectionBetween(const ThermalPlacement& from, const ThermalPlacement& to);

/// How fast `v` moves as it is turned about each axis: the columns are e_j x v, per radian.
Eigen::Matrix3d DerivativeByRotation(const Eigen::Vector3d& v);

/// The pixel that shows a point, with its derivatives.
struct ProjectionDerivatives {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;  ///< Pixels per metre, thermal coordinates.
};

/// `p_thermal` (metres, thermal coordinates) has z > 0.
ProjectionDerivatives ProjectWithDerivatives(const CameraModel& camera,
                                             const Eigen::Vector3d& p_thermal);

}  // namespace isotherm
