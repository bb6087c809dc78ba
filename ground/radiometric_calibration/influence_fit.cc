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

constexpr int kMinHoles = 3;
/// The largest hole has to have this many times the radius of the smallest one.
constexpr double kMinRatio = 2.0;
/// Reaches to begin with, pixels: the cost has several minima over it.
constexpr double kFirstReaches_px[] = {15.0, 40.0, 100.0};
constexpr double kFirstFraction = 0.02;
constexpr int kMaxSteps = 20;
/// Steps to either side for derivatives: images hold single precision.
constexpr double kFractionStep = 1e-3, kLogarithmStep = 1e-2;
/// Radii that differ by less are one.
constexpr double kDistinct = 1.15;

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
    Parameters low = parameters, high = parameters;
    const double step = p == 1 ? kLogarithmStep : kFractionStep;
    low(p) -= step;
    high(p) += step;
    // Fractions may be at their least, the reach at its most.
    low = WithinBounds(low);
    high = WithinBounds(high);
    const std::vector<Readings> below = Corrected(views, low);
    std::vector<Readings> slope = Corrected(views, high);
    for (std::size_t i = 0; i < slope.size(); ++i) {
      slope[i].body = (slope[i].body - below[i].body) / (high(p) - low(p));
      slope[i].plate = (slope[i].plate - below[i].plate) / (high(p) - low(p));
    }
    at.slopes.push_back(std::move(slope));
  }
  return at;
}

/// Returns the step towards the least squares of deviations.
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

/// Goes Levenberg and Marquardt's way from a first guess.
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

/// How many different holes a setting was seen through, and the largest of its radii as a ratio to
/// the smallest.
struct HoleRange {
  int holes = 0;
  double ratio = 0.0;
};

HoleRange HolesOf(const std::vector<ApertureView>& views, int setting) {
  std::vector<double> radii;
  for (const ApertureView& view : views)
    if (view.setting == setting) radii.push_back(view.image.hole_radius_px);
  std::ranges::sort(radii);
  HoleRange range{0, radii.back() / radii.front()};
  double last = 0.0;
  for (const double radius : radii) {
    if (radius < kDistinct * last) continue;
    ++range.holes;
    last = radius;
  }
  return range;
}

Status CheckViews(const std::vector<ApertureView>& views) {
  for (const ApertureView& view : views) {
    if (view.image.celsius.width() != views.front().image.celsius.width() ||
        view.image.celsius.height() != views.front().image.celsius.height()) {
      return FailedPrecondition("images of different size are not of one camera");
    }
  }
  // Only within one setting can holes be compared.
  HoleRange best;
  for (const ApertureView& view : views) {
    const HoleRange range = HolesOf(views, view.setting);
    if (range.holes > best.holes || (range.holes == best.holes && range.ratio > best.ratio))
      best = range;
  }
  if (best.holes >= kMinHoles && best.ratio >= kMinRatio) return OkStatus();
  return FailedPrecondition(fmt::format(
      "it takes the black body at one temperature through three or more holes of different radius, "
      "the largest twice as large as the smallest or more: there are {}{}",
      best.holes,
      best.holes > 1 ? fmt::format(", the largest {:.1f} times as large", best.ratio) : ""));
}

/// Squares of how far views read from the others of their setting, and their number.
struct Apart {
  double squares = 0.0;
  int views = 0;

  void Add(const std::optional<double>& apart_k) {
    if (!apart_k) return;
    squares += *apart_k * *apart_k;
    ++views;
  }
  double Rms() const { return std::sqrt(squares / std::max(1, views)); }
};

/// How far a view reads from the others once it is corrected by other parameters.
std::optional<double> ApartFromOthers(const std::vector<ApertureView>& views,
                                      const Parameters& parameters, std::size_t view) {
  // The view itself, and its setting.
  std::vector<ApertureView> same{views[view]};
  for (std::size_t i = 0; i < views.size(); ++i)
    if (i != view && views[i].setting == views[view].setting) same.push_back(views[i]);
  return ApartFromOthers(same, Corrected(same, parameters), 0);
}

}  // namespace

bool InfluenceReport::IsKnown() const {
  constexpr double kLeft = 0.5;
  return apart_after_k < kLeft * apart_before_k;
}

double ApartWithout(const SceneInfluence& influence, const std::vector<ApertureView>& views) {
  const std::vector<Readings> readings = Corrected(
      views,
      {influence.near_fraction, std::log(influence.near_sigma_px), influence.total_fraction});
  Apart apart;
  for (std::size_t i = 0; i < views.size(); ++i) apart.Add(ApartFromOthers(views, readings, i));
  return apart.Rms();
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
  report.apart_before_k = ApartWithout({}, views);
  const Linearisation at = Linearise(views, best->parameters);
  // The jackknife: what the others tell, by one step from what all tell.
  std::vector<Parameters> others;
  Parameters mean = Parameters::Zero();
  Apart after;
  const auto count = static_cast<double>(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Parameters without =
        WithinBounds(best->parameters + StepOf(at, Deviations(views, static_cast<int>(i)), 0.0));
    others.push_back(without);
    mean += without / count;
    after.Add(ApartFromOthers(views, without, i));
  }
  report.views = after.views;
  report.apart_after_k = after.Rms();
  // The logarithm of the reach was solved for.
  const Parameters scale(1.0, report.influence.near_sigma_px, 1.0);
  for (const Parameters& each : others) {
    const Parameters off = scale.cwiseProduct(each - mean);
    report.covariance += (count - 1.0) / count * off * off.transpose();
  }
  return report;
}

}  // namespace isotherm
