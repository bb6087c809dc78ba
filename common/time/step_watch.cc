#include "common/time/step_watch.h"

namespace isotherm {

ClockReading ReadClocks(const Clock& clock) {
  // The two clocks are read one after the other; of three readings the one that took least was not
  // interrupted in between.
  constexpr int kTries = 3;
  ClockReading best;
  Nanoseconds shortest = Nanoseconds::max();
  for (int i = 0; i < kTries; ++i) {
    const SteadyTime before = clock.SteadyNow();
    const CaptureTime wall = clock.Now();
    const Nanoseconds took = clock.SteadyNow() - before;
    if (took >= shortest) continue;
    shortest = took;
    best = {.wall = wall, .steady = before + took / 2};
  }
  return best;
}

std::optional<Nanoseconds> StepWatch::Observe(const ClockReading& reading) {
  const Nanoseconds step = reading.wall - At(reading.steady) - total_;
  if (std::chrono::abs(step) < kMinStep) {
    agreeing_ = 0;
    return std::nullopt;
  }
  const bool agrees = agreeing_ > 0 && std::chrono::abs(step - suspected_) < kMinStep;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  suspected_ = step;
  if (agreeing_ < kConfirmations) return std::nullopt;
  agreeing_ = 0;
  total_ += step;
  ++steps_;
  return step;
}

}  // namespace isotherm
