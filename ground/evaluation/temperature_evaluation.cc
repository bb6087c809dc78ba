#include "ground/evaluation/temperature_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "common/base/check.h"
#include "common/radiometry/radiometry.h"
#include "ground/evaluation/expected_temperature.h"

namespace isotherm {
namespace {

struct Errors {
  std::vector<double> all;
  std::vector<double> away_from_edges;

  void Append(const Errors& other) {
    all.insert(all.end(), other.all.begin(), other.all.end());
    away_from_edges.insert(away_from_edges.end(), other.away_from_edges.begin(),
                           other.away_from_edges.end());
  }
};

TemperatureErrors Describe(std::vector<double> errors, double gross_kelvin) {
  TemperatureErrors result;
  double sum = 0.0;
  std::size_t gross = 0;
  for (double& error : errors) {
    sum += error;
    error = std::abs(error);
    if (error > gross_kelvin) ++gross;
  }
  const auto count = static_cast<double>(errors.size());
  result.mean = errors.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / count;
  result.gross_fraction = errors.empty() ? std::numeric_limits<double>::quiet_NaN()
                                         : static_cast<double>(gross) / count;
  result.magnitude = Summarize(std::move(errors));
  return result;
}

ClassErrors Describe(const Errors& errors, double gross_kelvin) {
  return {Describe(errors.all, gross_kelvin), Describe(errors.away_from_edges, gross_kelvin)};
}

/// NaN if the file has no such column.
double ValueOrNan(const std::vector<float>& column, std::size_t i) {
  return column.empty() ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(column[i]);
}

/// Computes the temperatures expected of the cloud's points, by the angle at which each was
/// measured.
class ExpectedOfPoints {
 public:
  ExpectedOfPoints(const MeasuredCloud& cloud, const TemperatureEvaluationOptions& options)
      : cloud_(cloud),
        options_(options),
        surface_{.normal_emissivity = options.emissivity,
                 // Not used without an angle.
                 .refractive_index = options.refractive_index.value_or(1.5),
                 .reflected_celsius = options.ambient_celsius} {}

  ExpectedTemperature Of(std::size_t i, double true_celsius,
                         const Eigen::Vector3f& true_normal) const {
    const bool by_angle = options_.refractive_index && std::isfinite(cloud_.measured_angle_deg[i]);
    const bool has_normal = !cloud_.normals.empty();
    return ExpectTemperature(
        band_, surface_, true_celsius,
        by_angle ? static_cast<double>(cloud_.measured_angle_deg[i]) : NAN,
        has_normal ? AngleSigmaDeg(options_.R_truth_world * cloud_.normals[i], true_normal) : 0.0);
  }

 private:
  const MeasuredCloud& cloud_;
  const TemperatureEvaluationOptions& options_;
  const SmoothSurface surface_;
  const BandRadiance band_{};
};

Status CheckInput(const MeasuredCloud& cloud, const TrueSurface& truth,
                  const TemperatureEvaluationOptions& options) {
  if (!(options.emissivity > 0.0 && options.emissivity <= 1.0)) {
    return InvalidArgument(
        fmt::format("emissivity must be above 0 and at most 1, got {}", options.emissivity));
  }
  if (!(options.ambient_celsius >= kMinRadiometric_celsius &&
        options.ambient_celsius <= kMaxRadiometric_celsius)) {
    return InvalidArgument(fmt::format("ambient temperature must be {}..{} degrees Celsius, got {}",
                                       kMinRadiometric_celsius, kMaxRadiometric_celsius,
                                       options.ambient_celsius));
  }
  if (truth.points().celsius.empty()) {
    return FailedPrecondition("the true surface has no temperatures (scalar_temperature)");
  }
  if (cloud.celsius.empty() || cloud.distance_class.empty() || cloud.angle_class.empty()) {
    return FailedPrecondition(
        "the cloud has no temperatures (scalar_temperature scalar_distance_class "
        "scalar_angle_class)");
  }
  if (options.refractive_index) {
    if (!(*options.refractive_index >= 1.0)) {
      return InvalidArgument(
          fmt::format("refractive index must be at least 1, got {}", *options.refractive_index));
    }
    if (cloud.measured_angle_deg.empty())
      return FailedPrecondition("the cloud has no angles of measurement (scalar_measured_angle)");
  }
  return OkStatus();
}

}  // namespace

MeasurementQuality QualityOfPoint(const MeasuredCloud& cloud, std::size_t i) {
  return QualityOf(cloud.distance_class[i], cloud.angle_class[i],
                   cloud.motion_class.empty() ? kNeverMeasured : cloud.motion_class[i]);
}

Result<TemperatureReport> EvaluateTemperatures(const MeasuredCloud& cloud,
                                               const std::vector<Eigen::Vector3f>& positions,
                                               const TrueSurface& truth,
                                               const TemperatureEvaluationOptions& options) {
  if (Status status = CheckInput(cloud, truth, options); !status.ok())
    return Err(std::move(status));
  CHECK(positions.size() == cloud.celsius.size());
  const ExpectedOfPoints expected_of_points(cloud, options);
  TemperatureReport report;
  std::map<MeasurementQuality, Errors> by_quality;
  std::vector<AssessedError> assessed;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto foot = truth.Project(positions[i]);
    if (!std::isfinite(cloud.celsius[i]) || !foot) {
      ++report.never_measured;
      continue;
    }
    const double true_celsius = truth.CelsiusAt(positions[i], foot->nearest);
    const ExpectedTemperature expected =
        expected_of_points.Of(i, true_celsius, truth.points().normals[foot->nearest]);
    const double error = cloud.celsius[i] - expected.celsius;
    if (!std::isfinite(error)) continue;
    Errors& errors = by_quality[QualityOfPoint(cloud, i)];
    errors.all.push_back(error);
    assessed.push_back({.error_k = error,
                        .sigma_k = ValueOrNan(cloud.sigma_k, i),
                        .expected_sigma_k = expected.sigma_k,
                        .distance_m = ValueOrNan(cloud.measured_distance_m, i),
                        .angle_deg = ValueOrNan(cloud.measured_angle_deg, i)});
    // Edges of the truth: those of the cloud are what is assessed.
    const Eigen::Vector3f& q = truth.points().positions_m[foot->nearest];
    if (truth.CelsiusSpread(q, options.edge_radius_m) <= options.edge_kelvin)
      errors.away_from_edges.push_back(error);
  }
  Errors any;
  for (const auto& [quality, errors] : by_quality) any.Append(errors);
  report.good = Describe(by_quality[MeasurementQuality::kGood], options.gross_kelvin);
  report.acceptable = Describe(by_quality[MeasurementQuality::kAcceptable], options.gross_kelvin);
  report.bad = Describe(by_quality[MeasurementQuality::kBad], options.gross_kelvin);
  report.any = Describe(any, options.gross_kelvin);
  report.uncertainty = EvaluateUncertainty(assessed);
  return report;
}

}  // namespace isotherm
