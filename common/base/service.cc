#include "common/base/service.h"

#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "common/base/check.h"
#include "common/base/log.h"

namespace isotherm {
namespace {

sigset_t StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  // nohup asks for SIGHUP to be ignored; sigwait would take it all the same.
  struct sigaction hang_up {};
  const bool is_ignored =
      sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler == SIG_IGN;
  if (!is_ignored) sigaddset(&signals, SIGHUP);
  return signals;
}

std::string_view Reason(int signal) {
  if (signal == SIGINT) return "interrupted";
  return signal == SIGHUP ? "the terminal is gone" : "asked to stop";
}

void Notify(const std::string& state) { static_cast<void>(sd_notify(0, state.c_str())); }

/// The same for what is said again and again: it is left out while the service manager does not
/// read, instead of waiting for it as sd_notify does. Returns false if it was.
bool NotifyUnlessBusy(const std::string& state) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr) return true;
  const std::string_view name(path);
  const bool is_abstract = name.starts_with('@');
  // Another kind of socket is for the library.
  if (!(is_abstract || name.starts_with('/')) || name.size() >= sizeof(address.sun_path)) {
    Notify(state);
    return true;
  }
  name.copy(address.sun_path, name.size());
  if (is_abstract) address.sun_path[0] = '\0';
  const int sender = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (sender < 0) return false;
  const auto size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (is_abstract ? 0 : 1));
  const ssize_t sent = ::sendto(sender, state.data(), state.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), size);
  ::close(sender);
  return sent >= 0;
}

}  // namespace

void NotifyReady(std::string_view status) { Notify("READY=1\nSTATUS=" + std::string(status)); }
bool NotifyStatus(std::string_view status) {
  return NotifyUnlessBusy("STATUS=" + std::string(status));
}
// What is left out of these is said again.
void NotifyWaiting(std::string_view reason) {
  static_cast<void>(NotifyUnlessBusy("READY=1\nWATCHDOG=1\nSTATUS=" + std::string(reason)));
}
void NotifyWatchdog() { static_cast<void>(NotifyUnlessBusy("WATCHDOG=1")); }
void NotifyStopping() { Notify("STOPPING=1"); }
void NotifyExtendTimeout(std::chrono::microseconds duration) {
  static_cast<void>(NotifyUnlessBusy("EXTEND_TIMEOUT_USEC=" + std::to_string(duration.count())));
}

std::optional<std::chrono::microseconds> WatchdogInterval() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) return std::nullopt;
  // One that is left out costs nothing.
  return std::chrono::microseconds(microseconds / 3);
}

void IgnoreBrokenPipes() { CHECK(::signal(SIGPIPE, SIG_IGN) != SIG_ERR); }

void UseSmallPages() {
  // A kernel without huge pages has nothing to be asked for.
  ::prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
}

void ShareFreedMemory() { mallopt(M_ARENA_MAX, 1); }

StopSignal::StopSignal() : signals_(StopSignals()) {
  IgnoreBrokenPipes();
  CHECK(pthread_sigmask(SIG_BLOCK, &signals_, nullptr) == 0);
  waiter_ = std::jthread([this](const std::stop_token& end) { Wait(end); });
}

StopSignal::~StopSignal() {
  waiter_.request_stop();
  // Wakes sigwait. The signal is sent to that thread alone, where it is blocked.
  pthread_kill(waiter_.native_handle(), SIGINT);
  waiter_.join();
  // Signals of its lifetime that nobody took are not for whoever comes next.
  const timespec now{};
  while (sigtimedwait(&signals_, nullptr, &now) > 0) {
  }
}

void StopSignal::Wait(const std::stop_token& end) {
  while (true) {
    int signal = 0;
    if (sigwait(&signals_, &signal) != 0 || end.stop_requested()) return;
    if (!stop_.request_stop()) continue;
    LOG(Service, Info) << Reason(signal) << ", leaving";
  }
}

}  // namespace isotherm
