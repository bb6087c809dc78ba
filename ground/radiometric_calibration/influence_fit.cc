#include "ground/radiometric_calibration/influence_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {
namespace {

/// Near fraction, logarithm of the near sigma in pixels, total fraction.
using Parameters = Eigen::Vector3d;

constexpr int kMinViews = 3;
/// The largest hole has to have this many times the radius of the smallest one.
constexpr double kMinRatio = 2.0;
/// Reaches to begin with, pixels: the cost has several minima over it.
constexpr double kFirstReaches_px[] = {15.0, 40.0, 100.0};
constexpr double kFirstFraction = 0.02;
constexpr int kMaxSteps = 20;
constexpr double kSmallStep = 1e-5;  // Of fractions, and of the logarithm.

SceneInfluence InfluenceOf(const Parameters& parameters) {
  return {.near_fraction = parameters(0),
          .near_sigma_px = std::exp(parameters(1)),
          .total_fraction = parameters(2)};
}

Parameters WithinBounds(Parameters parameters) {
  for (const int fraction : {0, 2})
    parameters(fraction) = std::clamp(parameters(fraction), 0.0, SceneInfluence::kMaxFraction);
  parameters(1) = std::clamp(parameters(1), std::log(SceneInfluence::kMinSigma_px),
                             std::log(SceneInfluence::kMaxSigma_px));
  return parameters;
}

/// Holds what the patches of one view read.
struct Readings {
  Eigen::VectorXd body, plate;
};

Readings ReadingsOf(const ApertureImage& image, const Image<float>& celsius) {
  const auto means = [&](const std::vector<PixelPatch>& patches) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(patches.size()));
    for (std::size_t i = 0; i < patches.size(); ++i)
      values(static_cast<Eigen::Index>(i)) = MeanOf(patches[i], celsius);
    return values;
  };
  return {means(image.body), means(image.plate)};
}

/// Returns what they read without the influence.
std::vector<Readings> Corrected(const std::vector<ApertureView>& views,
                                const Parameters& parameters) {
  std::vector<Readings> readings;
  std::optional<SceneInfluenceCorrector> corrector;
  Image<float> celsius;
  for (const ApertureView& view : views) {
    celsius = view.image.celsius;
    if (!corrector) corrector.emplace(InfluenceOf(parameters), celsius.width(), celsius.height());
    corrector->Correct(celsius);
    readings.push_back(ReadingsOf(view.image, celsius));
  }
  return readings;
}

/// How readings of views differ from the means that they should have: of the black body from that
/// of its setting, of the plate from that of its view. Linear in the readings, so that it is the
/// same for derivatives. Both count as much in each view, however many pixels they have.
class Deviations {
 public:
  /// `left_out` is no view of it; -1: all are.
  Deviations(const std::vector<ApertureView>& views, int left_out)
      : views_(views), left_out_(left_out) {}

  Eigen::VectorXd Of(const std::vector<Readings>& readings) const {
    std::map<int, std::pair<double, int>> settings;
    Eigen::Index rows = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (IsLeftOut(i)) continue;
      auto& [sum, count] = settings[views_[i].setting];
      sum += readings[i].body.mean();
      ++count;
      rows += readings[i].body.size() + readings[i].plate.size();
    }
    Eigen::VectorXd deviations(rows);
    Eigen::Index row = 0;
    const auto append = [&](const Eigen::VectorXd& values, double mean) {
      if (values.size() == 0) return;
      const double weight = 1.0 / std::sqrt(static_cast<double>(values.size()));
      deviations.segment(row, values.size()) = weight * (values.array() - mean).matrix();
      row += values.size();
    };
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (IsLeftOut(i)) continue;
      const auto& [sum, count] = settings[views_[i].setting];
      append(readings[i].body, sum / count);
      append(readings[i].plate, readings[i].plate.size() > 0 ? readings[i].plate.mean() : 0.0);
    }
    return deviations;
  }

 private:
  bool IsLeftOut(std::size_t view) const { return static_cast<int>(view) == left_out_; }

  const std::vector<ApertureView>& views_;
  const int left_out_;
};

/// Readings at some parameters, and how they change with these.
struct Linearisation {
  std::vector<Readings> readings;
  std::vector<std::vector<Readings>> slopes;  ///< By parameter.
};

Linearisation Linearise(const std::vector<ApertureView>& views, const Parameters& parameters) {
  Linearisation at{Corrected(views, parameters), {}};
  for (int p = 0; p < parameters.size(); ++p) {
    // Fractions may be at their least, the reach at its most.
    const double step = p == 1 ? -kSmallStep : kSmallStep;
    Parameters moved = parameters;
    moved(p) += step;
    std::vector<Readings> slope = Corrected(views, moved);
    for (std::size_t i = 0; i < slope.size(); ++i) {
      slope[i].body = (slope[i].body - at.readings[i].body) / step;
      slope[i].plate = (slope[i].plate - at.readings[i].plate) / step;
    }
    at.slopes.push_back(std::move(slope));
  }
  return at;
}

