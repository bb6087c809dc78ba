#include "common/rig/rig_calibration.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"
#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.pb.h"

namespace isotherm {
namespace {

// Quaternions with fewer digits than a double are fine, anything else is a typing error.
constexpr double kQuaternionNormTolerance = 1e-3;

Status CheckQuaternion(const Transform& t) {
  const double norm =
      std::sqrt(t.qx() * t.qx() + t.qy() * t.qy() + t.qz() * t.qz() + t.qw() * t.qw());
  if (std::abs(norm - 1.0) <= kQuaternionNormTolerance) return OkStatus();
  return InvalidArgument(fmt::format(
      "T_thermal_depth: qx qy qz qw must be a unit quaternion, but its length is {:.6g}", norm));
}

static_assert(static_cast<int>(LensKind::kBrownConrady) == CameraIntrinsics::BROWN_CONRADY &&
              static_cast<int>(LensKind::kRational) == CameraIntrinsics::RATIONAL &&
              static_cast<int>(LensKind::kFisheye) == CameraIntrinsics::FISHEYE);

}  // namespace

CameraModel FromProto(const CameraIntrinsics& intrinsics) {
  CameraModel camera;
  camera.width = intrinsics.width();
  camera.height = intrinsics.height();
  camera.fx = intrinsics.fx();
  camera.fy = intrinsics.fy();
  camera.cx = intrinsics.cx();
  camera.cy = intrinsics.cy();
  camera.k1 = intrinsics.k1();
  camera.k2 = intrinsics.k2();
  camera.p1 = intrinsics.p1();
  camera.p2 = intrinsics.p2();
  camera.k3 = intrinsics.k3();
  camera.k4 = intrinsics.k4();
  camera.k5 = intrinsics.k5();
  camera.k6 = intrinsics.k6();
  camera.lens = static_cast<LensKind>(intrinsics.lens());
  return camera;
}

CameraIntrinsics ToProto(const CameraModel& camera) {
  CameraIntrinsics intrinsics;
  intrinsics.set_width(camera.width);
  intrinsics.set_height(camera.height);
  intrinsics.set_fx(camera.fx);
  intrinsics.set_fy(camera.fy);
  intrinsics.set_cx(camera.cx);
  intrinsics.set_cy(camera.cy);
  // Zeros are left out, so that a file of an ideal camera says no more than was known.
  if (!camera.HasDistortion()) return intrinsics;
  intrinsics.set_k1(camera.k1);
  intrinsics.set_k2(camera.k2);
  intrinsics.set_k3(camera.k3);
  if (camera.lens != LensKind::kFisheye) {
    intrinsics.set_p1(camera.p1);
    intrinsics.set_p2(camera.p2);
  }
  if (camera.lens == LensKind::kBrownConrady) return intrinsics;
  intrinsics.set_lens(static_cast<CameraIntrinsics::Lens>(camera.lens));
  intrinsics.set_k4(camera.k4);
  if (camera.lens == LensKind::kRational) {
    intrinsics.set_k5(camera.k5);
    intrinsics.set_k6(camera.k6);
  }
  return intrinsics;
}

RigidTransform FromProto(const Transform& t) {
  return MakeTransform({t.tx(), t.ty(), t.tz()},
                       Eigen::Quaterniond(t.qw(), t.qx(), t.qy(), t.qz()));
}

Transform ToProto(const RigidTransform& transform) {
  const Eigen::Quaterniond q(Eigen::Matrix3d(transform.linear()));
  Transform t;
  t.set_tx(transform.translation().x());
  t.set_ty(transform.translation().y());
  t.set_tz(transform.translation().z());
  t.set_qx(q.x());
  t.set_qy(q.y());
  t.set_qz(q.z());
  t.set_qw(q.w());
  return t;
}

DepthBias FromProto(const DepthBiasProperties& bias) {
  return {.columns = bias.columns(),
          .rows = bias.rows(),
          .distances_m = {bias.distance_m().begin(), bias.distance_m().end()},
          .multipliers = {bias.multiplier().begin(), bias.multiplier().end()}};
}

DepthSensorModel FromProto(const DepthSensorProperties& sensor) {
  return {.near_range_m = sensor.near_range_m(),
          .min_depth_m = sensor.min_depth_m(),
          .max_depth_m = sensor.max_depth_m(),
          .noise_at_1m_m = sensor.noise_at_1m_m(),
          .bias = FromProto(sensor.bias())};
}

DepthBiasProperties ToProto(const DepthBias& bias) {
  DepthBiasProperties properties;
  properties.set_columns(bias.columns);
  properties.set_rows(bias.rows);
  properties.mutable_distance_m()->Assign(bias.distances_m.begin(), bias.distances_m.end());
  properties.mutable_multiplier()->Assign(bias.multipliers.begin(), bias.multipliers.end());
  return properties;
}

DepthSensorProperties ToProto(const DepthSensorModel& sensor) {
  DepthSensorProperties properties;
  properties.set_near_range_m(sensor.near_range_m);
  properties.set_min_depth_m(sensor.min_depth_m);
  properties.set_max_depth_m(sensor.max_depth_m);
  properties.set_noise_at_1m_m(sensor.noise_at_1m_m);
  if (!sensor.bias.empty()) *properties.mutable_bias() = ToProto(sensor.bias);
  return properties;
}

RadiometricCorrection FromProto(const RadiometricCorrectionProperties& correction) {
  return {{correction.reading_celsius().begin(), correction.reading_celsius().end()},
          {correction.correction_k().begin(), correction.correction_k().end()},
          {correction.sigma_k().begin(), correction.sigma_k().end()}};
}

RadiometricCorrectionProperties ToProto(const RadiometricCorrection& correction) {
  RadiometricCorrectionProperties properties;
  const auto assign = [](const std::vector<float>& values, auto* field) {
    field->Assign(values.begin(), values.end());
  };
  assign(correction.readings_celsius, properties.mutable_reading_celsius());
  assign(correction.corrections_k, properties.mutable_correction_k());
  assign(correction.sigmas_k, properties.mutable_sigma_k());
  return properties;
}

ThermalSensorModel FromProto(const ThermalSensorProperties& sensor) {
  ThermalSensorModel model{.time_constant_s = sensor.time_constant_s(),
                           .row_readout_s = sensor.row_readout_s(),
                           .pixel_pitch_m = {},
                           .lens = {},
                           .scene_influence = {sensor.scene_influence().near_fraction(),
                                               sensor.scene_influence().near_sigma_px(),
                                               sensor.scene_influence().total_fraction()},
                           .radiometric_correction = FromProto(sensor.radiometric_correction())};
  if (sensor.has_housing_drift()) {
    const HousingDriftProperties& drift = sensor.housing_drift();
    model.housing_drift = {drift.error_per_kelvin(), drift.sigma()};
  }
  if (sensor.has_pixel_pitch_um()) model.pixel_pitch_m = sensor.pixel_pitch_um() * kMPerUm;
  if (sensor.has_lens()) {
    const ThermalLens& lens = sensor.lens();
    model.lens = {lens.focal_length_mm() * kMPerMm, lens.f_number(), lens.focus_m()};
  }
  return model;
}

ThermalSensorProperties ToProto(const ThermalSensorModel& sensor) {
  ThermalSensorProperties properties;
  properties.set_time_constant_s(sensor.time_constant_s);
  properties.set_row_readout_s(sensor.row_readout_s);
  if (sensor.pixel_pitch_m) properties.set_pixel_pitch_um(*sensor.pixel_pitch_m / kMPerUm);
  if (sensor.lens) {
    ThermalLens& lens = *properties.mutable_lens();
    lens.set_focal_length_mm(sensor.lens->focal_length_m / kMPerMm);
    lens.set_f_number(sensor.lens->f_number);
    lens.set_focus_m(sensor.lens->focus_m);
  }
  if (sensor.scene_influence.Total() > 0.0) {
    SceneInfluenceProperties& influence = *properties.mutable_scene_influence();
    influence.set_near_fraction(sensor.scene_influence.near_fraction);
    influence.set_near_sigma_px(sensor.scene_influence.near_sigma_px);
    influence.set_total_fraction(sensor.scene_influence.total_fraction);
  }
  if (!sensor.radiometric_correction.empty())
    *properties.mutable_radiometric_correction() = ToProto(sensor.radiometric_correction);
  if (sensor.housing_drift) {
    HousingDriftProperties& drift = *properties.mutable_housing_drift();
    drift.set_error_per_kelvin(sensor.housing_drift->error_per_kelvin);
    drift.set_sigma(sensor.housing_drift->sigma);
  }
  return properties;
}

Rig FromProto(const RigCalibration& calibration) {
  Rig rig;
  if (calibration.has_depth()) rig.depth = FromProto(calibration.depth());
  if (calibration.has_thermal()) rig.thermal = FromProto(calibration.thermal());
  rig.depth_scale = calibration.depth_scale();
  rig.thermal_scale = {calibration.thermal_scale(), calibration.thermal_offset()};
  if (calibration.has_t_thermal_depth())
    rig.T_thermal_depth = FromProto(calibration.t_thermal_depth());
  rig.thermal_delay_s = calibration.thermal_delay_s();
  rig.serial = calibration.serial();
  rig.date = calibration.date();
  rig.method = calibration.method();
  rig.depth_serial = calibration.depth_serial();
  rig.thermal_serial = calibration.thermal_serial();
  if (calibration.has_reprojection_error_px()) {
    rig.reprojection_error_px = calibration.reprojection_error_px();
  }
  rig.depth_sensor = FromProto(calibration.depth_sensor());
  rig.thermal_sensor = FromProto(calibration.thermal_sensor());
  return rig;
}

RigCalibration ToProto(const Rig& rig) {
  RigCalibration calibration;
  if (rig.depth) *calibration.mutable_depth() = ToProto(*rig.depth);
  if (rig.thermal) *calibration.mutable_thermal() = ToProto(*rig.thermal);
  calibration.set_depth_scale(rig.depth_scale);
  calibration.set_thermal_scale(rig.thermal_scale.kelvin_per_count);
  calibration.set_thermal_offset(rig.thermal_scale.offset_kelvin);
  if (rig.T_thermal_depth) *calibration.mutable_t_thermal_depth() = ToProto(*rig.T_thermal_depth);
  calibration.set_thermal_delay_s(rig.thermal_delay_s);
  if (!rig.serial.empty()) calibration.set_serial(rig.serial);
  if (!rig.date.empty()) calibration.set_date(rig.date);
  if (!rig.method.empty()) calibration.set_method(rig.method);
  if (!rig.depth_serial.empty()) calibration.set_depth_serial(rig.depth_serial);
  if (!rig.thermal_serial.empty()) calibration.set_thermal_serial(rig.thermal_serial);
  if (rig.reprojection_error_px) calibration.set_reprojection_error_px(*rig.reprojection_error_px);
  *calibration.mutable_depth_sensor() = ToProto(rig.depth_sensor);
  *calibration.mutable_thermal_sensor() = ToProto(rig.thermal_sensor);
  return calibration;
}

namespace {

Result<Rig> CheckedRig(const RigCalibration& calibration, std::string_view source_name) {
  if (calibration.has_t_thermal_depth()) {
    if (Status status = CheckQuaternion(calibration.t_thermal_depth()); !status.ok()) {
      return Err(status.WithContext(source_name));
    }
  }
  Rig rig = FromProto(calibration);
  if (Status status = Validate(rig); !status.ok()) return Err(status.WithContext(source_name));
  return rig;
}

/// A calibration is data, not an argument: every program that is given a wrong one says so with the
/// same exit status.
Status AsData(const Status& status) {
  return status.code() == StatusCode::kInvalidArgument ? DataLoss(status.message()) : status;
}

}  // namespace

Result<Rig> LoadRigCalibration(const std::filesystem::path& path) {
  RigCalibration calibration;
  if (Status status = LoadTextProto(path, calibration); !status.ok()) return Err(AsData(status));
  Result<Rig> rig = CheckedRig(calibration, path.string());
  if (!rig) return Err(AsData(rig.error()));
  return rig;
}

Result<Rig> ParseRigCalibration(const std::string& text, std::string_view source_name) {
  RigCalibration calibration;
  if (Status status = ParseTextProto(text, source_name, calibration); !status.ok()) {
    return Err(std::move(status));
  }
  return CheckedRig(calibration, source_name);
}

std::string ToText(const Rig& rig) { return ToTextProto(ToProto(rig)); }

}  // namespace isotherm
