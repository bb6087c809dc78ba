#pragma once

#include <atomic>
#include <cstdint>

#include "common/time/time_types.h"

namespace isotherm {

/// Tells others for how long a thread has been in a call that may never return: a device, a disk,
/// the network. One thread takes steps, any thread asks. Thread-safe.
class StuckWatch {
 public:
  /// One such call.
  class Step {
   public:
    Step(StuckWatch& watch, SteadyTime now) : watch_(watch) {
      watch_.since_ns_ = now.time_since_epoch().count();
    }
    ~Step() { watch_.since_ns_ = kIdle; }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    StuckWatch& watch_;
  };

  /// 0 between steps.
  Nanoseconds BusyFor(SteadyTime now) const {
    const std::int64_t since_ns = since_ns_;
    return since_ns == kIdle ? Nanoseconds(0) : now.time_since_epoch() - Nanoseconds(since_ns);
  }

 private:
  static constexpr std::int64_t kIdle = INT64_MIN;
  std::atomic<std::int64_t> since_ns_{kIdle};
};

}  // namespace isotherm
