#include "ground/renderer/temperature_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "ground/options/ground_options.pb.h"
#include "ground/renderer/temperature_unit.h"

namespace isotherm {
namespace {

// Two camera temperature steps of a fine camera (0.05 K): a narrower scale would only show noise.
constexpr double kMinWidth_k = 0.1;

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

std::optional<double> Percentile(std::span<const float> values, double percent) {
  std::vector<float> sorted;
  sorted.reserve(values.size());
  std::ranges::copy_if(values, std::back_inserter(sorted), [](float v) { return !std::isnan(v); });
  if (sorted.empty()) return std::nullopt;
  const double rank =
      std::clamp(percent, 0.0, 100.0) / 100.0 * static_cast<double>(sorted.size() - 1);
  const auto lower = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
  std::ranges::nth_element(sorted, lower);
  const double value = *lower;
  if (lower + 1 == sorted.end()) return value;
  // nth_element leaves what is above in no order; the least of it is the next rank.
  const double next = *std::min_element(lower + 1, sorted.end());
  return value + (rank - std::floor(rank)) * (next - value);
}

std::optional<TemperatureScale> ChooseScale(const RendererOptions& options,
                                            std::span<const float> celsius) {
  const TemperatureStatistics statistics = Summarize(celsius);
  TemperatureScale scale;
  if (options.scale() == FIXED) {
    scale.min_celsius = options.scale_min_celsius();
    scale.max_celsius = options.scale_max_celsius();
  } else {
    if (statistics.count == 0) return std::nullopt;
    scale.min_celsius = statistics.min_celsius;
    scale.max_celsius = statistics.max_celsius;
    if (options.scale() == PERCENTILE) {
      scale.min_celsius = *Percentile(celsius, options.expert().percentile_low());
      scale.max_celsius = *Percentile(celsius, options.expert().percentile_high());
    } else if (options.scale() != MIN_MAX) {
      const double reach = (options.scale() == ONE_SIGMA ? 1.0 : 3.0) * statistics.sigma_kelvin;
      // A scale that reaches beyond the values would waste colours.
      scale.min_celsius = std::max(scale.min_celsius, statistics.mean_celsius - reach);
      scale.max_celsius = std::min(scale.max_celsius, statistics.mean_celsius + reach);
    }
    const double missing = kMinWidth_k - (scale.max_celsius - scale.min_celsius);
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
    case PERCENTILE:
      return fmt::format("{:g} to {:g} %", options.expert().percentile_low(),
                         options.expert().percentile_high());
  }
  return "";
}

Status ParseScale(std::string_view text, RendererOptions& options) {
  constexpr std::pair<std::string_view, ScaleRule> kRules[] = {{"min-max", MIN_MAX},
                                                               {"1-sigma", ONE_SIGMA},
                                                               {"3-sigma", THREE_SIGMA},
                                                               {"percentile", PERCENTILE}};
  for (const auto& [name, rule] : kRules) {
    if (text != name) continue;
    options.set_scale(rule);
    return OkStatus();
  }
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) {
    return InvalidArgument(
        fmt::format("'{}' is no scale: min-max, 1-sigma, 3-sigma, percentile, 2..98% or, for fixed "
                    "temperatures, 20..100",
                    text));
  }
  // "5..95%" are quantiles, "5..95" temperatures.
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  const Result<double> low = ParseCelsius(text.substr(0, dots));
  const Result<double> high = ParseCelsius(text.substr(dots + 2));
  if (!low) return low.error();
  if (!high) return high.error();
  options.set_scale(percent ? PERCENTILE : FIXED);
  if (percent) {
    options.mutable_expert()->set_percentile_low(*low);
    options.mutable_expert()->set_percentile_high(*high);
  } else {
    options.set_scale_min_celsius(*low);
    options.set_scale_max_celsius(*high);
  }
  return OkStatus();
}

}  // namespace isotherm
