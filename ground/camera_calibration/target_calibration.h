#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "ground/camera_calibration/bundle.h"
#include "ground/camera_calibration/feature_measurement.h"
#include "ground/camera_calibration/opencv_calibration.h"
#include "ground/camera_calibration/target.h"
#include "ground/camera_calibration/target_detector.h"

namespace isotherm {

/// One pose of the target before the rig. Units do not matter; NaN has no value.
struct CalibrationView {
  std::string name;
  std::vector<Image<float>> images;  ///< By camera; empty: that camera has none.
  /// Single frames of those that an image is the mean of, by camera; empty: it is no mean.
  std::vector<std::vector<Image<float>>> samples;
};

struct CalibrationInput {
  CalibrationTarget target;
  std::vector<std::string> camera_names;  ///< For messages: "thermal", "depth".
  std::vector<LensKind> lenses;           ///< By camera.
  std::vector<CalibrationView> views;
};

/// A view, or one camera's image of it, that does not count, and why.
struct RefusedImage {
  std::string name;
  std::string camera;
  std::string reason;
};

/// Holds what a calibration with a target found, and what it was found from.
struct TargetCalibration {
  CalibrationTarget target;
  BundleState state;
  std::vector<std::string> view_names;  ///< Only of the views that count.
  std::vector<FeatureObservation> observations;
  /// The centres of the features' images as OpenCV found them, by camera and view; empty: not seen.
  std::vector<std::vector<std::vector<Eigen::Vector2d>>> detections;
  std::vector<HoleAppearance> holes;      ///< By camera.
  std::vector<Eigen::Vector2i> sizes_px;  ///< By camera.
  BundleFit fit;
  ReducedSystem system;
  std::vector<RefusedImage> refused;

  /// Covariance of a camera's lens parameters: what the features' scatter around the solution says.
  Eigen::MatrixXd LensCovariance(int camera) const;
};

/// Steps of a calibration as they are done, 0..1.
using CalibrationProgress = std::function<void(double)>;

/// Calibrates the lenses, the cameras' poses in the rig (the first camera's frame), and the board's
/// shape: starting from OpenCV, where each feature is measured at the shape that the present
/// calibration gives its image, and everything is estimated again, until nothing moves. Messages
/// say what to do: too few views, views that are all parallel, images of different sizes.
Result<TargetCalibration> CalibrateWithTarget(const CalibrationInput& input, ThreadPool& pool,
                                              const CalibrationProgress& progress);

}  // namespace isotherm
