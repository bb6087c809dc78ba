#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/time/time_types.h"

namespace isotherm {

/// One line with content: comments (`#` to the end), blank lines, carriage returns and a byte order
/// mark are gone.
struct TextLine {
  int number = 0;  ///< From 1.
  std::string_view text;
};

/// The most that is read of a list: poses at 1 kHz for half an hour.
inline constexpr std::uint64_t kMaxTextFileBytes = 256U << 20;

/// The file's content, up to kMaxTextFileBytes. If it is missing, the message names the most
/// similar file beside it.
Result<std::string> ReadTextFile(const std::filesystem::path& path);

/// Views into `text`. A `#` starts a comment only at the start of a line, so that file names may
/// contain it.
std::vector<TextLine> ContentLines(std::string_view text);

/// Cuts the first word (up to white space) off `rest`; empty at the end.
std::string_view NextWord(std::string_view& rest);

/// Finite number, whole word, independent of the locale.
Result<double> ParseNumber(std::string_view word);

/// Seconds as a decimal number, not negative, exact to the nanosecond.
Result<CaptureTime> ParseStamp(std::string_view word);

/// Seconds with the nine decimals of `time`.
std::string FormatStamp(CaptureTime time);

/// "file:line".
std::string At(std::string_view source_name, const TextLine& line);

}  // namespace isotherm
