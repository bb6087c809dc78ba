#pragma once

#include <algorithm>
#include <atomic>

#include "common/time/time_types.h"

namespace isotherm {

/// Holds what a watchdog needs to know of a thread: for how long it has been at the same piece of
/// work. A thread that waits for another one is idle, the other's own progress tells. Thread-safe.
class ThreadProgress {
 public:
  /// One piece of work, for instance a call of a device, a disk or the network that may never
  /// return.
  class Work {
   public:
    Work(ThreadProgress& progress, SteadyTime now) : progress_(progress) { progress_.Busy(now); }
    ~Work() { progress_.Idle(); }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

   private:
    ThreadProgress& progress_;
  };

  /// The thread begins a piece of work, or goes on with it.
  void Busy(SteadyTime now) { since_.store(now, std::memory_order_relaxed); }
  /// The thread waits for work, or has ended.
  void Idle() { since_.store(kIdle, std::memory_order_relaxed); }
  /// 0 while the thread is idle.
  Nanoseconds AtItFor(SteadyTime now) const {
    const SteadyTime since = since_.load(std::memory_order_relaxed);
    return since == kIdle ? Nanoseconds(0) : std::max(Nanoseconds(0), Nanoseconds(now - since));
  }

 private:
  static constexpr SteadyTime kIdle = SteadyTime::max();
  std::atomic<SteadyTime> since_{kIdle};
};

}  // namespace isotherm
