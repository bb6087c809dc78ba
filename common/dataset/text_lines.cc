#include "common/dataset/text_lines.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "common/base/read_file.h"
#include "common/options/nearest_name.h"

namespace isotherm {
namespace {

constexpr std::string_view kSpace = " \t\r\f\v";
constexpr double kMaxStamp_s = 9.2e9;  // Limit of 64-bit nanoseconds, year 2261.

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

bool AllDigits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

// "123.456" without exponent or sign: exact, which a double is not for stamps since 1970.
bool ParseDecimal(std::string_view word, Nanoseconds& time) {
  // kMaxStamp_s has ten digits before the point; nanoseconds have nine behind it.
  constexpr std::size_t kMaxIntegerDigits = 10;
  constexpr std::size_t kNanoDigits = 9;
  const std::size_t dot = word.find('.');
  const std::string_view integer = word.substr(0, dot);
  const std::string_view fraction = dot == std::string_view::npos ? "" : word.substr(dot + 1);
  if (integer.empty() || integer.size() > kMaxIntegerDigits) return false;
  if (!AllDigits(integer) || !AllDigits(fraction)) return false;
  std::int64_t seconds = 0;
  std::from_chars(integer.data(), integer.data() + integer.size(), seconds);
  std::string digits(fraction.substr(0, kNanoDigits));
  digits.resize(kNanoDigits, '0');
  std::int64_t nanoseconds = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), nanoseconds);
  // Rounded, as a double would be.
  if (fraction.size() > kNanoDigits && fraction[kNanoDigits] >= '5') ++nanoseconds;
  if (static_cast<double>(seconds) > kMaxStamp_s) return false;
  time = std::chrono::seconds(seconds) + Nanoseconds(nanoseconds);
  return true;
}

}  // namespace

Result<std::string> ReadTextFile(const std::filesystem::path& path) {
  Result<std::string> text = ReadFile(path, kMaxTextFileBytes);
  if (text || text.error().code() != StatusCode::kNotFound) return text;
  std::error_code error;
  std::vector<std::string> names;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  return Err(NotFound(
      fmt::format("{}.{}", text.error().message(), DidYouMean(path.filename().string(), names))));
}

std::vector<TextLine> ContentLines(std::string_view text) {
  // Editors on Windows write it.
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<TextLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = Trimmed(text.substr(0, end));
    if (!line.empty() && line.front() != '#') lines.push_back({number, line});
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

std::string_view NextWord(std::string_view& rest) {
  rest = Trimmed(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(kSpace));
  rest = Trimmed(rest.substr(word.size()));
  return word;
}

Result<double> ParseNumber(std::string_view word) {
  // from_chars takes no plus sign, and unlike strtod it never reads a decimal comma by locale.
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    return Err(DataLoss(fmt::format("'{}' is not a number", word)));
  }
  if (!std::isfinite(value)) return Err(DataLoss(fmt::format("'{}' is not finite", word)));
  return value;
}

Result<CaptureTime> ParseStamp(std::string_view word) {
  Nanoseconds exact{};
  if (ParseDecimal(word, exact)) return CaptureTime(exact);
  const Result<double> seconds = ParseNumber(word);
  if (!seconds) {
    return Err(DataLoss(fmt::format("timestamp {}, expected seconds", seconds.error().message())));
  }
  if (*seconds < 0.0) {
    return Err(
        DataLoss(fmt::format("timestamp '{}' is negative; add a constant to all stamps", word)));
  }
  if (*seconds > kMaxStamp_s) {
    return Err(
        DataLoss(fmt::format("timestamp '{}' is beyond year 2261; stamps are in seconds", word)));
  }
  return CaptureTime(FromSeconds(*seconds));
}

std::string FormatStamp(CaptureTime time) {
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  const std::int64_t ns = ToNanoseconds(time);
  const std::uint64_t magnitude =
      // The most negative number has no positive counterpart.
      ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  return fmt::format("{}{}.{:09}", ns < 0 ? "-" : "", magnitude / kPerSecond,
                     magnitude % kPerSecond);
}

std::string At(std::string_view source_name, const TextLine& line) {
  return fmt::format("{}:{}", source_name, line.number);
}

}  // namespace isotherm
