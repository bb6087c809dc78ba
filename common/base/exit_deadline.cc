#include "common/base/exit_deadline.h"

#include <unistd.h>

#include <algorithm>
#include <future>
#include <stop_token>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"

namespace isotherm {
namespace {

[[noreturn]] void LeaveNow(ExitDeadline::Duration limit, int status, const std::string& what) {
  if (limit > ExitDeadline::Duration::zero()) {
    LOG(Service, Warning) << what << " did not end within "
                          << std::chrono::duration<double>(limit).count()
                          << " s; leaving without it";
  } else {  // The bound over all stages had passed when this one began.
    LOG(Service, Warning) << "no time was left for " << what << "; leaving without it";
  }
  // Not exit(): destructors and atexit handlers may wait for what hangs.
  _exit(status);
}

[[noreturn]] void Leave(ExitDeadline::Duration limit, int status, const std::string& what,
                        const std::function<void()>& last_words) {
  if (last_words) {
    std::packaged_task<void()> saying(last_words);
    const std::future<void> said = saying.get_future();
    // In a thread of their own: standard error may be a pipe that nobody reads.
    std::thread speaker(std::move(saying));
    if (said.wait_for(ExitDeadline::kTimeForLastWords) != std::future_status::ready) {
      LeaveNow(limit, status, what);  // One that hangs is not waited for.
    }
    speaker.join();
  }
  LeaveNow(limit, status, what);
}

}  // namespace

void ExitDeadline::Arm(Duration limit, int status, std::string what,
                       std::function<void()> last_words) {
  const Clock::time_point now = Clock::now();
  const MutexLock lock(mutex_);
  Start({now, now + limit, status, std::move(what), std::move(last_words)});
}

void ExitDeadline::ArmFirst(Duration limit, int status, std::string what,
                            std::function<void()> last_words) {
  const Clock::time_point now = Clock::now();
  const MutexLock lock(mutex_);
  if (!armed_) Start({now, now + limit, status, std::move(what), std::move(last_words)});
}

void ExitDeadline::Bound(Duration total) {
  const MutexLock lock(mutex_);
  if (bound_) return;
  bound_ = Clock::now() + total;
  if (armed_ && armed_->end > *bound_) Wait();
}

void ExitDeadline::Start(Armed armed) {
  armed_ = std::move(armed);
  Wait();
}

void ExitDeadline::Wait() {
  if (bound_) armed_->end = std::min(armed_->end, *bound_);
  // Assigning stops and joins the thread that waited before.
  thread_ = std::jthread([armed = *armed_](const std::stop_token& disarmed) {
    Pause(disarmed, armed.end - Clock::now());
    if (!disarmed.stop_requested())
      Leave(armed.end - armed.begin, armed.status, armed.what, armed.last_words);
  });
}

}  // namespace isotherm
