#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace isotherm {

/// Joins `parts`, the most important first, by `separator` and keeps to `columns`: a part that does
/// not fit is left out. Only a first part that is too long is cut.
std::string FitLine(std::span<const std::string> parts, std::string_view separator,
                    std::size_t columns);

/// One line of standard error that is written again and again in place, on a terminal.
/// Thread-compatible.
class TerminalLine {
 public:
  /// Looks whether standard error is a terminal.
  TerminalLine();
  /// Puts the cursor behind the line.
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  bool is_terminal() const { return terminal_; }
  /// Replaces the line by what fits into the terminal's width. Does nothing elsewhere. The cursor
  /// stays at the start, so that a log line covers it.
  void Show(std::span<const std::string> parts, std::string_view separator);

 private:
  const bool terminal_;
  bool shown_ = false;
};

}  // namespace isotherm
