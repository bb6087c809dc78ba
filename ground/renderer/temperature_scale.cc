#include "ground/renderer/temperature_scale.h"

#include <algorithm>
#include <cmath>

#include "ground/ground_options.pb.h"

namespace isotherm {
namespace {

// Two camera temperature steps of a fine camera (0.05 K): a narrower scale would only show noise.
constexpr double kNarrowestKelvin = 0.1;

}  // namespace

/// In one pass and numerically stable, whatever the order of the values.
TemperatureStatistics Summarize(std::span<const float> celsius) {
  TemperatureStatistics result;
  double sum_of_squares = 0.0;  // Of deviations from the running mean (Welford 1962).
  for (const float value : celsius) {
    if (std::isnan(value)) continue;
    const double t = value;
    result.min_celsius = result.count == 0 ? t : std::min(result.min_celsius, t);
    result.max_celsius = result.count == 0 ? t : std::max(result.max_celsius, t);
    ++result.count;
    const double deviation = t - result.mean_celsius;
    result.mean_celsius += deviation / static_cast<double>(result.count);
    sum_of_squares += deviation * (t - result.mean_celsius);
  }
  if (result.count > 0) {
    result.sigma_kelvin = std::sqrt(sum_of_squares / static_cast<double>(result.count));
  }
  return result;
}

std::optional<TemperatureScale> ChooseScale(const RendererOptions& options,
                                            const TemperatureStatistics& statistics) {
  TemperatureScale scale;
  if (options.scale() == FIXED) {
    scale.min_celsius = options.scale_min_celsius();
    scale.max_celsius = options.scale_max_celsius();
  } else {
    if (statistics.count == 0) return std::nullopt;
    scale.min_celsius = statistics.min_celsius;
    scale.max_celsius = statistics.max_celsius;
    if (options.scale() != MIN_MAX) {
      const double reach = (options.scale() == ONE_SIGMA ? 1.0 : 3.0) * statistics.sigma_kelvin;
      scale.min_celsius = std::max(scale.min_celsius, statistics.mean_celsius - reach);
      scale.max_celsius = std::min(scale.max_celsius, statistics.mean_celsius + reach);
    }
    const double missing = kNarrowestKelvin - (scale.max_celsius - scale.min_celsius);
    if (missing > 0.0) {
      scale.min_celsius -= missing / 2.0;
      scale.max_celsius += missing / 2.0;
    }
  }
  scale.values_below = statistics.count > 0 && statistics.min_celsius < scale.min_celsius;
  scale.values_above = statistics.count > 0 && statistics.max_celsius > scale.max_celsius;
  return scale;
}

std::string ScaleRuleName(const RendererOptions& options) {
  switch (options.scale()) {
    case MIN_MAX:
      return "min to max";
    case ONE_SIGMA:
      return "1 sigma";
    case THREE_SIGMA:
      return "3 sigma";
    case FIXED:
      return "fixed";
  }
  return "";
}

}  // namespace isotherm
