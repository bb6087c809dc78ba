#include "common/rig/rig.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {

Status Validate(const Rig& rig) {
  if (rig.depth) ISOTHERM_RETURN_IF_ERROR(Validate(*rig.depth, "depth"));
  if (rig.thermal) ISOTHERM_RETURN_IF_ERROR(Validate(*rig.thermal, "thermal"));
  if (!rig.depth && !rig.thermal) {
    return InvalidArgument("neither depth nor thermal intrinsics are given");
  }
  if (!(std::isfinite(rig.depth_scale) && rig.depth_scale > 0.0)) {
    return InvalidArgument(
        fmt::format("depth_scale (raw units per metre) must be positive, got {}", rig.depth_scale));
  }
  ISOTHERM_RETURN_IF_ERROR(Validate(rig.thermal_scale));
  if (rig.T_thermal_depth && !IsRigid(*rig.T_thermal_depth)) {
    return InvalidArgument("T_thermal_depth is not a finite rigid transform");
  }
  if (!std::isfinite(rig.thermal_delay_s) || std::abs(rig.thermal_delay_s) > 10.0) {
    return InvalidArgument(
        fmt::format("thermal_delay_s must be within +-10 s, got {} s", rig.thermal_delay_s));
  }
  if (rig.reprojection_error_px &&
      !(std::isfinite(*rig.reprojection_error_px) && *rig.reprojection_error_px >= 0.0)) {
    return InvalidArgument(fmt::format("reprojection_error_px must be 0 or more, got {} px",
                                       *rig.reprojection_error_px));
  }
  ISOTHERM_RETURN_IF_ERROR(Validate(rig.depth_sensor));
  return Validate(rig.thermal_sensor);
}

Status CheckThermalFusion(const Rig& rig) {
  if (!rig.thermal) {
    return FailedPrecondition(
        "the rig calibration has no thermal intrinsics: temperatures are not fused");
  }
  if (!rig.depth) {
    return FailedPrecondition(
        "the rig calibration has no depth intrinsics: temperatures are not fused");
  }
  if (!rig.T_thermal_depth) {
    return FailedPrecondition(
        "the rig calibration has no T_thermal_depth: temperatures are not fused");
  }
  return OkStatus();
}

}  // namespace isotherm
