#include "ground/camera_calibration/opencv_calibration.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

namespace isotherm {

Result<OpenCvCalibration> CalibrateWithOpenCv(
    const CalibrationTarget& target, const std::vector<std::vector<Eigen::Vector2d>>& views,
    int width, int height, bool full) {
  std::vector<cv::Point3f> board;
  for (int i = 0; i < target.features(); ++i) {
    const Eigen::Vector2d xy = target.FeaturePosition(i);
    board.emplace_back(static_cast<float>(xy.x()), static_cast<float>(xy.y()), 0.0F);
  }
  const std::vector<std::vector<cv::Point3f>> boards(views.size(), board);
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const auto& view : views) {
    pixels.emplace_back();
    for (const Eigen::Vector2d& p : view)
      pixels.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
  const int flags = full ? 0 : cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  OpenCvCalibration result;
  try {
    result.rms_px = cv::calibrateCamera(boards, pixels, {width, height}, matrix, distortion,
                                        rotations, translations, flags);
  } catch (const cv::Exception& e) {
    return Err(FailedPrecondition(
        fmt::format("OpenCV finds no camera that explains these views ({})", e.err)));
  }
  result.lens = {matrix.at<double>(0, 0), matrix.at<double>(1, 1), matrix.at<double>(0, 2),
                 matrix.at<double>(1, 2)};
  for (int i = 0; i < 5; ++i)
    result.lens[static_cast<std::size_t>(4 + i)] = distortion.at<double>(i);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Vector3d vector(rotations[i].at<double>(0), rotations[i].at<double>(1),
                                 rotations[i].at<double>(2));
    const double angle = vector.norm();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    if (angle > 0.0) rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
    result.T_camera_board.push_back(
        MakeTransform({translations[i].at<double>(0), translations[i].at<double>(1),
                       translations[i].at<double>(2)},
                      rotation));
  }
  return result;
}

}  // namespace isotherm
