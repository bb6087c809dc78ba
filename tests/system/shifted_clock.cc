// Preloaded into a program, shows it a wall clock that is wrong: CLOCK_SHIFT_MS milliseconds ahead,
// from when the file CLOCK_SHIFT_WHEN exists (from the start, if none is named). The monotonic
// clock stays. CLOCK_STATE=synchronised or =free says what the kernel tells of the clock's
// discipline.
#include <dlfcn.h>
#include <sys/timex.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string_view>

namespace {

constexpr long kNsPerS = 1'000'000'000;
constexpr long kNsPerMs = 1'000'000;

using Function = int (*)(clockid_t, timespec*);

Function Real() {
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  return real;
}

bool IsTime() {
  static const char* const when = std::getenv("CLOCK_SHIFT_WHEN");
  static std::atomic<bool> is_time{when == nullptr};
  if (!is_time && access(when, F_OK) == 0) is_time = true;
  return is_time;
}

long ShiftMs() {
  static const char* const text = std::getenv("CLOCK_SHIFT_MS");
  static const long shift_ms = text == nullptr ? 0 : std::atol(text);
  return IsTime() ? shift_ms : 0;
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

extern "C" int adjtimex(timex* answer) noexcept {
  static const char* const state = std::getenv("CLOCK_STATE");
  if (state == nullptr) {
    static const auto real = reinterpret_cast<int (*)(timex*)>(dlsym(RTLD_NEXT, "adjtimex"));
    return real(answer);
  }
  *answer = {};
  answer->esterror = 250;
  answer->maxerror = 900;
  if (std::string_view(state) == "synchronised") return TIME_OK;
  answer->status = STA_UNSYNC;
  return TIME_ERROR;
}
