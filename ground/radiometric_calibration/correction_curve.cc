#include "ground/radiometric_calibration/correction_curve.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace isotherm {
namespace {

constexpr int kMaxDegree = 2;
/// Nodes of the table that is made of the polynomial: linear interpolation between so many is off
/// by less than 1 % of what a parabola bends.
constexpr int kNodes = 9;
/// A higher degree has to leave this much less of what was held out.
constexpr double kBetterBy = 0.8;
/// Set points are not taken for more certain: so much a reading itself may be off by, kelvin.
constexpr double kMinSigma_k = 0.1;
/// Set points whose readings are nearer are one, kelvin.
constexpr double kApart_k = 1.0;

/// Readings are scaled to about -1..1, which keeps equations well-conditioned.
struct Scale {
  double middle = 0.0, half = 1.0;

  Eigen::VectorXd Powers(double reading, int degree) const {
    Eigen::VectorXd powers(degree + 1);
    powers(0) = 1.0;
    for (int i = 1; i <= degree; ++i) powers(i) = powers(i - 1) * (reading - middle) / half;
    return powers;
  }
};

struct Polynomial {
  Scale scale;
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;  ///< By the points' own uncertainties and how they stray.
  double stray_k = 0.0;        ///< Standard deviation about it; 0 = too few points to tell.

  int degree() const { return static_cast<int>(coefficients.size()) - 1; }
  double At(double reading) const { return coefficients.dot(scale.Powers(reading, degree())); }
  double SigmaAt(double reading) const {
    const Eigen::VectorXd powers = scale.Powers(reading, degree());
    return std::sqrt(std::max(0.0, powers.dot(covariance * powers)));
  }
};

double Wrong(const SetPoint& point) { return point.apparent_celsius - point.reading_celsius; }

Scale ScaleOf(const std::vector<SetPoint>& points) {
  const auto [low, high] =
      std::ranges::minmax(points, {}, [](const SetPoint& p) { return p.reading_celsius; });
  return {0.5 * (low.reading_celsius + high.reading_celsius),
          std::max(0.5 * (high.reading_celsius - low.reading_celsius), kApart_k)};
}

/// How many readings are apart: a polynomial needs one more than its degree.
int DistinctReadings(const std::vector<SetPoint>& points) {
  std::vector<double> readings;
  for (const SetPoint& point : points) readings.push_back(point.reading_celsius);
  std::ranges::sort(readings);
  int distinct = 0;
  double last = -std::numeric_limits<double>::infinity();
  for (const double reading : readings) {
    if (reading - last < kApart_k) continue;
    ++distinct;
    last = reading;
  }
  return distinct;
}

Polynomial Fit(const std::vector<SetPoint>& points, const Scale& scale, int degree) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(rows, degree + 1);
  Eigen::VectorXd wrong(rows), weights(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const SetPoint& point = points[static_cast<std::size_t>(i)];
    powers.row(i) = scale.Powers(point.reading_celsius, degree).transpose();
    wrong(i) = Wrong(point);
    weights(i) = 1.0 / std::max(point.own_sigma_k, kMinSigma_k);
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * powers;
  Polynomial fit{scale, weighted.colPivHouseholderQr().solve(weights.cwiseProduct(wrong)), {}, 0.0};
  const Eigen::VectorXd left = wrong - powers * fit.coefficients;
  const Eigen::Index freedom = rows - (degree + 1);
  // What set points stray by may be more than they say, or less by chance.
  double excess = 1.0;
  if (freedom > 0) {
    const double chi2 = weights.cwiseProduct(left).squaredNorm() / static_cast<double>(freedom);
    excess = std::max(1.0, chi2);
    fit.stray_k = std::sqrt(chi2 * static_cast<double>(rows) / weights.squaredNorm());
  }
  const Eigen::MatrixXd inverse = (weighted.transpose() * weighted).inverse();
  const bool is_stated =
      std::ranges::any_of(points, [](const SetPoint& point) { return point.own_sigma_k > 0.0; });
  // Where nobody states an uncertainty, what they stray by is all that is known.
  const double unstated = std::pow(fit.stray_k / kMinSigma_k, 2);
  fit.covariance = (is_stated ? excess : unstated) * inverse;
  return fit;
}

/// Returns what all set points are off by together at a reading, between those of the nearest ones.
double CommonSigma(std::vector<SetPoint> points, double reading) {
  std::ranges::sort(points, {}, &SetPoint::reading_celsius);
  const auto above = std::ranges::lower_bound(points, reading, {}, &SetPoint::reading_celsius);
  if (above == points.begin()) return points.front().common_sigma_k;
  if (above == points.end()) return points.back().common_sigma_k;
  const SetPoint& below = *(above - 1);
  const double fraction =
      (reading - below.reading_celsius) / (above->reading_celsius - below.reading_celsius);
  return std::lerp(below.common_sigma_k, above->common_sigma_k, fraction);
}

/// Root mean square of what is wrong with points by a fit of the others; nullopt: too few.
std::optional<double> HeldOut(const std::vector<SetPoint>& points, const Scale& scale, int degree) {
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<SetPoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (DistinctReadings(others) < degree + 1) return std::nullopt;
    const double left = Wrong(points[i]) - Fit(others, scale, degree).At(points[i].reading_celsius);
    squares += left * left;
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

RadiometricCorrection TableOf(const Polynomial& fit, const std::vector<SetPoint>& points) {
  RadiometricCorrection table;
  const auto add = [&](double reading) {
    const double sigma_k =
        std::hypot(fit.SigmaAt(reading), fit.stray_k, CommonSigma(points, reading));
    table.readings_celsius.push_back(static_cast<float>(reading));
    table.corrections_k.push_back(static_cast<float>(fit.At(reading)));
    table.sigmas_k.push_back(static_cast<float>(sigma_k));
  };
  if (fit.degree() == 0) {
    add(fit.scale.middle);
    return table;
  }
  for (int i = 0; i < kNodes; ++i)
    add(fit.scale.middle + fit.scale.half * (2.0 * i / (kNodes - 1) - 1.0));
  return table;
}

}  // namespace

Result<CurveReport> FitCurve(const std::vector<SetPoint>& points) {
  if (points.empty()) return Err(FailedPrecondition("there is no set point"));
  const Scale scale = ScaleOf(points);
  CurveReport report;
  std::optional<double> best = HeldOut(points, scale, 0);
  for (int degree = 1; degree <= kMaxDegree; ++degree) {
    const std::optional<double> left = HeldOut(points, scale, degree);
    if (!left || !(*left < kBetterBy * *best)) continue;
    best = left;
    report.degree = degree;
  }
  report.held_out_k = best.value_or(std::numeric_limits<double>::quiet_NaN());
  const Polynomial fit = Fit(points, scale, report.degree);
  double squares = 0.0;
  for (const SetPoint& point : points) squares += Wrong(point) * Wrong(point);
  report.before_k = std::sqrt(squares / static_cast<double>(points.size()));
  report.correction = TableOf(fit, points);
  if (Status status = Validate(report.correction); !status.ok()) {
    return Err(status.WithContext(
        "what set points tell is no correction of a camera (is one of them of another reading?)"));
  }
  return report;
}

}  // namespace isotherm
