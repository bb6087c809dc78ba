#pragma once

#include <chrono>
#include <optional>

namespace isotherm {

/// Gives memory that was freed back to the kernel now and then. The allocator keeps what it once
/// needed, and a process that runs for days would hold what it took while a disk or a link stood
/// still for a moment. Thread-compatible.
class FreedMemory {
 public:
  /// Does nothing until ten seconds have passed since the first call or the last time: pages that
  /// are needed soon after fault in again. Takes some milliseconds, in which other threads may have
  /// to wait for memory.
  void GiveBackIfDue(std::chrono::steady_clock::time_point now);

 private:
  std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace isotherm
