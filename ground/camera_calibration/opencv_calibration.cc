#include "ground/camera_calibration/opencv_calibration.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

namespace isotherm {
namespace {

std::vector<cv::Point3f> BoardPoints(const CalibrationTarget& target) {
  std::vector<cv::Point3f> board;
  for (int i = 0; i < target.features(); ++i) {
    const Eigen::Vector2d xy = target.FeaturePosition(i);
    board.emplace_back(static_cast<float>(xy.x()), static_cast<float>(xy.y()), 0.0F);
  }
  return board;
}

std::vector<cv::Point2f> ToOpenCv(const std::vector<Eigen::Vector2d>& features) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& p : features)
    points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  return points;
}

RigidTransform ToTransform(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const Eigen::Vector3d vector(rotation_vector.at<double>(0), rotation_vector.at<double>(1),
                               rotation_vector.at<double>(2));
  const double angle = vector.norm();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  if (angle > 0.0) rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
  return MakeTransform(
      {translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)}, rotation);
}

}  // namespace

Result<OpenCvCalibration> CalibrateWithOpenCv(
    const CalibrationTarget& target, const std::vector<std::vector<Eigen::Vector2d>>& views,
    int width, int height, bool full) {
  const std::vector<std::vector<cv::Point3f>> boards(views.size(), BoardPoints(target));
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const auto& view : views) pixels.push_back(ToOpenCv(view));
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
  for (std::size_t i = 0; i < views.size(); ++i)
    result.T_camera_board.push_back(ToTransform(rotations[i], translations[i]));
  return result;
}

RigidTransform FindPose(const CalibrationTarget& target,
                        const std::vector<Eigen::Vector2d>& features, const LensParameters& lens) {
  const cv::Mat matrix =
      (cv::Mat_<double>(3, 3) << lens[0], 0.0, lens[2], 0.0, lens[1], lens[3], 0.0, 0.0, 1.0);
  const std::vector<double> distortion = {lens[4], lens[5], lens[6], lens[7], lens[8]};
  cv::Mat rotation, translation;
  cv::solvePnP(BoardPoints(target), ToOpenCv(features), matrix, distortion, rotation, translation);
  return ToTransform(rotation, translation);
}

}  // namespace isotherm
