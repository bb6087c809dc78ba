#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"
#include "ground/camera_calibration/calibration_report.h"

namespace isotherm {
namespace {

constexpr double kDistance_m = 0.6;  // At which uncertainties are also said in millimetres.
constexpr double kMillimetres = 1e3;

std::string Parameters(const CalibratedCamera& report) {
  std::string text;
  const int count = LensParameterCount(report.camera.kind);
  const Eigen::VectorXd spread = report.bootstrap.Covariance().diagonal().cwiseSqrt();
  for (int i = 0; i < count; ++i) {
    const double value = report.camera.lens[static_cast<std::size_t>(i)];
    text += fmt::format("    {:<3}{:>12.6g} +- {:<10.3g} views resampled: {:.3g}",
                        LensParameterName(report.camera.kind, i), value,
                        std::sqrt(report.covariance(i, i)), spread(i));
    if (!report.sensitivity.empty()) {
      text += fmt::format("; error +0.1 px if off by {:.3g}",
                          report.sensitivity[static_cast<std::size_t>(i)]);
    }
    text += '\n';
  }
  return text;
}

/// How certain the projection is, and whether two halves agree with that.
std::string Certainty(const CalibratedCamera& report) {
  const double to_mm = kMillimetres * kDistance_m / report.camera.lens[0];
  const double rms = report.sigmas.Rms(true), max = report.sigmas.Max(false);
  std::string text = fmt::format(
      "  where it shows a direction is uncertain by {:.3f} px ({:.3f} mm at {:.1f} m) in the inner "
      "80 % of the image, by up to {:.2f} px ({:.2f} mm) in its corners\n",
      rms, rms * to_mm, kDistance_m, max, max * to_mm);
  if (report.cross_validation) {
    const CrossValidation& halves = *report.cross_validation;
    const double ratio = halves.Ratio();
    constexpr double kMaxRatio = 2.0;
    text += fmt::format(
        "  two halves of the views differ by {:.3f} px, {:.3f} px are expected: {}\n",
        halves.difference.Rms(true), halves.expected.Rms(true),
        ratio <= kMaxRatio ? "they agree"
                           : "they do not agree, so the uncertainty is too small: the lens or the "
                             "target is not what the model takes it for");
  }
  return text;
}

std::string Subsets(const CalibratedCamera& report) {
  std::string text;
  for (const CalibratedCamera::Subset& subset : report.subsets) {
    text += fmt::format(
        "  from features near the image's {} only: fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f} k1 "
        "{:.4f} k2 {:.3f}, error {:.3f} px\n",
        subset.features == FeatureSubset::kNearBorders ? "borders" : "middle",
        subset.camera.lens[0], subset.camera.lens[1], subset.camera.lens[2], subset.camera.lens[3],
        subset.camera.lens[4], subset.camera.lens[5], subset.error.rms_px);
  }
  return text;
}

std::string OpenCv(const CalibratedCamera& report) {
  if (!report.opencv) return {};
  const LensParameters& lens = report.opencv->lens;
  return fmt::format(
      "  OpenCV from the same images, the target taken as flat: fx {:.2f} fy {:.2f} cx {:.2f} cy "
      "{:.2f}, error {:.3f} px; it differs by {:.2f} px\n",
      lens[0], lens[1], lens[2], lens[3], report.opencv->rms_px, report.off_opencv_px);
}

std::string CameraText(const CalibratedCamera& report) {
  std::string text = fmt::format(
      "{} camera, {} x {} pixels, {} lens: {} views, {} features, reprojection error {:.3f} px "
      "rms, {:.3f} px mean\n",
      report.name, report.size_px.x(), report.size_px.y(), ToString(report.camera.kind),
      report.views, report.features, report.error.rms_px, report.error.mae_px);
  text += Parameters(report) + Certainty(report) + Subsets(report) + OpenCv(report);
  if (report.infrared_shift_px.any()) {
    const Eigen::Vector2d written = report.WrittenPrincipalPoint();
    text += fmt::format(
        "  of its depth images: cx {:.2f} cy {:.2f}, {:.2f} and {:.2f} px less than of these "
        "infrared ones (--infrared-shift)\n",
        written.x(), written.y(), report.infrared_shift_px.x(), report.infrared_shift_px.y());
  }
  for (const std::string& missing : report.missing) text += fmt::format("  missing: {}\n", missing);
  return text;
}

std::string PoseText(const PoseReport& pose, const std::string& first, const std::string& second) {
  const Eigen::Vector3d t = kMillimetres * pose.T_second_first.translation();
  const Eigen::AngleAxisd rotation(Eigen::Matrix3d(pose.T_second_first.linear()));
  const Eigen::Vector3d r = rotation.angle() * rotation.axis() / kRadPerDeg;
  const auto sigma = [&](int i) { return std::sqrt(pose.covariance(i, i)); };
  return fmt::format(
      "pose of the {} camera to the {} camera ({} views of both):\n"
      "    translation {:.2f} {:.2f} {:.2f} mm +- {:.2f} {:.2f} {:.2f}\n"
      "    rotation vector {:.3f} {:.3f} {:.3f} degrees +- {:.3f} {:.3f} {:.3f}\n"
      "  what the {} camera sees {:.1f} m away lands in the {} image within {:.3f} px\n"
      "  features of one at the target's pose in the other: {:.3f} px ({} to {}), {:.3f} px ({} to "
      "{})\n",
      second, first, pose.views, t.x(), t.y(), t.z(), kMillimetres * sigma(3),
      kMillimetres * sigma(4), kMillimetres * sigma(5), r.x(), r.y(), r.z(), sigma(0) / kRadPerDeg,
      sigma(1) / kRadPerDeg, sigma(2) / kRadPerDeg, first, kDistance_m, second,
      pose.transfer_sigma_px, pose.first_to_second_px, first, second, pose.second_to_first_px,
      second, first);
}

}  // namespace

std::string ReportText(const CalibrationReport& report) {
  std::string text;
  for (const CalibratedCamera& camera : report.cameras) text += CameraText(camera);
  if (report.pose) text += PoseText(*report.pose, report.cameras[0].name, report.cameras[1].name);
  text += fmt::format(
      "target '{}': off a plane by {:.2f} mm from its nearest feature to its farthest, features "
      "placed within {:.3f} mm (rms)\n",
      report.target, report.board_depth_mm, report.placement_rms_mm);
  for (const RefusedImage& image : report.refused)
    text += fmt::format("not used: {} ({}): {}\n", image.name, image.camera, image.reason);
  return text;
}

}  // namespace isotherm
