#pragma once

#include <optional>

#include "common/base/status.h"
#include "ground/evaluation/error_statistics.h"
#include "ground/evaluation/true_surface.h"
#include "ground/evaluation/uncertainty_evaluation.h"
#include "ground/thermal/measurement_quality.h"

namespace isotherm {

/// Says under which conditions a model's apparent temperatures become surface temperatures, and
/// what an edge is.
struct TemperatureEvaluationOptions {
  double emissivity = 1.0;  ///< At normal incidence, (0, 1].
  /// Index of a smooth surface, whose emissivity falls with the angle of each measurement (Fresnel;
  /// thesis B.2). nullopt: it is that along the normal, whatever the angle.
  std::optional<double> refractive_index;
  double ambient_celsius = 23.0;  ///< The surroundings that the surface reflects.
  /// Turns the cloud's normals into the truth's world.
  Eigen::Matrix3f R_truth_world = Eigen::Matrix3f::Identity();
  /// Points are near a temperature edge if true temperatures differ by more than `edge_kelvin`
  /// within this radius.
  float edge_radius_m = 0.005F;
  float edge_kelvin = 5.0F;
  /// An error above this counts as gross.
  double gross_kelvin = 5.0;
};

/// Errors of one class of points: measured minus expected apparent temperature, kelvin.
struct TemperatureErrors {
  ErrorStatistics magnitude;
  double mean = 0.0;            ///< With sign: a bias.
  double gross_fraction = 0.0;  ///< Fraction above TemperatureEvaluationOptions::gross_kelvin.
};

/// Holds the errors of a class of points.
struct ClassErrors {
  TemperatureErrors all;
  TemperatureErrors away_from_edges;
};

/// The three classes have no point in common; `any` is all of them together.
struct TemperatureReport {
  std::size_t never_measured = 0;
  // By MeasurementQuality.
  ClassErrors good;
  ClassErrors acceptable;
  ClassErrors bad;
  ClassErrors any;
  /// Uncertainty of all points together. With a refractive index, the expected temperature is
  /// uncertain as well: the angle of each measurement is that to the cloud's normal.
  UncertaintyReport uncertainty;
};

/// How well a point of the cloud was measured. Results of before smear was assessed have no motion
/// class: it counts as unchecked.
MeasurementQuality QualityOfPoint(const MeasuredCloud& cloud, std::size_t i);

/// Compares temperatures of the cloud with the apparent temperature that the true temperature of
/// the nearest surface implies for a black-body camera (thesis eq. 3.1). `positions`: the cloud's
/// points in the truth's world.
Result<TemperatureReport> EvaluateTemperatures(const MeasuredCloud& cloud,
                                               const std::vector<Eigen::Vector3f>& positions,
                                               const TrueSurface& truth,
                                               const TemperatureEvaluationOptions& options);

}  // namespace isotherm