/// The step towards the least squares of deviations.
Parameters StepOf(const Linearisation& at, const Deviations& deviations, double damping) {
  const Eigen::VectorXd residuals = deviations.Of(at.readings);
  Eigen::MatrixXd jacobian(residuals.size(), 3);
  for (int p = 0; p < 3; ++p)
    jacobian.col(p) = deviations.Of(at.slopes[static_cast<std::size_t>(p)]);
  Eigen::Matrix3d normal = jacobian.transpose() * jacobian;
  normal.diagonal() *= 1.0 + damping;
  // A reach without a fraction tells nothing; then its row is empty.
  normal.diagonal().array() += 1e-9 * normal.trace();
  return -normal.ldlt().solve(jacobian.transpose() * residuals);
}

struct Solution {
  Parameters parameters;
  double cost = 0.0;
};

/// Levenberg and Marquardt's way from a first guess.
Solution Descend(const std::vector<ApertureView>& views, Parameters parameters) {
  const Deviations deviations(views, -1);
  Linearisation at = Linearise(views, parameters);
  double cost = deviations.Of(at.readings).squaredNorm(), damping = 1e-3;
  for (int step = 0; step < kMaxSteps && damping < 1e6; ++step) {
    const Parameters next = WithinBounds(parameters + StepOf(at, deviations, damping));
    const double next_cost = deviations.Of(Corrected(views, next)).squaredNorm();
    if (!(next_cost < cost)) {
      damping *= 10.0;
      continue;
    }
    const bool is_done = cost - next_cost < 1e-6 * cost;
    parameters = next;
    cost = next_cost;
    if (is_done) break;
    damping *= 0.1;
    at = Linearise(views, parameters);
  }
  return {parameters, cost};
}

/// How far the black body of a view reads from the mean of the others of its setting, kelvin.
/// nullopt: there are none.
std::optional<double> ApartFromOthers(const std::vector<ApertureView>& views,
                                      const std::vector<Readings>& readings, std::size_t view) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i == view || views[i].setting != views[view].setting) continue;
    sum += readings[i].body.mean();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return readings[view].body.mean() - sum / count;
}

Status CheckViews(const std::vector<ApertureView>& views) {
  const auto radius = [](const ApertureView& view) { return view.image.hole_radius_px; };
  if (static_cast<int>(views.size()) < kMinViews) {
    return FailedPrecondition(
        fmt::format("the scene's influence needs the black body through three or more holes of "
                    "different radius, "
                    "at one temperature: there are {}",
                    views.size()));
  }
  for (const ApertureView& view : views) {
    if (view.image.celsius.width() != views.front().image.celsius.width() ||
        view.image.celsius.height() != views.front().image.celsius.height()) {
      return FailedPrecondition("images of different size are not of one camera");
    }
  }
  // Only within one setting can holes be compared.
  double ratio = 0.0;
  for (const ApertureView& a : views)
    for (const ApertureView& b : views)
      if (a.setting == b.setting) ratio = std::max(ratio, radius(a) / radius(b));
  if (ratio >= kMinRatio) return OkStatus();
  return FailedPrecondition(fmt::format(
      "at no temperature of the black body the largest hole has {} times the radius of the "
      "smallest one: the scene's influence cannot be told",
      kMinRatio));
}

}  // namespace

bool InfluenceReport::IsKnown() const {
  constexpr double kLeft = 0.5;
  return apart_after_k < kLeft * apart_before_k;
}

Result<InfluenceReport> FitInfluence(const std::vector<ApertureView>& views) {
  if (Status status = CheckViews(views); !status.ok()) return Err(status);
  std::optional<Solution> best;
  for (const double reach_px : kFirstReaches_px) {
    const Solution found = Descend(views, {kFirstFraction, std::log(reach_px), kFirstFraction});
    if (!best || found.cost < best->cost) best = found;
  }
  InfluenceReport report;
  report.influence = InfluenceOf(best->parameters);
  const Linearisation at = Linearise(views, best->parameters);
  std::vector<Readings> measured;
  for (const ApertureView& view : views)
    measured.push_back(ReadingsOf(view.image, view.image.celsius));
  // The jackknife: what the others tell, by one step from what all tell.
  std::vector<Parameters> others;
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Parameters without =
        WithinBounds(best->parameters + StepOf(at, Deviations(views, static_cast<int>(i)), 0.0));
    others.push_back(without);
    const std::optional<double> apart = ApartFromOthers(views, measured, i);
    if (!apart) continue;
    before += *apart * *apart;
    const double corrected = *ApartFromOthers(views, Corrected(views, without), i);
    after += corrected * corrected;
    ++report.views;
  }
  report.apart_before_k = std::sqrt(before / std::max(1, report.views));
  report.apart_after_k = std::sqrt(after / std::max(1, report.views));
  const auto count = static_cast<double>(others.size());
  Parameters mean = Parameters::Zero(), variance = Parameters::Zero();
  for (const Parameters& each : others) mean += each / count;
  for (const Parameters& each : others)
    variance += (count - 1.0) / count * (each - mean).cwiseAbs2();
  report.near_fraction_sigma = std::sqrt(variance(0));
  report.near_sigma_px_sigma = report.influence.near_sigma_px * std::sqrt(variance(1));
  report.total_fraction_sigma = std::sqrt(variance(2));
  return report;
}

}  // namespace isotherm
