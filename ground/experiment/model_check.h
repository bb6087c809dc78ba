#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/scene.h"
#include "common/simulation/simulated_scan.h"
#include "ground/evaluation/expected_temperature.h"
#include "ground/mesh/surface.h"
#include "ground/renderer/renderer.h"
#include "ground/renderer/view_maps.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// A point of the model beside the truth.
struct CheckedPoint {
  CloudPoint point;
  SurfacePoint truth;       ///< Where the true surface is met along the point's normal.
  double expected_celsius;  ///< Apparent, at right angles, of the true temperature.
  /// The same at the angle at which it was measured, which is what its uncertainty is about.
  ExpectedTemperature expected_at_angle;

  bool measured() const { return point.celsius == point.celsius; }
  /// Returns how far a measured point is off: measured minus expected.
  double ErrorKelvin() const { return static_cast<double>(point.celsius) - expected_celsius; }
  /// Returns how far it is from what is expected at its angle, over the standard uncertainty of
  /// both; NaN without one.
  double NormalizedError() const {
    return (static_cast<double>(point.celsius) - expected_at_angle.celsius) /
           std::hypot(static_cast<double>(point.sigma_k), expected_at_angle.sigma_k);
  }
};

/// The points of the model's surface (algorithm 10), but for stray ones more than 6 mm away from
/// any true surface.
std::vector<CheckedPoint> CheckModel(const Scene& scene, const BandRadiance& band,
                                     const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                     ThreadPool& pool);

/// NaN of nothing.
double Percent(std::size_t part, std::size_t whole);
/// Fraction of the points that have a temperature, percent.
double MeasuredPercent(const std::vector<CheckedPoint>& points);

/// Points that have a temperature, and those that have that of something else.
struct AssignmentCheck {
  std::size_t points = 0;
  std::size_t assigned = 0;
  std::size_t too_warm = 0;  ///< How many of those are too warm by more than kWrong_k.
  std::size_t too_cold = 0;

  /// Far above noise and blur, below the difference between the surfaces that the scenes confuse.
  static constexpr double kWrong_k = 5.0;
  std::size_t wrong() const { return too_warm + too_cold; }
  double WrongPercent() const;
};
AssignmentCheck CheckAssignment(const std::vector<CheckedPoint>& points);

/// Tells how far the temperatures of points that have one are off: figures of the absolute errors,
/// in kelvin; NaN if no point has one.
struct ErrorSummary {
  std::size_t measured = 0;
  double within_1k_percent = std::numeric_limits<double>::quiet_NaN();
  double median_k = std::numeric_limits<double>::quiet_NaN();
  double p95_k = std::numeric_limits<double>::quiet_NaN();
  double p999_k = std::numeric_limits<double>::quiet_NaN();
  double largest_k = std::numeric_limits<double>::quiet_NaN();
  /// How many errors against what is expected at the angle of measurement lie within the standard
  /// uncertainties, and within 1.96 of them: 68.3 and 95 % if these are right. Of the points that
  /// have one.
  double within_sigma_percent = std::numeric_limits<double>::quiet_NaN();
  double within_1_96_sigma_percent = std::numeric_limits<double>::quiet_NaN();
};
ErrorSummary SummarizeErrors(const std::vector<CheckedPoint>& points);

/// Returns what the model shows from `T_map_camera`.
ViewMaps LookAtModel(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                     const CameraModel& camera, const RigidTransform& T_map_camera,
                     ThreadPool& pool);

/// Returns what the model shows the scan's depth camera from where it truly was at `time`.
ViewMaps LookAtModel(const ScanModel& model, const SimulatedScan& scan, CaptureTime time,
                     ThreadPool& pool);

/// Options for renderings with the same colours whatever they show.
RendererOptions FixedScale(double low_celsius, double high_celsius);

}  // namespace isotherm
