#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "tests/support/process.h"

namespace isotherm::system_test {

/// Measures how long the threads of a process stand ready while others have the processors, from
/// its construction on, by the kernel's count. In each look the thread that waited longest counts,
/// since the others wait at the same time. A process that sleeps, hangs or computes does not wait.
/// Thread-compatible.
class ProcessorWait {
 public:
  explicit ProcessorWait(pid_t pid);

  /// Adds what was waited since the last look. A thread's last waiting before its end may be
  /// missed.
  void Look();
  Seconds total() const { return total_; }

 private:
  using Nanoseconds = std::uint64_t;
  std::map<pid_t, Nanoseconds> Read() const;

  const pid_t pid_;
  std::map<pid_t, Nanoseconds> before_;
  Seconds total_{};
};

/// Edge and ground promise to leave within this after SIGTERM, SIGINT and SIGHUP, while cameras and
/// disk answer (docs/architecture.md).
inline constexpr Seconds kTimeToLeave{2.0};

/// Says how a program left that was told to.
struct Departure {
  std::optional<ExitStatus> status;  ///< nullopt: it still runs.
  Seconds took{};                    ///< Time from the signal to the end of the process.
  Seconds waited{};                  ///< Part of it for which others had the processors.

  /// The time that the program is answerable for, which a promise is about.
  Seconds own() const { return took - waited; }
  std::string ToText() const;
};

/// Sends `signal` and waits for the end, for `patience` at most.
Departure Leave(Process& program, int signal, Seconds patience);

}  // namespace isotherm::system_test
