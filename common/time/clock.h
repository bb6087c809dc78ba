#pragma once

#include "common/base/mutex.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Source of time. Injected at the edges of the program, so that nothing inside reads a clock.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual CaptureTime Now() const = 0;
  virtual SteadyTime SteadyNow() const = 0;
};

/// The operating system's clocks. The only reader of them. Thread-safe.
class SystemClock final : public Clock {
 public:
  CaptureTime Now() const override;
  SteadyTime SteadyNow() const override;
};

/// A clock that moves only when told to. Thread-safe.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(CaptureTime start = {}) : now_(start) {}
  CaptureTime Now() const override;
  SteadyTime SteadyNow() const override;
  /// Moves both clocks.
  void Advance(Nanoseconds duration);

 private:
  mutable Mutex mutex_;
  CaptureTime now_ GUARDED_BY(mutex_);
  SteadyTime steady_now_ GUARDED_BY(mutex_){};
};

}  // namespace isotherm
