#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/time/thread_progress.h"

namespace isotherm {

/// A thread of the service whose end is waited for.
enum class GroundThread : std::uint8_t { kReception, kReconstruction, kResults, kRecording };

/// Knows where the service's threads are with their work. Thread-safe.
class Health {
 public:
  /// A thread that writes to the disk may be at one piece of work for `disk_limit`.
  explicit Health(Nanoseconds disk_limit) : disk_limit_(disk_limit) {}

  /// No single frame takes this long.
  static constexpr Nanoseconds kFrameLimit = std::chrono::seconds(10);

  ThreadProgress receive;
  ThreadProgress reconstruction;
  ThreadProgress reading;  ///< The same thread, while it reads an earlier recording.
  ThreadProgress recording;
  ThreadProgress results;

  /// Returns what is stuck, in words; nullopt if everything goes on. The service manager's watchdog
  /// is fed only then.
  std::optional<std::string> Problem(SteadyTime now) const;
  /// The thread that keeps `awaited` from its end and is stuck; nullopt while all that it needs
  /// goes on. What others are stuck at does not count.
  std::optional<GroundThread> StuckBeforeEnd(GroundThread awaited, SteadyTime now) const;

 private:
  const Nanoseconds disk_limit_;
};

}  // namespace isotherm
