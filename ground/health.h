#pragma once

#include <optional>
#include <string>

#include "common/time/thread_progress.h"

namespace isotherm {

/// Where the service's threads are with their work. Thread-safe.
class Health {
 public:
  /// A thread that writes to the disk may be at one piece of work for `disk_limit`.
  explicit Health(Nanoseconds disk_limit) : disk_limit_(disk_limit) {}

  /// No single frame takes this long.
  static constexpr Nanoseconds kFrameLimit = std::chrono::seconds(10);

  ThreadProgress receive;
  ThreadProgress reconstruction;
  ThreadProgress recording;
  ThreadProgress results;

  /// Returns what is stuck, in words; nullopt if everything goes on. The service manager's watchdog
  /// is fed only then.
  std::optional<std::string> Problem(SteadyTime now) const;

 private:
  const Nanoseconds disk_limit_;
};

}  // namespace isotherm
