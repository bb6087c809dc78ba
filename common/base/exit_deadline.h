#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "common/base/mutex.h"

namespace isotherm {

/// Ends the process when leaving takes too long, for instance because a library cannot be torn down
/// (the middleware, while its network interface is down) or a disk does not answer. Nothing happens
/// before it is armed and after its own end. Thread-safe.
class ExitDeadline {
 public:
  using Duration = std::chrono::nanoseconds;

  ExitDeadline() = default;
  ExitDeadline(const ExitDeadline&) = delete;
  ExitDeadline& operator=(const ExitDeadline&) = delete;

  /// The process has `limit` left from now on, instead of what it had before. After that
  /// `last_words` is called if there is one, `what` is named in the log, and the process ends with
  /// `status` as it is, without destructors. Last words that do not end, because nobody reads them
  /// or what they tell of is stuck itself, are cut short.
  void Arm(Duration limit, int status, std::string what, std::function<void()> last_words = {});
  /// The same, but what is armed already stays as it is: for a signal that may come at any time.
  void ArmFirst(Duration limit, int status, std::string what,
                std::function<void()> last_words = {});

 private:
  void Start(Duration limit, int status, std::string what, std::function<void()> last_words)
      REQUIRES(mutex_);

  Mutex mutex_;
  std::jthread thread_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
