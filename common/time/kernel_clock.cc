#include "common/time/kernel_clock.h"

#include <sys/timex.h>

namespace isotherm {

KernelClock ReadKernelClock() {
  timex answer{};
  const int state = adjtimex(&answer);
  return Interpret(answer, state);
}

KernelClock Interpret(const timex& answer, int state) {
  KernelClock clock;
  if (state == -1 || state == TIME_ERROR || (answer.status & STA_UNSYNC) != 0) return clock;
  const double unit_s = (answer.status & STA_NANO) != 0 ? 1e-9 : 1e-6;
  clock.synchronised = true;
  clock.offset_s = static_cast<double>(answer.offset) * unit_s;
  clock.estimated_error_s = static_cast<double>(answer.esterror) * 1e-6;
  clock.max_error_s = static_cast<double>(answer.maxerror) * 1e-6;
  return clock;
}

}  // namespace isotherm
