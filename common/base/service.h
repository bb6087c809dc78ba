#pragma once

#include <signal.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>

namespace isotherm {

/// Tells the service manager the state of a daemon. Without one (NOTIFY_SOCKET unset) each call
/// does nothing. Ready and stopping are said once, and wait for a manager that is busy; the others
/// are said again and again, and are left out meanwhile. Thread-safe.
void NotifyReady(std::string_view status);
/// Returns false if it was left out: who says it only once says it again then.
bool NotifyStatus(std::string_view status);
/// The daemon runs, is alive, and waits for `reason` to pass: ready, with that as its status. To be
/// called again and again meanwhile.
void NotifyWaiting(std::string_view reason);
void NotifyWatchdog();
void NotifyStopping();
/// Asks for `duration` from now before the service manager loses patience while the daemon starts
/// or stops.
void NotifyExtendTimeout(std::chrono::microseconds duration);

/// Returns how often NotifyWatchdog should be called (a third of WatchdogSec); nullopt if the unit
/// has no watchdog.
std::optional<std::chrono::microseconds> WatchdogInterval();

/// From now on a pipe or terminal whose reader is gone makes writing fail instead of ending the
/// process with SIGPIPE.
void IgnoreBrokenPipes();

/// From now on memory is taken in pages of 4 KB only, also by programs that this one starts. With
/// transparent huge pages for all (the kernel's default on Debian) a small daemon holds 2 MB where
/// it needs a few hundred KB.
void UseSmallPages();

/// From now on what one thread frees is there for all. By default most threads have an arena each,
/// and a process holds the sum of what each of them needed most, at whatever time. For programs
/// whose threads take memory seldom; to be called before there are any.
void ShareFreedMemory();

/// Turns SIGTERM, SIGINT and SIGHUP (a terminal or ssh session that is gone; not under nohup) into
/// a stop token, and ignores broken pipes. Create it in main before any other thread, so that all
/// threads inherit the blocked signals. The first signal requests stop; later ones change nothing:
/// the program is already leaving and must not be torn down while it flushes. The signals stay
/// blocked to the end of the process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  /// Requests stop from inside the program.
  void Request() { stop_.request_stop(); }

 private:
  void Wait(const std::stop_token& end);

  const sigset_t signals_;
  std::stop_source stop_;
  std::jthread waiter_;
};

}  // namespace isotherm
