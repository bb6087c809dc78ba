#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/starting_values.h"
#include "ground/camera_calibration/target_calibration.h"
#include "ground/camera_calibration/view_coverage.h"

namespace isotherm {

/// Says how far a calibration that is being taken has come, for one camera.
struct CoachStatus {
  std::string camera;
  int views = 0;    ///< In which the target was found.
  int refused = 0;  ///< In which it was not.
  std::string last_refusal;
  /// Features per zone of the image, ViewCoverage::kZoneColumns x kZoneRows, row by row.
  std::vector<int> zones;
  /// Phrases as in ViewCoverage::Missing.
  std::vector<std::string> missing;
  /// How uncertain the projection would be if the calibration ended now: root mean square over the
  /// inner 80 % of the image, and the largest. Absent: not enough views.
  std::optional<double> uncertainty_px, max_uncertainty_px;

  /// One line for a terminal: "thermal: 12 views, 0.08 px (corners 1.2); next: no views with ...".
  std::string Line() const;
};

/// Tells while views are taken which are missing, and what they have brought so far. Uses what is
/// quick: centres of images as OpenCV finds them, which tell nearly as much about what is uncertain
/// as the final measurement. Thread-compatible.
class CalibrationCoach {
 public:
  /// `lenses` by camera.
  CalibrationCoach(const CalibrationTarget& target, std::vector<std::string> camera_names,
                   const std::vector<LensKind>& lenses);

  /// One camera's image of a pose.
  void Add(int camera, const Image<float>& image);

  /// By camera.
  const std::vector<CoachStatus>& status() const { return status_; }

 private:
  struct Camera {
    LensKind lens = LensKind::kBrownConrady;
    Eigen::Vector2i size_px = Eigen::Vector2i::Zero();
    std::vector<std::vector<Eigen::Vector2d>> views;
  };
  void Update(int camera);

  const CalibrationTarget target_;
  std::vector<Camera> cameras_;
  std::vector<CoachStatus> status_;
};

}  // namespace isotherm
