#include "common/base/pause.h"

#include <condition_variable>
#include <mutex>

namespace isotherm {

void Pause(const std::stop_token& stop, std::chrono::nanoseconds duration) {
  if (duration <= std::chrono::nanoseconds(0)) return;
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
}

}  // namespace isotherm
