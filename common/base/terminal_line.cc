#include "common/base/terminal_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "common/base/standard_error.h"

namespace isotherm {
namespace {

bool ContinuesCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Characters of a UTF-8 text.
std::size_t Columns(std::string_view text) {
  return text.size() - static_cast<std::size_t>(std::ranges::count_if(text, ContinuesCharacter));
}

std::string_view FirstColumns(std::string_view text, std::size_t columns) {
  std::size_t end = 0;
  for (std::size_t seen = 0; end < text.size(); ++end) {
    if (!ContinuesCharacter(text[end]) && seen++ == columns) break;
  }
  return text.substr(0, end);
}

/// The width of standard error's terminal; a line that wraps cannot be overwritten.
std::size_t TerminalColumns() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1U : std::numeric_limits<std::size_t>::max();
}

}  // namespace

std::string FitLine(std::span<const std::string> parts, std::string_view separator,
                    std::size_t columns) {
  if (parts.empty()) return {};
  std::string line(FirstColumns(parts.front(), columns));
  for (const std::string& part : parts.subspan(1)) {
    if (Columns(line) + Columns(separator) + Columns(part) <= columns)
      line.append(separator).append(part);
  }
  return line;
}

TerminalLine::TerminalLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

TerminalLine::~TerminalLine() {
  if (shown_) WriteStandardError("\n");
}

void TerminalLine::Show(std::span<const std::string> parts, std::string_view separator) {
  if (!terminal_) return;
  shown_ = true;
  WriteStandardError("\033[2K" + FitLine(parts, separator, TerminalColumns()) + "\r");
}

}  // namespace isotherm
