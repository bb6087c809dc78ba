#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "common/base/mutex.h"

namespace isotherm {

/// Ends the process when leaving takes too long, for instance because a library cannot be torn down
/// (the middleware, while its network interface is down) or a disk does not answer. Nothing happens
/// before it is armed and after its own end. What is left behind in stages, each with a deadline of
/// its own, cannot add up to more than one bound over all of them. Thread-safe.
class ExitDeadline {
 public:
  using Duration = std::chrono::nanoseconds;

  /// Enough for some lines to anybody who reads them; on top of a deadline.
  static constexpr std::chrono::milliseconds kTimeForLastWords{300};

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

  /// The process has `total` left from now on, whatever is armed already or later: a deadline
  /// beyond it is moved up to it. The first bound counts. Nothing happens before something is
  /// armed.
  void Bound(Duration total);

 private:
  using Clock = std::chrono::steady_clock;
  /// Holds what a deadline was armed with: its time span, the exit status and whom to name if it
  /// passes.
  struct Armed {
    Clock::time_point begin, end;
    int status = 0;
    std::string what;
    std::function<void()> last_words;
  };
  void Start(Armed armed) REQUIRES(mutex_);
  /// Begins to wait for what is armed, within the bound.
  void Wait() REQUIRES(mutex_);

  Mutex mutex_;
  std::optional<Clock::time_point> bound_ GUARDED_BY(mutex_);
  std::optional<Armed> armed_ GUARDED_BY(mutex_);
  std::jthread thread_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
