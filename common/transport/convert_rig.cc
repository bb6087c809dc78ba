#include <isotherm_frames.h>

#include <cmath>
#include <limits>
#include <vector>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_pose.h"
#include "common/transport/wire_sequence.h"

namespace isotherm {
namespace {

constexpr double kQuaternionTolerance =
    1e-3;  // Float rounding of a sender is far below; a pose that is none is far above.

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

isotherm_wire_Camera ToWireCamera(const CameraModel& camera) {
  return {.width = static_cast<std::uint32_t>(camera.width),
          .height = static_cast<std::uint32_t>(camera.height),
          .fx = camera.fx,
          .fy = camera.fy,
          .cx = camera.cx,
          .cy = camera.cy,
          .k1 = camera.lens == LensKind::kBrownConrady ? camera.k1 : kNoNumber,
          .k2 = camera.k2,
          .p1 = camera.p1,
          .p2 = camera.p2,
          .k3 = camera.k3};
}

isotherm_wire_WideLens ToWireWideLens(const CameraModel& camera) {
  if (camera.lens == LensKind::kBrownConrady) return {};
  return {.kind = static_cast<std::uint8_t>(camera.lens),
          .k1 = camera.k1,
          .k4 = camera.k4,
          .k5 = camera.k5,
          .k6 = camera.k6};
}

/// CheckRig refuses what is no sound camera.
CameraModel FromWireCamera(const isotherm_wire_Camera& camera,
                           const isotherm_wire_WideLens& wide_lens) {
  CameraModel model;
  model.width = static_cast<int>(camera.width);
  model.height = static_cast<int>(camera.height);
  model.fx = camera.fx;
  model.fy = camera.fy;
  model.cx = camera.cx;
  model.cy = camera.cy;
  model.k1 = camera.k1;
  model.k2 = camera.k2;
  model.p1 = camera.p1;
  model.p2 = camera.p2;
  model.k3 = camera.k3;
  model.lens = static_cast<LensKind>(wide_lens.kind);
  if (model.lens == LensKind::kBrownConrady) return model;
  model.k1 = wide_lens.k1;
  model.k4 = wide_lens.k4;
  model.k5 = wide_lens.k5;
  model.k6 = wide_lens.k6;
  return model;
}

void ToWireMode(const StreamMode& from, isotherm_wire_StreamMode* to) {
  to->width = static_cast<std::uint32_t>(from.width);
  to->height = static_cast<std::uint32_t>(from.height);
  to->rate_hz = from.rate_hz;
  to->encoding = static_cast<std::uint8_t>(from.encoding);
  CopyText(from.serial, to->serial);
  CopyText(from.model, to->model);
}

std::optional<RefusalCause> FromWireMode(const isotherm_wire_StreamMode& from, StreamMode* to) {
  // Each of them as well: beside a side of 0 the other one could be anything.
  if (from.width > kMaxFramePixels || from.height > kMaxFramePixels ||
      std::size_t{from.width} * from.height > kMaxFramePixels) {
    return RefusalCause::kImpossibleSize;
  }
  if (const auto cause = CheckFinite({from.rate_hz})) return cause;
  if (CheckEnum(from.encoding, kLastEncoding)) return RefusalCause::kUnknownEncoding;
  to->width = static_cast<int>(from.width);
  to->height = static_cast<int>(from.height);
  to->rate_hz = from.rate_hz;
  to->encoding = static_cast<Encoding>(from.encoding);
  to->serial = ReadText(from.serial);
  to->model = ReadText(from.model);
  return std::nullopt;
}

void ToWireSensors(const Rig& rig, isotherm_wire_Rig* to) {
  to->depth_sensor = {.near_range_m = rig.depth_sensor.near_range_m,
                      .min_depth_m = rig.depth_sensor.min_depth_m,
                      .max_depth_m = rig.depth_sensor.max_depth_m,
                      .noise_at_1m_m = rig.depth_sensor.noise_at_1m_m};
  const ThermalSensorModel& thermal = rig.thermal_sensor;
  const LensModel lens = thermal.lens.value_or(LensModel());
  to->thermal_sensor = {.time_constant_s = thermal.time_constant_s,
                        .row_readout_s = thermal.row_readout_s,
                        .has_pixel_pitch = thermal.pixel_pitch_m.has_value(),
                        .pixel_pitch_m = thermal.pixel_pitch_m.value_or(0.0),
                        .has_lens = thermal.lens.has_value(),
                        .focal_length_m = lens.focal_length_m,
                        .f_number = lens.f_number,
                        .focus_m = lens.focus_m};
  to->has_sensors = true;
}

/// Makes `out` point to what `values` holds.
void ToWireFloats(const std::vector<float>& values, auto& out) {
  const auto length = static_cast<std::uint32_t>(values.size());
  out = {._maximum = length,
         ._length = length,
         // DDS reads only.
         ._buffer = const_cast<float*>(values.data()),
         ._release = false};
}

std::vector<float> FromWireFloats(const auto& sequence) {
  const auto elements = Elements(sequence);
  return std::vector<float>(elements.begin(), elements.end());
}

/// Points to what `bias` holds.
void ToWireDepthBias(const DepthBias& bias, isotherm_wire_Rig* to) {
  to->depth_bias_columns = static_cast<std::uint8_t>(bias.columns);
  to->depth_bias_rows = static_cast<std::uint8_t>(bias.rows);
  ToWireFloats(bias.distances_m, to->depth_bias_distances_m);
  ToWireFloats(bias.multipliers, to->depth_bias_multipliers);
}

/// Points to what `correction` holds.
void ToWireRadiometricCorrection(const RadiometricCorrection& correction, isotherm_wire_Rig* to) {
  ToWireFloats(correction.readings_celsius, to->radiometric_readings_celsius);
  ToWireFloats(correction.corrections_k, to->radiometric_corrections_k);
  ToWireFloats(correction.sigmas_k, to->radiometric_sigmas_k);
}

void FromWireDepthBias(const isotherm_wire_Rig& from, Rig* rig) {
  // An earlier edge does not send it.
  if (from.depth_bias_columns == 0) return;
  rig->depth_sensor.bias = {.columns = from.depth_bias_columns,
                            .rows = from.depth_bias_rows,
                            .distances_m = FromWireFloats(from.depth_bias_distances_m),
                            .multipliers = FromWireFloats(from.depth_bias_multipliers)};
}

void FromWireSensors(const isotherm_wire_Rig& from, Rig* rig) {
  // In a sample that ends before them these members read as zeros, which would be wrong values
  // rather than the rig's defaults.
  if (!from.has_sensors) return;
  rig->depth_sensor = {.near_range_m = from.depth_sensor.near_range_m,
                       .min_depth_m = from.depth_sensor.min_depth_m,
                       .max_depth_m = from.depth_sensor.max_depth_m,
                       .noise_at_1m_m = from.depth_sensor.noise_at_1m_m,
                       .bias = {}};
  const isotherm_wire_ThermalSensor& thermal = from.thermal_sensor;
  rig->thermal_sensor.time_constant_s = thermal.time_constant_s;
  rig->thermal_sensor.row_readout_s = thermal.row_readout_s;
  if (thermal.has_pixel_pitch) rig->thermal_sensor.pixel_pitch_m = thermal.pixel_pitch_m;
  if (thermal.has_lens)
    rig->thermal_sensor.lens = {thermal.focal_length_m, thermal.f_number, thermal.focus_m};
}

void FromWireScale(const isotherm_wire_Rig& from, Rig* rig) {
  // As with the sensors: an earlier edge does not send it, and centi-kelvin is its default.
  if (from.has_thermal_scale) rig->thermal_scale = {from.thermal_scale, from.thermal_offset};
}

void FromWireSceneInfluence(const isotherm_wire_Rig& from, Rig* rig) {
  if (!from.has_scene_influence) return;
  rig->thermal_sensor.scene_influence = {.near_fraction = from.scene_near_fraction,
                                         .near_sigma_px = from.scene_near_sigma_px,
                                         .total_fraction = from.scene_total_fraction};
}

std::optional<RefusalCause> FromWireCalibration(const isotherm_wire_Rig& from, Rig* rig) {
  constexpr auto kLast = static_cast<std::uint8_t>(kLastLensKind);
  if (from.depth_wide_lens.kind > kLast || from.thermal_wide_lens.kind > kLast)
    return RefusalCause::kOutOfRange;
  if (from.has_depth) rig->depth = FromWireCamera(from.depth, from.depth_wide_lens);
  if (from.has_thermal) rig->thermal = FromWireCamera(from.thermal, from.thermal_wide_lens);
  rig->depth_scale = from.depth_scale;
  if (from.has_t_thermal_depth) {
    rig->T_thermal_depth = FromWirePose(from.t_thermal_depth);
    if (!rig->T_thermal_depth) return RefusalCause::kOutOfRange;
  }
  rig->thermal_delay_s = from.thermal_delay_s;
  if (from.has_reprojection_error) rig->reprojection_error_px = from.reprojection_error_px;
  rig->serial = ReadText(from.serial);
  rig->date = ReadText(from.date);
  rig->method = ReadText(from.method);
  FromWireSensors(from, rig);
  FromWireScale(from, rig);
  FromWireSceneInfluence(from, rig);
  FromWireDepthBias(from, rig);
  rig->thermal_sensor.radiometric_correction = {FromWireFloats(from.radiometric_readings_celsius),
                                                FromWireFloats(from.radiometric_corrections_k),
                                                FromWireFloats(from.radiometric_sigmas_k)};
  if (from.has_housing_drift) {
    rig->thermal_sensor.housing_drift = {from.housing_error_per_kelvin, from.housing_error_sigma};
  }
  return CheckRig(*rig);
}

}  // namespace

isotherm_wire_Pose ToWirePose(const RigidTransform& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {
      .tx = t.x(), .ty = t.y(), .tz = t.z(), .qx = q.x(), .qy = q.y(), .qz = q.z(), .qw = q.w()};
}

std::optional<RigidTransform> FromWirePose(const isotherm_wire_Pose& pose) {
  const Eigen::Vector3d t(pose.tx, pose.ty, pose.tz);
  const Eigen::Quaterniond q(pose.qw, pose.qx, pose.qy, pose.qz);
  // Written so that NaN is refused, too.
  if (!t.allFinite() || !(std::abs(q.norm() - 1.0) < kQuaternionTolerance)) return std::nullopt;
  return MakeTransform(t, q);
}

void ToWire(const RigDescription& from, isotherm_wire_Rig* to) {
  const Rig& rig = from.rig;
  to->session = from.session;
  to->has_depth = rig.depth.has_value();
  if (rig.depth) {
    to->depth = ToWireCamera(*rig.depth);
    to->depth_wide_lens = ToWireWideLens(*rig.depth);
  }
  to->has_thermal = rig.thermal.has_value();
  if (rig.thermal) {
    to->thermal = ToWireCamera(*rig.thermal);
    to->thermal_wide_lens = ToWireWideLens(*rig.thermal);
  }
  to->depth_scale = rig.depth_scale;
  to->has_t_thermal_depth = rig.T_thermal_depth.has_value();
  if (rig.T_thermal_depth) to->t_thermal_depth = ToWirePose(*rig.T_thermal_depth);
  to->thermal_delay_s = rig.thermal_delay_s;
  to->has_reprojection_error = rig.reprojection_error_px.has_value();
  to->reprojection_error_px = rig.reprojection_error_px.value_or(0.0);
  CopyText(rig.serial, to->serial);
  CopyText(rig.date, to->date);
  CopyText(rig.method, to->method);
  ToWireMode(from.depth, &to->depth_mode);
  ToWireMode(from.thermal, &to->thermal_mode);
  to->waits_for_ground = from.waits_for_ground;
  ToWireSensors(rig, to);
  to->thermal_scale = rig.thermal_scale.kelvin_per_count;
  to->thermal_offset = rig.thermal_scale.offset_kelvin;
  to->has_thermal_scale = true;
  to->scene_near_fraction = rig.thermal_sensor.scene_influence.near_fraction;
  to->scene_near_sigma_px = rig.thermal_sensor.scene_influence.near_sigma_px;
  to->scene_total_fraction = rig.thermal_sensor.scene_influence.total_fraction;
  to->has_scene_influence = true;
  ToWireDepthBias(rig.depth_sensor.bias, to);
  ToWireRadiometricCorrection(rig.thermal_sensor.radiometric_correction, to);
  const std::optional<HousingDrift>& drift = rig.thermal_sensor.housing_drift;
  to->has_housing_drift = drift.has_value();
  to->housing_error_per_kelvin = drift ? drift->error_per_kelvin : 0.0;
  to->housing_error_sigma = drift ? drift->sigma : 0.0;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Rig& from, RigDescription* to) {
  to->session = from.session;
  if (const auto cause = FromWireCalibration(from, &to->rig)) return cause;
  if (const auto cause = FromWireMode(from.depth_mode, &to->depth)) return cause;
  to->waits_for_ground = from.waits_for_ground;
  return FromWireMode(from.thermal_mode, &to->thermal);
}

}  // namespace isotherm
