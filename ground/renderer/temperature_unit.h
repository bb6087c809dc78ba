#pragma once

#include <string>
#include <string_view>

#include "common/base/status.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// A unit in which a legend writes values: shown = factor * value + offset.
struct DisplayUnit {
  std::string name = "\u00B0C";
  double factor = 1.0;
  double offset = 0.0;

  double Of(double value) const { return factor * value + offset; }
};

/// For values in °C.
DisplayUnit DisplayUnitOf(TemperatureUnit unit);

/// A finite temperature above absolute zero, in °C, or with C, F or K behind it: "60", "140F",
/// "333.15 K". Returns °C.
Result<double> ParseCelsius(std::string_view text);

}  // namespace isotherm
