#include "common/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/standard_error.h"

namespace isotherm {

ProgressBar::ProgressBar(std::string title, std::uint64_t total, std::string unit)
    : ProgressBar(std::move(title), total, std::move(unit), stderr, isatty(STDERR_FILENO) != 0,
                  [] { return std::chrono::steady_clock::now(); }) {}

ProgressBar::ProgressBar(std::string title, std::uint64_t total, std::string unit, std::FILE* out,
                         bool terminal, SteadyNow now)
    : title_(std::move(title)),
      total_(total),
      unit_(std::move(unit)),
      out_(out),
      terminal_(terminal),
      now_(std::move(now)),
      start_(now_()) {}

ProgressBar::~ProgressBar() {
  if (open_line_) Print("\n");
}

void ProgressBar::Print(const std::string& text) {
  // Progress is not worth waiting for a reader that has stopped reading.
  if (out_ == stderr) return WriteStandardError(text);
  std::fputs(text.c_str(), out_);
  std::fflush(out_);
}

void ProgressBar::Update(double fraction) {
  if (finished_) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int tenth = static_cast<int>(fraction * 10.0);
  if (!terminal_ && tenth == last_tenth_) return;
  last_tenth_ = tenth;
  Show(Line(fraction, false));
}

void ProgressBar::Finish() {
  if (finished_) return;
  finished_ = true;
  Show(Line(1.0, true));
  if (open_line_) Print("\n");
  open_line_ = false;
}

std::string ProgressBar::Line(double fraction, bool finished) const {
  // With title, percent and counts the line stays within 80 columns.
  constexpr int kWidth = 24;
  const auto filled = static_cast<std::size_t>(fraction * kWidth);
  std::string line = fmt::format("{}  [{}{}] {:3.0f} %", title_, std::string(filled, '#'),
                                 std::string(kWidth - filled, '.'), fraction * 100.0);
  if (total_ > 0) {
    const auto done =
        static_cast<std::uint64_t>(std::llround(fraction * static_cast<double>(total_)));
    line += fmt::format("  {}/{} {}", done, total_, unit_);
  }
  const double elapsed_s = ElapsedSeconds();
  // Of the first percent the time that is left cannot be told: starting takes longer than going on.
  constexpr double kTooEarlyToTell = 0.01;
  if (finished) {
    line += fmt::format("  done in {:.1f} s", elapsed_s);
  } else if (fraction > kTooEarlyToTell) {
    line += fmt::format("  {:.0f} s left", elapsed_s * (1.0 - fraction) / fraction);
  }
  return line;
}

double ProgressBar::ElapsedSeconds() const {
  return std::chrono::duration<double>(now_() - start_).count();
}

void ProgressBar::Show(const std::string& line) {
  if (line == shown_) return;
  if (terminal_) {
    constexpr const char* kClearToEnd = "\x1b[K";
    Print(fmt::format("\r{}{}", line, kClearToEnd));
    open_line_ = true;
  } else {
    Print(line + "\n");
  }
  shown_ = line;
}

}  // namespace isotherm
