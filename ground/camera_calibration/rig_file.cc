#include "ground/camera_calibration/rig_file.h"

#include <fmt/format.h>

#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/rig/rig_calibration_file.h"
#include "ground/camera_calibration/lens_rays.h"

namespace isotherm {
namespace {

CalibrationRecord CommonRecord(const CalibrationReport& report) {
  CalibrationRecord record;
  record.set_date(report.date);
  record.set_method(report.software);
  record.set_target(report.target);
  return record;
}

CalibrationRecord CameraRecord(const CalibrationReport& report, const CalibratedCamera& camera,
                               const std::string& serial) {
  CalibrationRecord record = CommonRecord(report);
  if (!serial.empty()) record.set_serial(serial);
  record.set_views(camera.views);
  record.set_features(camera.features);
  int refused = 0;
  for (const RefusedImage& image : report.refused) refused += image.camera == camera.name ? 1 : 0;
  record.set_refused(refused);
  record.set_rms_px(camera.error.rms_px);
  record.set_mae_px(camera.error.mae_px);
  record.set_uncertainty_px(camera.sigmas.Rms(true));
  record.set_max_uncertainty_px(camera.sigmas.Max(false));
  if (camera.cross_validation) record.set_cross_validation(camera.cross_validation->Ratio());
  std::string names;
  for (int i = 0; i < LensParameterCount(camera.camera.kind); ++i)
    names += fmt::format("{}{}", i > 0 ? " " : "", LensParameterName(camera.camera.kind, i));
  record.set_parameters(names);
  SetCovariance(camera.covariance, record);
  return record;
}

CameraIntrinsics Intrinsics(const CalibratedCamera& report) {
  CameraModel camera = CameraOf(report.camera.kind, report.camera.lens, report.size_px);
  camera.cx = report.WrittenPrincipalPoint().x();
  camera.cy = report.WrittenPrincipalPoint().y();
  return ToProto(camera);
}

Status CheckSerial(const std::string& in_file, const std::string& measured, std::string_view name) {
  if (in_file.empty() || measured.empty() || in_file == measured) return OkStatus();
  return FailedPrecondition(fmt::format(
      "the images are of the {} camera with serial number {}, the file is of one with {}: write "
      "another file",
      name, measured, in_file));
}

Status SetCamera(const CalibrationReport& report, const CalibratedCamera& camera,
                 const std::string& serial, RigCalibration& rig) {
  const bool thermal = camera.name == "thermal";
  const std::string& in_file = thermal ? rig.thermal_serial() : rig.depth_serial();
  if (Status status = CheckSerial(in_file, serial, camera.name); !status.ok()) return status;
  if (!serial.empty()) {
    if (thermal) {
      rig.set_thermal_serial(serial);
    } else {
      rig.set_depth_serial(serial);
    }
  }
  const CalibrationRecord record = CameraRecord(report, camera, serial);
  if (thermal) {
    *rig.mutable_thermal() = Intrinsics(camera);
    *rig.mutable_thermal_calibration() = record;
  } else {
    *rig.mutable_depth() = Intrinsics(camera);
    *rig.mutable_depth_calibration() = record;
    // It was found with the directions of the old lens.
    if (rig.has_depth_sensor()) rig.mutable_depth_sensor()->clear_bias();
    rig.clear_depth_bias_calibration();
  }
  return OkStatus();
}

void SetPose(const CalibrationReport& report, RigCalibration& rig) {
  *rig.mutable_t_thermal_depth() = ToProto(report.pose->T_second_first);
  CalibrationRecord record = CommonRecord(report);
  record.set_views(report.pose->views);
  record.set_uncertainty_px(report.pose->transfer_sigma_px);
  record.set_parameters("rx ry rz tx ty tz");
  SetCovariance(report.pose->covariance, record);
  *rig.mutable_pose_calibration() = record;
}

}  // namespace

Status UpdateRigFile(const std::filesystem::path& path, const CalibrationReport& report,
                     const std::vector<std::string>& serials) {
  return EditRigFile(path, [&](RigCalibration& rig) {
    for (std::size_t i = 0; i < report.cameras.size(); ++i)
      ISOTHERM_RETURN_IF_ERROR(SetCamera(report, report.cameras[i], serials[i], rig));
    if (report.pose) SetPose(report, rig);
    rig.set_date(report.date);
    rig.set_method(report.software);
    rig.set_reprojection_error_px(report.cameras.back().error.rms_px);
    return OkStatus();
  });
}

}  // namespace isotherm
