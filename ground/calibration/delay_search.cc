#include "ground/calibration/delay_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/noise.h"

namespace isotherm {
namespace {

// Of the scan, for a spread between them to mean something.
constexpr int kMinParts = 5;
// Fractions of the progress; only what is shown depends on them.
constexpr double kCoarseFraction = 0.4, kAgainFraction = 0.5;
// To each side of the first minimum, when samples are weighed for it.
constexpr int kAgainSteps = 4;
// The weights depend on the delay they are made at: once at the first minimum and once at the one
// found with those. Weights made for another delay pull the result towards it (docs/timing.md).
constexpr int kWeighings = 2;
// Grid points to either side of the lowest that the parabola is laid through.
constexpr std::ptrdiff_t kParabolaReach = 3;

/// Disagreement by delay (outer) and resampling (inner).
struct Grid {
  std::vector<double> delays_s;
  std::vector<std::vector<double>> values;

  std::vector<double> Curve(std::size_t resampling) const {
    std::vector<double> curve;
    for (const std::vector<double>& at_delay : values) curve.push_back(at_delay[resampling]);
    return curve;
  }
};

/// Minimum of the least-squares parabola around the lowest point of the grid; nullopt if that lies
/// at the end of the grid, or opens downwards.
std::optional<double> Minimum(const Grid& grid, std::size_t resampling) {
  const std::vector<double> values = grid.Curve(resampling);
  const auto lowest = std::min_element(values.begin(), values.end()) - values.begin();
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  if (lowest == 0 || lowest == last) return std::nullopt;
  const std::ptrdiff_t reach = std::min({kParabolaReach, lowest, last - lowest});
  // For abscissas -reach..reach the normal equations decouple.
  double s0 = 0.0, s2 = 0.0, s4 = 0.0, y0 = 0.0, y1 = 0.0, y2 = 0.0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    const auto x = static_cast<double>(k);
    const double y = values[static_cast<std::size_t>(lowest + k)];
    s0 += 1.0;
    s2 += x * x;
    s4 += x * x * x * x;
    y0 += y;
    y1 += x * y;
    y2 += x * x * y;
  }
  const double curvature = (s0 * y2 - s2 * y0) / (s0 * s4 - s2 * s2);
  if (!(curvature > 0.0)) return std::nullopt;
  const double shift = std::clamp(-y1 / s2 / (2.0 * curvature), -1.5, 1.5);
  const auto center = static_cast<std::size_t>(lowest);
  return grid.delays_s[center] + shift * (grid.delays_s[1] - grid.delays_s[0]);
}

Grid Evaluate(const DisagreementOf& disagreement, double center_s, double step_s, int steps,
              bool fine, const std::vector<PartWeights>& resamplings,
              const std::function<void(double)>& progress) {
  Grid grid;
  for (int k = -steps; k <= steps; ++k) {
    grid.delays_s.push_back(center_s + k * step_s);
    grid.values.push_back(disagreement(grid.delays_s.back(), fine, resamplings));
    if (progress) progress(static_cast<double>(k + steps + 1) / (2 * steps + 1));
  }
  return grid;
}

/// The scan as it is, then as many parts drawn with replacement, again and again.
std::vector<PartWeights> Resample(int parts, const DelaySearchOptions& options) {
  const auto count = static_cast<std::size_t>(parts);
  std::vector<PartWeights> resamplings(1, PartWeights(count, 1.0));
  const std::uint64_t stream = NoiseStream(options.seed, 0x64656c6179, 0);
  std::uint64_t counter = 0;
  for (int i = 0; i < options.resamplings; ++i) {
    PartWeights weights(count, 0.0);
    for (int k = 0; k < parts; ++k)
      weights[static_cast<std::size_t>(UniformNoise(stream, counter++) * parts)] += 1.0;
    resamplings.push_back(std::move(weights));
  }
  return resamplings;
}

double Spread(const Grid& grid) {
  double sum = 0.0, squares = 0.0;
  const std::size_t resamplings = grid.values.front().size();
  for (std::size_t i = 1; i < resamplings; ++i) {
    // Without a minimum in reach, the delay may be anywhere.
    const double end_s = grid.values.front()[i] < grid.values.back()[i] ? grid.delays_s.front()
                                                                        : grid.delays_s.back();
    const double delay_s = Minimum(grid, i).value_or(end_s);
    sum += delay_s;
    squares += delay_s * delay_s;
  }
  const auto n = static_cast<double>(resamplings - 1);
  return std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1.0)));
}

