#include "common/time/clock.h"

namespace isotherm {

CaptureTime SystemClock::Now() const {
  return CaptureTime(
      std::chrono::duration_cast<Nanoseconds>(std::chrono::system_clock::now().time_since_epoch()));
}

SteadyTime SystemClock::SteadyNow() const { return std::chrono::steady_clock::now(); }

CaptureTime FakeClock::Now() const {
  MutexLock lock(mutex_);
  return now_;
}

SteadyTime FakeClock::SteadyNow() const {
  MutexLock lock(mutex_);
  return steady_now_;
}

void FakeClock::Advance(Nanoseconds duration) {
  MutexLock lock(mutex_);
  now_ += duration;
  steady_now_ += duration;
}

}  // namespace isotherm
