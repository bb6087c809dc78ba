#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// A line of equal temperature.
struct IsothermLine {
  double celsius = 0.0;
  Rgb8 colour;
};

/// Temperatures that stand out, ends included.
struct TemperatureBand {
  double from_celsius = 0.0;   ///< -infinity: no lower end.
  double to_celsius = 0.0;     ///< +infinity: no upper end.
  std::optional<Rgb8> colour;  ///< nullopt: its own colours, while what is in no band turns grey.

  bool Contains(double celsius) const { return celsius >= from_celsius && celsius <= to_celsius; }
};

/// "60, 80#00ff00, 212F": at most 32 lines, white unless said otherwise. Empty text: none. Numbers
/// as in ParseCelsius.
Result<std::vector<IsothermLine>> ParseIsotherms(std::string_view text);

/// "80..100#ff00ff, 200.." : at most 8 bands, in which one end may be missing.
Result<std::vector<TemperatureBand>> ParseBands(std::string_view text);

}  // namespace isotherm
