// Preloaded into a program, shows it a wall clock that is wrong: CLOCK_SHIFT_MS milliseconds ahead,
// from CLOCK_SHIFT_AFTER_S seconds after the first look on. The monotonic clock stays.
#include <dlfcn.h>
#include <time.h>

#include <cstdlib>

namespace {

constexpr long kNsPerS = 1'000'000'000;
constexpr long kNsPerMs = 1'000'000;

using Function = int (*)(clockid_t, timespec*);

Function Real() {
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  return real;
}

long FromEnvironment(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::atol(text);
}

double MonotonicSeconds() {
  timespec now{};
  Real()(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

long ShiftMs() {
  static const long shift_ms = FromEnvironment("CLOCK_SHIFT_MS");
  static const double from_s =
      MonotonicSeconds() + static_cast<double>(FromEnvironment("CLOCK_SHIFT_AFTER_S"));
  return MonotonicSeconds() >= from_s ? shift_ms : 0;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  const int result = Real()(clock, time);
  if (result != 0 || (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE)) return result;
  const long shift_ms = ShiftMs();
  time->tv_sec += shift_ms / 1000;
  time->tv_nsec += shift_ms % 1000 * kNsPerMs;
  if (time->tv_nsec >= kNsPerS) {
    ++time->tv_sec;
    time->tv_nsec -= kNsPerS;
  } else if (time->tv_nsec < 0) {
    --time->tv_sec;
    time->tv_nsec += kNsPerS;
  }
  return result;
}
