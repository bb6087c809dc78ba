#include "common/base/exit_deadline.h"

#include <unistd.h>

#include <condition_variable>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "common/base/log.h"

namespace isotherm {
namespace {

// Enough for some lines to anybody who reads them.
constexpr std::chrono::milliseconds kTimeForLastWords{300};

[[noreturn]] void LeaveNow(ExitDeadline::Duration limit, int status, const std::string& what) {
  LOG(Service, Warning) << what << " did not end within "
                        << std::chrono::duration<double>(limit).count() << " s; leaving without it";
  _exit(status);
}

[[noreturn]] void Leave(ExitDeadline::Duration limit, int status, const std::string& what,
                        const std::function<void()>& last_words) {
  if (last_words) {
    std::packaged_task<void()> saying(last_words);
    const std::future<void> said = saying.get_future();
    std::thread speaker(std::move(saying));
    if (said.wait_for(kTimeForLastWords) != std::future_status::ready) {
      LeaveNow(limit, status, what);  // One that hangs is not waited for.
    }
    speaker.join();
  }
  LeaveNow(limit, status, what);
}

}  // namespace

void ExitDeadline::Arm(Duration limit, int status, std::string what,
                       std::function<void()> last_words) {
  const MutexLock lock(mutex_);
  Start(limit, status, std::move(what), std::move(last_words));
}

void ExitDeadline::ArmFirst(Duration limit, int status, std::string what,
                            std::function<void()> last_words) {
  const MutexLock lock(mutex_);
  if (!thread_.joinable()) Start(limit, status, std::move(what), std::move(last_words));
}

void ExitDeadline::Start(Duration limit, int status, std::string what,
                         std::function<void()> last_words) {
  thread_ = std::jthread([limit, status, what = std::move(what),
                          last_words = std::move(last_words)](const std::stop_token& disarmed) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, disarmed, limit, [] { return false; });
    if (!disarmed.stop_requested()) Leave(limit, status, what, last_words);
  });
}

}  // namespace isotherm
