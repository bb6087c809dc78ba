#include "common/rig/sensor_models.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {
namespace {

Status CheckSceneInfluence(const SceneInfluence& influence) {
  const auto is_fraction = [](double fraction) {
    return fraction >= 0.0 && fraction <= SceneInfluence::kMaxFraction;
  };
  if (!is_fraction(influence.near_fraction) || !is_fraction(influence.total_fraction)) {
    return InvalidArgument(fmt::format(
        "thermal_sensor.scene_influence: near_fraction and total_fraction must be "
        "0..{}, got {} and {}",
        SceneInfluence::kMaxFraction, influence.near_fraction, influence.total_fraction));
  }
  if (!(influence.near_sigma_px >= SceneInfluence::kMinSigma_px &&
        influence.near_sigma_px <= SceneInfluence::kMaxSigma_px)) {
    return InvalidArgument(fmt::format(
        "thermal_sensor.scene_influence.near_sigma_px must be {}..{}, got {}",
        SceneInfluence::kMinSigma_px, SceneInfluence::kMaxSigma_px, influence.near_sigma_px));
  }
  return OkStatus();
}

Status CheckHousingDrift(const std::optional<HousingDrift>& drift) {
  constexpr double kMax = HousingDrift::kMaxErrorPerKelvin;
  if (!drift || (drift->error_per_kelvin >= -kMax && drift->error_per_kelvin <= kMax &&
                 drift->sigma >= 0.0 && drift->sigma <= kMax)) {
    return OkStatus();
  }
  return InvalidArgument(fmt::format(
      "thermal_sensor.housing_drift: error_per_kelvin must be -{0}..{0} and sigma 0..{0}, got {1} "
      "and {2}",
      kMax, drift->error_per_kelvin, drift->sigma));
}

}  // namespace

Status Validate(const DepthSensorModel& sensor) {
  if (!(sensor.near_range_m >= 0.0 && sensor.near_range_m <= 10.0)) {
    return InvalidArgument(
        fmt::format("depth_sensor.near_range_m must be 0..10 m, got {}", sensor.near_range_m));
  }
  if (!(sensor.min_depth_m >= 0.0 && sensor.max_depth_m > sensor.min_depth_m &&
        sensor.max_depth_m <= 100.0)) {
    return InvalidArgument(
        fmt::format("depth_sensor: need 0 <= min_depth_m < max_depth_m <= 100 m, got {} m and {} m",
                    sensor.min_depth_m, sensor.max_depth_m));
  }
  if (!(sensor.noise_at_1m_m > 0.0 && sensor.noise_at_1m_m <= 1.0)) {
    return InvalidArgument(
        fmt::format("depth_sensor.noise_at_1m_m must be above 0 and at most 1 m, got {}",
                    sensor.noise_at_1m_m));
  }
  return Validate(sensor.bias);
}

Status Validate(const ThermalSensorModel& sensor) {
  if (!(sensor.time_constant_s >= 0.0 && sensor.time_constant_s <= 1.0)) {
    return InvalidArgument(fmt::format("thermal_sensor.time_constant_s must be 0..1 s, got {}",
                                       sensor.time_constant_s));
  }
  if (!(sensor.row_readout_s >= 0.0 && sensor.row_readout_s <= 0.01)) {
    return InvalidArgument(fmt::format("thermal_sensor.row_readout_s must be 0..0.01 s, got {}",
                                       sensor.row_readout_s));
  }
  if (sensor.pixel_pitch_m && !(*sensor.pixel_pitch_m > 0.0 && *sensor.pixel_pitch_m <= 1e-3)) {
    return InvalidArgument(
        fmt::format("thermal_sensor.pixel_pitch_um must be above 0 and at most 1000 um, got {}",
                    1e6 * *sensor.pixel_pitch_m));
  }
  ISOTHERM_RETURN_IF_ERROR(CheckSceneInfluence(sensor.scene_influence));
  ISOTHERM_RETURN_IF_ERROR(Validate(sensor.radiometric_correction));
  ISOTHERM_RETURN_IF_ERROR(CheckHousingDrift(sensor.housing_drift));
  if (!sensor.lens) return OkStatus();
  const LensModel& lens = *sensor.lens;
  if (!sensor.pixel_pitch_m || !(lens.focal_length_m > 0.0 && std::isfinite(lens.focal_length_m)) ||
      !(lens.f_number > 0.0 && std::isfinite(lens.f_number)) ||
      !(lens.focus_m > lens.focal_length_m && std::isfinite(lens.focus_m))) {
    return InvalidArgument(
        "thermal_sensor.lens: focal_length_mm and f_number must be positive, focus_m beyond the "
        "focal length, and thermal_sensor.pixel_pitch_um must be given");
  }
  return OkStatus();
}

}  // namespace isotherm
