#pragma once

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <utility>

namespace isotherm {

/// Keeps a process from going away when it is killed: another process traces it, so that nobody
/// else can take its end. The same as when the kernel waits for a device in its name.
class ProcessHolder {
 public:
  explicit ProcessHolder(pid_t pid) {
    int ends[2];
    if (::pipe(ends) != 0) return;
    tracer_ = ::fork();
    if (tracer_ == 0) {
      const char done = ::ptrace(PTRACE_SEIZE, pid, nullptr, nullptr) == 0 ? 1 : 0;
      if (::write(ends[1], &done, 1) == 1) {
        while (true) ::pause();
      }
      ::_exit(1);
    }
    char done = 0;
    holds_ = ::read(ends[0], &done, 1) == 1 && done == 1;
    ::close(ends[0]);
    ::close(ends[1]);
  }
  ~ProcessHolder() { Release(); }
  ProcessHolder(const ProcessHolder&) = delete;
  ProcessHolder& operator=(const ProcessHolder&) = delete;

  /// False: processes may not be traced here.
  bool holds() const { return holds_; }
  void Release() {
    if (tracer_ <= 0) return;
    ::kill(tracer_, SIGKILL);
    ::waitpid(std::exchange(tracer_, -1), nullptr, 0);
  }

 private:
  pid_t tracer_ = -1;
  bool holds_ = false;
};

}  // namespace isotherm
