#include <cmath>
#include <nlohmann/json.hpp>

#include "ground/camera_calibration/calibration_report.h"

namespace isotherm {
namespace {

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index y = 0; y < matrix.rows(); ++y) {
    Json row = Json::array();
    for (Eigen::Index x = 0; x < matrix.cols(); ++x) row.push_back(matrix(y, x));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json LensJson(const BundleCamera& camera) {
  Json lens = Json::object();
  for (int i = 0; i < LensParameterCount(camera.kind); ++i)
    lens[std::string(LensParameterName(camera.kind, i))] = camera.lens[static_cast<std::size_t>(i)];
  return lens;
}

Json MapJson(const ProjectionMap& map) {
  Json rows = Json::array();
  for (int y = 0; y < ProjectionMap::kRows; ++y) {
    Json row = Json::array();
    for (int x = 0; x < ProjectionMap::kColumns; ++x)
      row.push_back(map.LengthAt(y * ProjectionMap::kColumns + x));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json CameraJson(const CalibratedCamera& report) {
  Json json;
  json["camera"] = report.name;
  json["width"] = report.size_px.x();
  json["height"] = report.size_px.y();
  json["views"] = report.views;
  json["features"] = report.features;
  json["rms_px"] = report.error.rms_px;
  json["mae_px"] = report.error.mae_px;
  json["lens_model"] = std::string(ToString(report.camera.kind));
  json["lens"] = LensJson(report.camera);
  json["infrared_shift_px"] = {report.infrared_shift_px.x(), report.infrared_shift_px.y()};
  json["covariance"] = MatrixJson(report.covariance);
  json["bootstrap_covariance"] = MatrixJson(report.bootstrap.Covariance());
  json["uncertainty_px"] = report.sigmas.Rms(true);
  json["max_uncertainty_px"] = report.sigmas.Max(false);
  json["uncertainty_map_px"] = MapJson(report.sigmas);
  if (report.cross_validation) {
    json["cross_validation"] = {{"difference_px", report.cross_validation->difference.Rms(true)},
                                {"expected_px", report.cross_validation->expected.Rms(true)},
                                {"ratio", report.cross_validation->Ratio()}};
  }
  json["change_for_0.1_px"] = report.sensitivity;
  for (const CalibratedCamera::Subset& subset : report.subsets) {
    const char* const name =
        subset.features == FeatureSubset::kNearBorders ? "near_borders" : "near_middle";
    json["subsets"][name] = {{"lens", LensJson(subset.camera)},
                             {"covariance", MatrixJson(subset.covariance)},
                             {"rms_px", subset.error.rms_px}};
  }
  json["missing"] = report.missing;
  if (report.opencv) {
    json["opencv"] = {{"lens", LensJson({report.camera.kind, report.opencv->lens, {}})},
                      {"rms_px", report.opencv->rms_px},
                      {"difference_px", report.off_opencv_px}};
  }
  json["hole_m"] = report.hole.diameter_m;
  json["blur_px"] = report.hole.blur_px;
  return json;
}

Json PoseJson(const PoseReport& pose) {
  const Eigen::Vector3d t = pose.T_second_first.translation();
  const Eigen::Quaterniond q(Eigen::Matrix3d(pose.T_second_first.linear()));
  return {{"translation_m", {t.x(), t.y(), t.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"covariance", MatrixJson(pose.covariance)},
          {"views", pose.views},
          {"transfer_uncertainty_px", pose.transfer_sigma_px},
          {"first_to_second_px", pose.first_to_second_px},
          {"second_to_first_px", pose.second_to_first_px}};
}

}  // namespace

Json ReportJson(const CalibrationReport& report) {
  Json json;
  json["date"] = report.date;
  json["software"] = report.software;
  json["source"] = report.source;
  json["target"] = report.target;
  json["cameras"] = Json::array();
  for (const CalibratedCamera& camera : report.cameras)
    json["cameras"].push_back(CameraJson(camera));
  if (report.pose) json["pose"] = PoseJson(*report.pose);
  json["board"] = {{"warp_mm", report.warp_mm},
                   {"depth_mm", report.board_depth_mm},
                   {"placement_rms_mm", report.placement_rms_mm}};
  json["refused"] = Json::array();
  for (const RefusedImage& image : report.refused)
    json["refused"].push_back(
        {{"name", image.name}, {"camera", image.camera}, {"reason", image.reason}});
  return json;
}

}  // namespace isotherm
