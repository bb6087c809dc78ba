#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Tells how often each part of a scan counts. All ones are the scan as it is.
using PartWeights = std::vector<double>;

/// Returns how much the thermal images disagree at one delay in seconds, by resampling of the
/// scan's parts. All delays must be compared by the same samples. `fine` asks for the most exact
/// figures, otherwise they are found fast.
using DisagreementOf = std::function<std::vector<double>(
    double delay_s, bool fine, const std::vector<PartWeights>& resamplings)>;

/// Weighs the samples for delays near this one in seconds. Weights made for another delay pull the
/// result towards it, for its samples on edges count less than others.
using WeighAt = std::function<void(double delay_s)>;

/// Holds the grids that are searched and when their minimum counts as an estimate.
struct DelaySearchOptions {
  double range_s = 0.15;  ///< The delay is looked for in [-range_s, range_s].
  double coarse_step_s = 0.005;
  double fine_step_s = 0.003;
  int fine_steps = 5;          ///< To each side of the coarse minimum.
  double max_sigma_s = 0.002;  ///< An estimate less certain than this is none.
  /// By this factor at least, images must disagree more at the ends of the fine steps than at the
  /// minimum.
  double min_contrast = 1.02;
  int resamplings = 200;
  std::uint64_t seed = 1;
};

/// Holds a delay and how certain it is.
struct DelayEstimate {
  double delay_s = 0.0;
  double sigma_s = 0.0;        ///< Spread over resampled parts of the scan (SearchDelay).
  double contrast = 0.0;       ///< Disagreement at the ends of the fine steps over the least.
  int parts = 0;               ///< Parts of the scan that were resampled.
  double drift_sigma_s = 0.0;  ///< The part of sigma_s that the drift of poses makes (FindDelay).
};

/// The delay at which thermal images disagree least: on a grid, then on a fine grid around its
/// minimum, there by a parabola. Resampling the `parts` of the scan (bootstrap) gives the
/// uncertainty. Fails if the parts are too few, if the minimum lies at the end of the range, is too
/// flat or too uncertain, and says what the scan lacks. Deterministic. `progress` gets the fraction
/// done, 0..1.
Result<DelayEstimate> SearchDelay(const DisagreementOf& disagreement, const WeighAt& weigh_at,
                                  int parts, const DelaySearchOptions& options,
                                  const std::function<void(double)>& progress);

}  // namespace isotherm
