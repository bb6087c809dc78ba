#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>

namespace isotherm {

/// Shows how far a long job is, on standard error: one line that moves on a terminal, otherwise a
/// line at each full 10 %. With an estimate of the time left. Thread-compatible.
///
///   rendering scan  [##########..........]  50 %  700/1400 frames  12 s left
class ProgressBar {
 public:
  using SteadyNow = std::function<std::chrono::steady_clock::time_point()>;

  /// `total` in `unit` (e.g. 1400 "frames"); 0 shows the percentage only.
  ProgressBar(std::string title, std::uint64_t total, std::string unit);
  /// For tests: where to write, whether it is a terminal, and which clock gives the time left.
  ProgressBar(std::string title, std::uint64_t total, std::string unit, std::FILE* out,
              bool terminal, SteadyNow now);
  /// Ends the line if Finish was not called.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Fraction that is done, 0..1. Cheap to call often: writes only when what is shown changes.
  void Update(double fraction);
  /// Shows 100 % and the time it took.
  void Finish();

 private:
  std::string Line(double fraction, bool finished) const;
  double ElapsedSeconds() const;
  void Show(const std::string& line);
  void Print(const std::string& text);

  const std::string title_;
  const std::uint64_t total_;
  const std::string unit_;
  std::FILE* const out_;
  const bool terminal_;
  const SteadyNow now_;
  const std::chrono::steady_clock::time_point start_;
  std::string shown_;
  int last_tenth_ = -1;
  bool open_line_ = false;
  bool finished_ = false;
};

}  // namespace isotherm
