#include "ground/renderer/isotherms.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "ground/options/ground_options.pb.h"
#include "ground/renderer/temperature_unit.h"

namespace isotherm {
namespace {

// As many as a legend has room for.
constexpr int kMaxLines = 32;
constexpr int kMaxBands = 8;

/// One entry of a list, and the colour behind it ("" = none).
struct Entry {
  std::string_view text;
  std::string colour;
};

bool IsBlank(std::string_view text) {
  return text.find_first_not_of(' ') == std::string_view::npos;
}

/// "#rrggbb".
std::optional<Rgb8> ColourOf(std::string_view text) {
  // "#" and three pairs of hexadecimal digits.
  constexpr std::size_t kLength = 7;
  if (text.size() != kLength || text.front() != '#') return std::nullopt;
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + kLength, value, 16);
  if (error != std::errc() || end != text.data() + kLength) return std::nullopt;
  return Rgb8{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
              static_cast<std::uint8_t>(value)};
}

Status NoColour(std::string_view text) {
  return InvalidArgument(
      fmt::format("'{}': a colour is # and six hexadecimal digits, e.g. #ff8000", text));
}

Result<IsothermLine> ToLine(const IsothermOptions& options) {
  if (!std::isfinite(options.celsius()) || !options.has_celsius())
    return Err(InvalidArgument("an isotherm has a temperature, celsius"));
  const std::optional<Rgb8> colour = ColourOf(options.colour());
  if (!colour) return Err(NoColour(options.colour()));
  return IsothermLine{options.celsius(), *colour};
}

Result<TemperatureBand> ToBand(const TemperatureBandOptions& options) {
  TemperatureBand band{-std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity(), std::nullopt};
  if (options.has_min_celsius()) band.from_celsius = options.min_celsius();
  if (options.has_max_celsius()) band.to_celsius = options.max_celsius();
  if ((!options.has_min_celsius() && !options.has_max_celsius()) ||
      !(band.from_celsius < band.to_celsius)) {
    return Err(InvalidArgument(
        fmt::format("'{}..{}': a band goes from a temperature to a higher one",
                    options.has_min_celsius() ? fmt::format("{:g}", band.from_celsius) : "",
                    options.has_max_celsius() ? fmt::format("{:g}", band.to_celsius) : "")));
  }
  if (!options.has_colour()) return band;
  band.colour = ColourOf(options.colour());
  if (!band.colour) return Err(NoColour(options.colour()));
  return band;
}

/// Converts each of a list of options, of which there may be this many.
template <typename Part, typename Options>
Result<std::vector<Part>> ConvertEach(
    const Options& list, int max_count,
    Result<Part> (*convert)(const typename Options::value_type&)) {
  if (list.size() > max_count)
    return Err(InvalidArgument(fmt::format("{} entries, at most {}", list.size(), max_count)));
  std::vector<Part> parts;
  for (const auto& options : list) {
    const Result<Part> part = convert(options);
    if (!part) return Err(part.error());
    parts.push_back(*part);
  }
  return parts;
}

std::string Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

Result<std::vector<Entry>> SplitList(std::string_view text) {
  std::vector<Entry> entries;
  if (IsBlank(text)) return entries;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    more = comma != std::string_view::npos;
    const std::string_view item = text.substr(0, comma);
    const std::size_t hash = item.find('#');
    Entry entry{item.substr(0, hash), {}};
    if (hash != std::string_view::npos) {
      entry.colour = Trimmed(item.substr(hash));
      if (!ColourOf(entry.colour)) return Err(NoColour(item));
    }
    entries.push_back(entry);
    if (more) text.remove_prefix(comma + 1);
  }
  return entries;
}

Status ParseBand(const Entry& entry, TemperatureBandOptions& band) {
  const std::size_t dots = entry.text.find("..");
  if (dots == std::string_view::npos) {
    return InvalidArgument(
        fmt::format("'{}': a band is FROM..TO, e.g. 80..100, 80.. or ..20", entry.text));
  }
  const std::string_view from = entry.text.substr(0, dots);
  const std::string_view to = entry.text.substr(dots + 2);
  if (!IsBlank(from)) {
    const Result<double> celsius = ParseCelsius(from);
    if (!celsius) return celsius.error();
    band.set_min_celsius(*celsius);
  }
  if (!IsBlank(to)) {
    const Result<double> celsius = ParseCelsius(to);
    if (!celsius) return celsius.error();
    band.set_max_celsius(*celsius);
  }
  if (!entry.colour.empty()) band.set_colour(entry.colour);
  return OkStatus();
}

}  // namespace

Result<std::vector<IsothermLine>> IsothermsOf(const RendererOptions& options) {
  return ConvertEach<IsothermLine>(options.isotherm(), kMaxLines, ToLine);
}

Result<std::vector<TemperatureBand>> BandsOf(const RendererOptions& options) {
  return ConvertEach<TemperatureBand>(options.band(), kMaxBands, ToBand);
}

Status ParseIsotherms(std::string_view text, RendererOptions& options) {
  const Result<std::vector<Entry>> entries = SplitList(text);
  if (!entries) return entries.error();
  options.clear_isotherm();
  for (const Entry& entry : *entries) {
    const Result<double> celsius = ParseCelsius(entry.text);
    if (!celsius) return celsius.error();
    IsothermOptions& line = *options.add_isotherm();
    line.set_celsius(*celsius);
    if (!entry.colour.empty()) line.set_colour(entry.colour);
  }
  const auto lines = IsothermsOf(options);
  return lines ? OkStatus() : lines.error();
}

Status ParseBands(std::string_view text, RendererOptions& options) {
  const Result<std::vector<Entry>> entries = SplitList(text);
  if (!entries) return entries.error();
  options.clear_band();
  for (const Entry& entry : *entries)
    ISOTHERM_RETURN_IF_ERROR(ParseBand(entry, *options.add_band()));
  const auto bands = BandsOf(options);
  return bands ? OkStatus() : bands.error();
}

}  // namespace isotherm