Status CheckEstimate(const DelayEstimate& estimate, const DelaySearchOptions& options) {
  if (estimate.contrast >= options.min_contrast && estimate.sigma_s <= options.max_sigma_s)
    return OkStatus();
  return FailedPrecondition(fmt::format(
      "the delay cannot be told: about {:.1f} ms, but uncertain by {:.1f} ms (allowed {:.1f} ms), "
      "and the images disagree {:.2f} times as much {:.0f} ms away (needed {:.2f}); move the rig "
      "back and forth faster, in front of something with more thermal contrast",
      1e3 * estimate.delay_s, 1e3 * estimate.sigma_s, 1e3 * options.max_sigma_s, estimate.contrast,
      1e3 * options.fine_steps * options.fine_step_s, options.min_contrast));
}

}  // namespace

Result<DelayEstimate> SearchDelay(const DisagreementOf& disagreement, const WeighAt& weigh_at,
                                  int parts, const DelaySearchOptions& options,
                                  const std::function<void(double)>& progress) {
  const auto fraction = [&](double from, double to) {
    return [&progress, from, to](double done) {
      if (progress) progress(from + (to - from) * done);
    };
  };
  if (parts < kMinParts) {
    return Err(FailedPrecondition(
        fmt::format("{} parts of the scan show the surface to the thermal camera while the rig's "
                    "motion is known, {} are needed: scan for longer",
                    parts, kMinParts)));
  }
  const std::vector<PartWeights> resamplings = Resample(parts, options);
  const std::vector<PartWeights> whole(1, resamplings.front());
  const auto coarse_steps = static_cast<int>(std::lround(options.range_s / options.coarse_step_s));
  const Grid coarse = Evaluate(disagreement, 0.0, options.coarse_step_s, coarse_steps, false, whole,
                               fraction(0.0, kCoarseFraction));
  std::optional<double> near = Minimum(coarse, 0);
  for (int round = 0; near && round < kWeighings; ++round) {
    weigh_at(*near);
    const Grid around = Evaluate(disagreement, *near, options.coarse_step_s, kAgainSteps, false,
                                 whole, fraction(kCoarseFraction, kAgainFraction));
    near = Minimum(around, 0);
  }
  const double reach_s = options.fine_steps * options.fine_step_s;
  if (!near || std::abs(*near) + reach_s > options.range_s) {
    return Err(FailedPrecondition(
        fmt::format("no delay within {:.0f} ms makes the thermal images agree: there is too little "
                    "motion back and forth, too little thermal contrast, or the delay is larger "
                    "(--range)",
                    1e3 * (options.range_s - reach_s))));
  }
  const Grid fine = Evaluate(disagreement, *near, options.fine_step_s, options.fine_steps, true,
                             resamplings, fraction(kAgainFraction, 1.0));
  const std::optional<double> minimum = Minimum(fine, 0);
  const std::vector<double> curve = fine.Curve(0);
  const double least = *std::min_element(curve.begin(), curve.end());
  DelayEstimate estimate;
  estimate.parts = parts;
  estimate.delay_s = minimum.value_or(*near);
  estimate.sigma_s = minimum ? Spread(fine) : INFINITY;
  estimate.contrast = 0.5 * (curve.front() + curve.back()) / std::max(least, 1e-12);
  if (Status fit = CheckEstimate(estimate, options); !fit.ok()) return Err(fit);
  return estimate;
}

}  // namespace isotherm
