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

struct BoardViews {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
};

/// Holds what OpenCV's calibrations return.
struct Found {
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
};

/// `calibrate` is given BoardViews and Found and returns the error, pixels.
template <typename Function>
Result<OpenCvCalibration> Calibrate(const CalibrationTarget& target,
                                    const std::vector<std::vector<Eigen::Vector2d>>& views,
                                    int coefficients, const Function& calibrate) {
  BoardViews points{{views.size(), BoardPoints(target)}, {}};
  for (const auto& view : views) points.pixels.push_back(ToOpenCv(view));
  Found found;
  OpenCvCalibration result;
  try {
    result.rms_px = calibrate(points, found);
  } catch (const cv::Exception& e) {
    return Err(FailedPrecondition(
        fmt::format("OpenCV finds no camera that explains these views ({})", e.err)));
  }
  const cv::Mat& matrix = found.matrix;
  result.lens = {matrix.at<double>(0, 0), matrix.at<double>(1, 1), matrix.at<double>(0, 2),
                 matrix.at<double>(1, 2)};
  for (int i = 0; i < coefficients; ++i)
    result.lens[static_cast<std::size_t>(4 + i)] = found.distortion.at<double>(i);
  for (std::size_t i = 0; i < views.size(); ++i)
    result.T_camera_board.push_back(ToTransform(found.rotations[i], found.translations[i]));
  return result;
}

Result<OpenCvCalibration> CalibratePolynomial(
    const CalibrationTarget& target, const std::vector<std::vector<Eigen::Vector2d>>& views,
    const Eigen::Vector2i& size_px, int flags, int coefficients) {
  return Calibrate(target, views, coefficients, [&](auto& points, auto& found) {
    return cv::calibrateCamera(points.boards, points.pixels, {size_px.x(), size_px.y()},
                               found.matrix, found.distortion, found.rotations, found.translations,
                               flags);
  });
}

}  // namespace

Result<OpenCvCalibration> CalibrateWithOpenCv(
    const CalibrationTarget& target, const std::vector<std::vector<Eigen::Vector2d>>& views,
    const Eigen::Vector2i& size_px, LensKind kind) {
  if (kind == LensKind::kFisheye)
    return Calibrate(target, views, 4, [&](auto& points, auto& found) {
      // Without the flag the board's rotations depend on the distortion of before.
      return cv::fisheye::calibrate(
          points.boards, points.pixels, {size_px.x(), size_px.y()}, found.matrix, found.distortion,
          found.rotations, found.translations,
          cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
    });
  const bool rational = kind == LensKind::kRational;
  return CalibratePolynomial(target, views, size_px, rational ? cv::CALIB_RATIONAL_MODEL : 0,
                             rational ? 8 : 5);
}

Result<OpenCvCalibration> StartWithOpenCv(const CalibrationTarget& target,
                                          const std::vector<std::vector<Eigen::Vector2d>>& views,
                                          const Eigen::Vector2i& size_px) {
  return CalibratePolynomial(target, views, size_px, cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST,
                             5);
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
