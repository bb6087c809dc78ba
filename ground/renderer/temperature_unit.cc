#include "ground/renderer/temperature_unit.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr double kFahrenheitPerKelvin = 1.8;
constexpr double kFreezing_fahrenheit = 32.0;

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

DisplayUnit DisplayUnitOf(TemperatureUnit unit) {
  switch (unit) {
    case CELSIUS:
      break;
    case FAHRENHEIT:
      return {"\u00B0F", kFahrenheitPerKelvin, kFreezing_fahrenheit};
    case KELVIN:
      return {"K", 1.0, kCelsiusZero_k};
  }
  return {};
}

Result<double> ParseCelsius(std::string_view text) {
  std::string_view number = Trimmed(text);
  DisplayUnit unit;
  if (!number.empty()) {
    const char last = number.back();
    if (last == 'F' || last == 'f') unit = DisplayUnitOf(FAHRENHEIT);
    if (last == 'K' || last == 'k') unit = DisplayUnitOf(KELVIN);
    if (std::string_view("CcFfKk").find(last) != std::string_view::npos) {
      number = Trimmed(number.substr(0, number.size() - 1));
    }
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (number.empty() || error != std::errc() || end != number.data() + number.size() ||
      !std::isfinite(value)) {
    return Err(InvalidArgument(fmt::format(
        "'{}' is no temperature: write a number in \u00B0C, or with F or K behind it", text)));
  }
  const double celsius = (value - unit.offset) / unit.factor;
  if (celsius < -kCelsiusZero_k) {
    return Err(InvalidArgument(fmt::format("'{}' is below absolute zero", text)));
  }
  return celsius;
}

}  // namespace isotherm
