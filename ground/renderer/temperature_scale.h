#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

class RendererOptions;

/// Count, extremes, mean and standard deviation of temperatures, °C. NaN is left out.
struct TemperatureStatistics {
  std::uint64_t count = 0;
  double min_celsius = 0.0;
  double max_celsius = 0.0;
  double mean_celsius = 0.0;
  double sigma_kelvin = 0.0;  ///< Standard deviation of the population: divided by count.
};
TemperatureStatistics Summarize(std::span<const float> celsius);

/// The temperatures that the first and last colour of the palette stand for (algorithm 7, line 2).
struct TemperatureScale {
  double min_celsius = 0.0;
  double max_celsius = 0.0;
  bool values_below = false;  ///< Some temperatures are outside and get an end colour.
  bool values_above = false;

  /// 0 at the first colour, 1 at the last, not limited.
  double Fraction(double celsius) const {
    return (celsius - min_celsius) / (max_celsius - min_celsius);
  }
};

/// Applies the scale rule to temperatures in °C, of which NaN is left out: the extremes, or mean +-
/// 1 or 3 standard deviations but never wider than the extremes, or two percentiles, or the fixed
/// limits. At least 0.1 K wide. nullopt: no temperature to derive it from.
std::optional<TemperatureScale> ChooseScale(const RendererOptions& options,
                                            std::span<const float> celsius);

/// The value below which `percent` of the values lie, interpolated between neighbours in order (R.
/// Hyndman and Y. Fan, "Sample quantiles in statistical packages", 1996, definition 7). NaN is left
/// out; nullopt: nothing else is there.
std::optional<double> Percentile(std::span<const float> values, double percent);

/// The scale rule in words for a legend or a header, e.g. "3 sigma".
std::string ScaleRuleName(const RendererOptions& options);

/// Sets the scale by one text: "min-max", "1-sigma", "3-sigma", "percentile", "2..98%"
/// (percentiles) or "20..100" (fixed limits as in ParseCelsius).
Status ParseScale(std::string_view text, RendererOptions& options);

}  // namespace isotherm
