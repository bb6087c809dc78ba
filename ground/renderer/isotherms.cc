#include "ground/renderer/isotherms.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "ground/renderer/temperature_unit.h"

namespace isotherm {
namespace {

// As many as a legend has room for.
constexpr std::size_t kMaxLines = 32;
constexpr std::size_t kMaxBands = 8;
constexpr Rgb8 kLineColour{255, 255, 255};

/// One entry of a list, and the colour behind it.
struct Entry {
  std::string_view text;
  std::optional<Rgb8> colour;
};

bool IsBlank(std::string_view text) {
  return text.find_first_not_of(' ') == std::string_view::npos;
}

/// "rrggbb", blanks around it.
std::optional<Rgb8> ParseColour(std::string_view text) {
  constexpr std::size_t kDigits = 6;
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(' ') - first + 1);
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.size() != kDigits || error != std::errc() || end != text.data() + kDigits) {
    return std::nullopt;
  }
  return Rgb8{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
              static_cast<std::uint8_t>(value)};
}

Result<std::vector<Entry>> SplitList(std::string_view text, std::size_t most) {
  std::vector<Entry> entries;
  if (IsBlank(text)) return entries;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    more = comma != std::string_view::npos;
    const std::string_view item = text.substr(0, comma);
    const std::size_t hash = item.find('#');
    Entry entry{item.substr(0, hash), std::nullopt};
    if (hash != std::string_view::npos) {
      entry.colour = ParseColour(item.substr(hash + 1));
      if (!entry.colour) {
        return Err(InvalidArgument(
            fmt::format("'{}': a colour is # and six hexadecimal digits, e.g. #ff8000", item)));
      }
    }
    entries.push_back(entry);
    if (more) text.remove_prefix(comma + 1);
  }
  if (entries.size() > most) {
    return Err(InvalidArgument(fmt::format("{} entries, at most {}", entries.size(), most)));
  }
  return entries;
}

Result<TemperatureBand> ParseBand(const Entry& entry) {
  const std::size_t dots = entry.text.find("..");
  if (dots == std::string_view::npos) {
    return Err(InvalidArgument(
        fmt::format("'{}': a band is FROM..TO, e.g. 80..100, 80.. or ..20", entry.text)));
  }
  TemperatureBand band{-std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity(), entry.colour};
  const std::string_view from = entry.text.substr(0, dots);
  const std::string_view to = entry.text.substr(dots + 2);
  if (!IsBlank(from)) {
    const Result<double> celsius = ParseCelsius(from);
    if (!celsius) return Err(celsius.error());
    band.from_celsius = *celsius;
  }
  if (!IsBlank(to)) {
    const Result<double> celsius = ParseCelsius(to);
    if (!celsius) return Err(celsius.error());
    band.to_celsius = *celsius;
  }
  if ((IsBlank(from) && IsBlank(to)) || band.from_celsius >= band.to_celsius) {
    return Err(InvalidArgument(
        fmt::format("'{}': a band goes from a temperature to a higher one", entry.text)));
  }
  return band;
}

}  // namespace

Result<std::vector<IsothermLine>> ParseIsotherms(std::string_view text) {
  const Result<std::vector<Entry>> entries = SplitList(text, kMaxLines);
  if (!entries) return Err(entries.error());
  std::vector<IsothermLine> lines;
  for (const Entry& entry : *entries) {
    const Result<double> celsius = ParseCelsius(entry.text);
    if (!celsius) return Err(celsius.error());
    lines.push_back({*celsius, entry.colour.value_or(kLineColour)});
  }
  return lines;
}

Result<std::vector<TemperatureBand>> ParseBands(std::string_view text) {
  const Result<std::vector<Entry>> entries = SplitList(text, kMaxBands);
  if (!entries) return Err(entries.error());
  std::vector<TemperatureBand> bands;
  for (const Entry& entry : *entries) {
    const Result<TemperatureBand> band = ParseBand(entry);
    if (!band) return Err(band.error());
    bands.push_back(*band);
  }
  return bands;
}

}  // namespace isotherm
