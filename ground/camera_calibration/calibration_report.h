#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/opencv_calibration.h"
#include "ground/camera_calibration/projection_map.h"
#include "ground/camera_calibration/resampling.h"
#include "ground/camera_calibration/sensitivity.h"
#include "ground/camera_calibration/target_calibration.h"
#include "ground/json/json.h"

namespace isotherm {

/// Holds what is said of one camera's calibration.
struct CalibratedCamera {
  std::string name;
  BundleCamera camera;
  Eigen::Vector2i size_px = Eigen::Vector2i::Zero();
  /// By how much the principal point of a depth camera's infrared images, which these are, exceeds
  /// that of its depth images, which the rig file holds.
  Eigen::Vector2d infrared_shift_px = Eigen::Vector2d::Zero();
  /// The principal point that the rig file gets.
  Eigen::Vector2d WrittenPrincipalPoint() const {
    return Eigen::Vector2d(camera.lens[2], camera.lens[3]) - infrared_shift_px;
  }
  int views = 0, features = 0;
  ReprojectionError error;
  Eigen::MatrixXd covariance;  ///< The lens's parameters; it is reported and written.
  LensSamples bootstrap;
  ProjectionMap sigmas;
  std::optional<CrossValidation> cross_validation;
  std::vector<double> sensitivity;  ///< Table 5.2, in the parameters' units.
  struct Subset {
    FeatureSubset features;
    BundleCamera camera;
    Eigen::MatrixXd covariance;
    ReprojectionError error;
  };
  std::vector<Subset> subsets;  ///< Table 5.3.
  std::vector<std::string> missing;
  std::optional<OpenCvCalibration> opencv;  ///< From the same images.
  double off_opencv_px = 0.0;               ///< From OpenCV's to this calibration, inner 80 %, rms.
  std::vector<Eigen::Vector2d> features_px, residuals_px;
  HoleAppearance hole;
};

/// The pose of the second camera relative to the first.
struct PoseReport {
  RigidTransform T_second_first = RigidTransform::Identity();
  /// It is that of a small rotation vector (radians, second camera's axes) and the translation
  /// (metres).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int views = 0;  ///< In which both cameras saw the target.
  /// How uncertain it is where a point that the first camera sees 0.6 m away lands in the second
  /// camera's image: all of both lenses and the pose together, over the inner 80 %, rms, pixels.
  double transfer_sigma_px = 0.0;
  /// Features of one camera at the pose that the other camera sees the target in (thesis 5.2.4).
  double first_to_second_px = 0.0, second_to_first_px = 0.0;
};

/// Everything that a calibration with a target reports.
struct CalibrationReport {
  std::string date, software, source;
  std::string target;
  std::vector<CalibratedCamera> cameras;
  std::optional<PoseReport> pose;
  std::vector<double> warp_mm;  ///< BoardShape::warp_m.
  double board_depth_mm = 0.0;  ///< From the board's nearest feature to the farthest, off a plane.
  double placement_rms_mm = 0.0;
  std::vector<RefusedImage> refused;
  int seconds = 0;
};

struct ReportOptions {
  int bootstrap_samples = 2000;
  std::uint64_t seed = 1;
};

/// Computes what is reported. Parts that cannot be computed (too few views for two halves) are left
/// out.
CalibrationReport MakeReport(const TargetCalibration& calibration,
                             const std::vector<std::string>& camera_names,
                             const ReportOptions& options);

/// Plain text for a terminal.
std::string ReportText(const CalibrationReport& report);
Json ReportJson(const CalibrationReport& report);
/// A page that needs nothing else: tables, and plots as SVG.
std::string ReportHtml(const CalibrationReport& report);

}  // namespace isotherm
