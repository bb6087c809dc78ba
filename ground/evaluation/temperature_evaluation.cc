#include "ground/evaluation/temperature_evaluation.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "common/base/check.h"
#include "common/base/units.h"
#include "common/radiometry/radiometry.h"
#include "ground/thermal/measurement_quality.h"

namespace isotherm {
namespace {

/// Results of before smear was assessed have no motion class: it counts as unchecked.
MeasurementQuality QualityOfPoint(const MeasuredCloud& cloud, std::size_t i) {
  return QualityOf(cloud.distance_class[i], cloud.angle_class[i],
                   cloud.motion_class.empty() ? kNeverMeasured : cloud.motion_class[i]);
}

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

/// The emissivity of point `i` at the angle it was measured at.
double EmissivityOf(const MeasuredCloud& cloud, std::size_t i,
                    const TemperatureEvaluationOptions& options) {
  if (!options.refractive_index || !std::isfinite(cloud.measured_angle_deg[i]))
    return options.emissivity;
  return DirectionalEmissivity(kRadPerDeg * static_cast<double>(cloud.measured_angle_deg[i]),
                               options.emissivity, *options.refractive_index, 0.0);
}

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

Result<TemperatureReport> EvaluateTemperatures(const MeasuredCloud& cloud,
                                               const std::vector<Eigen::Vector3f>& positions,
                                               const TrueSurface& truth,
                                               const TemperatureEvaluationOptions& options) {
  if (Status status = CheckInput(cloud, truth, options); !status.ok())
    return Err(std::move(status));
  CHECK(positions.size() == cloud.celsius.size());
  const BandRadiance band;
  TemperatureReport report;
  std::map<MeasurementQuality, Errors> by_quality;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto foot = truth.Project(positions[i]);
    if (!std::isfinite(cloud.celsius[i]) || !foot) {
      ++report.never_measured;
      continue;
    }
    const double true_celsius = truth.CelsiusAt(positions[i], foot->nearest);
    const double expected = ApparentCelsius(band, true_celsius, EmissivityOf(cloud, i, options),
                                            options.ambient_celsius);
    const double error = cloud.celsius[i] - expected;
    if (!std::isfinite(error)) continue;
    Errors& errors = by_quality[QualityOfPoint(cloud, i)];
    errors.all.push_back(error);
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
  return report;
}

}  // namespace isotherm
