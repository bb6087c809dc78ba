#include "ground/cli/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "common/dataset/text_lines.h"

namespace isotherm {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};

constexpr std::array kLengths = {Unit{"µm", 1e-6}, Unit{"um", 1e-6}, Unit{"mm", 1e-3},
                                 Unit{"cm", 1e-2}, Unit{"m", 1.0}};
constexpr std::array kErrors = {Unit{"%", 0.01}, Unit{"K", 1.0}};

std::string_view WithoutSpaceAtTheEnd(std::string_view text) {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

struct Quantity {
  double value;  ///< In the base unit.
  std::string_view unit;
};

Result<Quantity> ParseQuantity(std::string_view text, std::span<const Unit> units,
                               std::string_view option, std::string_view example) {
  const std::string_view trimmed = WithoutSpaceAtTheEnd(text);
  const auto unit =
      std::ranges::find_if(units, [&](const Unit& u) { return trimmed.ends_with(u.name); });
  if (unit == units.end()) {
    return Err(InvalidArgument(
        fmt::format("{}: '{}' has no unit, expected for example {}", option, text, example)));
  }
  const Result<double> number =
      ParseNumber(WithoutSpaceAtTheEnd(trimmed.substr(0, trimmed.size() - unit->name.size())));
  if (!number || !(*number > 0.0)) {
    return Err(
        InvalidArgument(fmt::format("{}: '{}' is not a positive quantity, expected for "
                                    "example {}",
                                    option, text, example)));
  }
  return Quantity{*number * unit->factor, unit->name};
}

}  // namespace

Result<double> ParseLength(std::string_view text, std::string_view option) {
  const auto quantity = ParseQuantity(text, kLengths, option, "10mm");
  if (!quantity) return Err(quantity.error());
  return quantity->value;
}

Result<ErrorTolerance> ParseTolerance(std::string_view text, std::string_view option) {
  const auto quantity = ParseQuantity(text, kErrors, option, "2% or 1.5K");
  if (!quantity) return Err(quantity.error());
  return ErrorTolerance{quantity->value, quantity->unit == "K"};
}

}  // namespace isotherm
