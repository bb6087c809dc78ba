#include "common/base/exit_deadline.h"

#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <utility>

#include "common/base/log.h"

namespace isotherm {

void ExitDeadline::Arm(Duration limit, int status, std::string what,
                       std::function<void()> last_words) {
  thread_ = std::jthread([limit, status, what = std::move(what),
                          last_words = std::move(last_words)](const std::stop_token& disarmed) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, disarmed, limit, [] { return false; });
    if (disarmed.stop_requested()) return;
    if (last_words) last_words();
    LOG(Service, Warning) << what << " did not end within "
                          << std::chrono::duration<double>(limit).count()
                          << " s; leaving without it";
    _exit(status);
  });
}

}  // namespace isotherm
