#include "ground/calibration/thermal_placement.h"

#include <Eigen/Geometry>

namespace isotherm {

ThermalPlacement Corrected(const ThermalPlacement& placement, const PlacementVector& correction) {
  ThermalPlacement corrected = placement;
  Eigen::Matrix<double, 6, 1> twist;
  twist << correction.segment<3>(kTranslationX), correction.segment<3>(kRotationX);
  const RigidTransform change = TransformFromTwist(twist);
  corrected.T_thermal_depth.linear() = change.linear() * placement.T_thermal_depth.linear();
  corrected.T_thermal_depth.translation() += change.translation();
  corrected.delay_s += correction[kDelay];
  corrected.camera.cx += correction[kPrincipalX];
  corrected.camera.cy += correction[kPrincipalY];
  corrected.influence.near_fraction += correction[kNearInfluence];
  corrected.influence.total_fraction += correction[kTotalInfluence];
  return corrected;
}

PlacementVector CorrectionBetween(const ThermalPlacement& from, const ThermalPlacement& to) {
  PlacementVector correction;
  const Eigen::AngleAxisd turned(to.T_thermal_depth.linear() *
                                 from.T_thermal_depth.linear().transpose());
  correction.segment<3>(kRotationX) = turned.angle() * turned.axis();
  correction.segment<3>(kTranslationX) =
      to.T_thermal_depth.translation() - from.T_thermal_depth.translation();
  correction[kDelay] = to.delay_s - from.delay_s;
  correction[kPrincipalX] = to.camera.cx - from.camera.cx;
  correction[kPrincipalY] = to.camera.cy - from.camera.cy;
  correction[kNearInfluence] = to.influence.near_fraction - from.influence.near_fraction;
  correction[kTotalInfluence] = to.influence.total_fraction - from.influence.total_fraction;
  return correction;
}

Eigen::Matrix3d DerivativeByRotation(const Eigen::Vector3d& v) {
  Eigen::Matrix3d derivative;
  derivative << 0.0, v.z(), -v.y(), -v.z(), 0.0, v.x(), v.y(), -v.x(), 0.0;
  return derivative;
}

ProjectionDerivatives ProjectWithDerivatives(const CameraModel& camera,
                                             const Eigen::Vector3d& p_thermal) {
  const double inverse_z = 1.0 / p_thermal.z();
  const double x = p_thermal.x() * inverse_z, y = p_thermal.y() * inverse_z;
  Eigen::Matrix<double, 2, 3> normalized;
  normalized << inverse_z, 0.0, -x * inverse_z, 0.0, inverse_z, -y * inverse_z;
  const ProjectedPixel projected = ProjectWithDerivative(camera, {x, y});
  ProjectionDerivatives result;
  result.pixel = projected.pixel;
  result.by_point = projected.by_normalized * normalized;
  return result;
}

}  // namespace isotherm
