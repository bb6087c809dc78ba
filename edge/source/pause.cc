#include "edge/source/pause.h"

#include <condition_variable>
#include <mutex>

namespace isotherm {

void Pause(const std::stop_token& stop, Nanoseconds duration) {
  if (duration <= Nanoseconds(0)) return;
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
}

}  // namespace isotherm
