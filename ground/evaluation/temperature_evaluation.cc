#include "ground/evaluation/temperature_evaluation.h"

#include <fmt/format.h>
#include <numbers>

#include <algorithm>
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

/// NaN if the file has no such column.
double ValueOrNan(const std::vector<float>& column, std::size_t i) {
  return column.empty() ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(column[i]);
}

/// What a camera that takes everything for a black body shows of a point, by the angle at which it
/// was measured.
class ExpectedTemperature {
 public:
  ExpectedTemperature(const MeasuredCloud& cloud, const TemperatureEvaluationOptions& options)
      : cloud_(cloud), options_(options) {}

  double Celsius(std::size_t i, double true_celsius) const {
    return At(HasAngle(i) ? static_cast<double>(cloud_.measured_angle_deg[i]) : NAN, true_celsius);
  }
  /// Its standard uncertainty, kelvin: by the angle, as far as the cloud's normal and the true one
  /// are apart, and by the code of the direction.
  double Sigma(std::size_t i, double true_celsius, const Eigen::Vector3f& true_normal) const {
    if (!HasAngle(i) || cloud_.normals.empty()) return 0.0;
    constexpr double kDirection_deg = 1.0;  // EncodeDirection, and one direction per block.
    const float cosine =
        std::min(1.0F, std::abs(true_normal.dot(options_.R_truth_world * cloud_.normals[i])));
    // Of two directions in which a normal is off, one changes the angle.
    const double normal_deg = static_cast<double>(std::acos(cosine)) / kRadPerDeg;
    const double sigma_deg = std::hypot(normal_deg / std::numbers::sqrt2, kDirection_deg);
    constexpr double kStep_deg = 0.5;
    const auto angle_deg = static_cast<double>(cloud_.measured_angle_deg[i]);
    const double per_degree = (At(angle_deg + kStep_deg, true_celsius) -
                               At(std::max(0.0, angle_deg - kStep_deg), true_celsius)) /
                              (2.0 * kStep_deg);
    return std::abs(per_degree) * sigma_deg;
  }

 private:
  bool HasAngle(std::size_t i) const {
    return options_.refractive_index && std::isfinite(cloud_.measured_angle_deg[i]);
  }
  /// NaN: the emissivity does not depend on the angle.
  double At(double angle_deg, double true_celsius) const {
    const double emissivity =
        std::isnan(angle_deg) ? options_.emissivity
                              : DirectionalEmissivity(kRadPerDeg * angle_deg, options_.emissivity,
                                                      *options_.refractive_index, 0.0);
    return ApparentCelsius(band_, true_celsius, emissivity, options_.ambient_celsius);
  }

  const MeasuredCloud& cloud_;
  const TemperatureEvaluationOptions& options_;
  const BandRadiance band_;
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

Result<TemperatureReport> EvaluateTemperatures(const MeasuredCloud& cloud,
                                               const std::vector<Eigen::Vector3f>& positions,
                                               const TrueSurface& truth,
                                               const TemperatureEvaluationOptions& options) {
  if (Status status = CheckInput(cloud, truth, options); !status.ok())
    return Err(std::move(status));
  CHECK(positions.size() == cloud.celsius.size());
  const ExpectedTemperature expected(cloud, options);
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
    const double error = cloud.celsius[i] - expected.Celsius(i, true_celsius);
    if (!std::isfinite(error)) continue;
    Errors& errors = by_quality[QualityOfPoint(cloud, i)];
    errors.all.push_back(error);
    assessed.push_back(
        {.error_k = error,
         .sigma_k = ValueOrNan(cloud.sigma_k, i),
         .expected_sigma_k = expected.Sigma(i, true_celsius, truth.points().normals[foot->nearest]),
         .distance_m = ValueOrNan(cloud.measured_distance_m, i),
         .angle_deg = ValueOrNan(cloud.measured_angle_deg, i)});
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
