#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

class RendererOptions;

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

/// Fails if there are more than 32 lines or 8 bands, or if a number or a colour of one is none.
Result<std::vector<IsothermLine>> IsothermsOf(const RendererOptions& options);
Result<std::vector<TemperatureBand>> BandsOf(const RendererOptions& options);

/// Replaces the isotherms by those of a command line: "60, 80#00ff00, 212F", white unless said
/// otherwise. Empty text: none. Numbers as in ParseCelsius.
Status ParseIsotherms(std::string_view text, RendererOptions& options);

/// The same with bands: "80..100#ff00ff, 200..", in which one end may be missing.
Status ParseBands(std::string_view text, RendererOptions& options);

}  // namespace isotherm
