#pragma once

#include <sys/types.h>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "common/base/mutex.h"

namespace isotherm::system_test {

using Seconds = std::chrono::duration<double>;

/// Holds what a child process is started with.
struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::vector<std::string> environment;  ///< "NAME=value", on top of this process's own.
  std::filesystem::path output_file =
      {};  ///< Standard output goes here instead of being collected.
};

/// Returns the command that has the system's shell run `script`.
inline Command Shell(const std::string& script) { return {"/bin/sh", {"-c", script}, {}}; }

/// How a child ended: exit status, or 128 + signal number as a shell would say.
using ExitStatus = int;

/// A running program whose standard output and error are collected. Killed at the end of its life
/// if it still runs. Thread-compatible.
class Process {
 public:
  /// Aborts the test program if `command.program` cannot be started at all.
  explicit Process(const Command& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Signal(int signal) const;
  /// True as soon as the program has ended, false if it still runs after `timeout`.
  bool HasEnded(Seconds timeout) const;
  /// The exit status, or nullopt if the program still runs after `timeout`.
  std::optional<ExitStatus> WaitForExit(Seconds timeout);
  /// True as soon as `text` has appeared in the output this many times, false if it has not within
  /// `timeout` or never will.
  bool WaitForOutput(std::string_view text, Seconds timeout, int times = 1);
  /// Everything written so far; everything at all once WaitForExit has returned a status.
  std::string output() const;
  pid_t pid() const { return pid_; }

 private:
  void Drain(int pipe);

  pid_t pid_ = -1;
  int pidfd_ = -1;
  std::optional<ExitStatus> exit_status_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::string output_ GUARDED_BY(mutex_);
  bool output_ended_ GUARDED_BY(mutex_) = false;
  std::jthread reader_;
};

/// Processes that `pid` has started and that still run.
std::vector<pid_t> ChildrenOf(pid_t pid);
/// The program's arguments, each ended by a zero; empty if there is no such process.
std::string CommandLineOf(pid_t pid);

/// A program that has ended.
struct Finished {
  ExitStatus status = -1;
  std::string output;
};

/// Runs a program to its end; a status of -1 says that it was still running after `timeout` and was
/// killed.
Finished RunToEnd(const Command& command, Seconds timeout);

/// Holds what the service manager would see of a daemon: the messages of its notify socket.
/// Thread-compatible.
class NotifySocket {
 public:
  /// Creates the socket inside `folder`.
  explicit NotifySocket(const std::filesystem::path& folder);
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// "NOTIFY_SOCKET=..." for Command::environment.
  std::string environment() const { return "NOTIFY_SOCKET=" + path_.string(); }
  /// True as soon as a message with the line `line` (e.g. "READY=1") has come, false after
  /// `timeout`.
  bool WaitFor(std::string_view line, Seconds timeout);
  /// Forgets what came until now: it is not waited for any more.
  void Forget();
  /// Takes what has come, so that the sender is not held up: the socket keeps ten messages.
  void Drain();
  /// Returns what has come since, a line per message and variable.
  const std::string& received() const { return received_; }

  /// The same for a message that contains `text` anywhere.
  bool WaitForText(std::string_view text, Seconds timeout);
  /// Listens for `duration`: the longest time in it without the line `line`.
  Seconds LongestSilence(std::string_view line, Seconds duration);
  /// True as soon as the line `line` has not come for `silence`, false if it still comes after
  /// `timeout`.
  bool WaitForSilence(std::string_view line, Seconds silence, Seconds timeout);

 private:
  /// The next message between line ends; empty if none comes within `timeout`.
  std::string Receive(Seconds timeout);

  std::filesystem::path path_;
  int socket_ = -1;
  std::string received_ = "\n";
};

}  // namespace isotherm::system_test
