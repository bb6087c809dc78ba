#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// A program that runs beside this one, its output in a log file. Ends with this object: SIGTERM,
/// after five seconds SIGKILL. Gets SIGTERM also when the thread that started it ends, for instance
/// because this program is killed. Thread-compatible.
class ChildProcess {
 public:
  /// `program` is a path; signals that this process blocks are not blocked in the child.
  static Result<ChildProcess> Start(const std::filesystem::path& program,
                                    const std::vector<std::string>& arguments,
                                    const std::filesystem::path& log);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// The exit status once it has ended (128 + signal if a signal ended it); nullopt while it runs.
  std::optional<int> Poll();
  /// Asks it to leave.
  void Terminate();
  const std::filesystem::path& log() const { return log_; }

 private:
  ChildProcess(pid_t pid, std::filesystem::path log) : pid_(pid), log_(std::move(log)) {}

  pid_t pid_ = -1;
  std::filesystem::path log_;
  std::optional<int> status_;
};

/// The program `name` in the folder of the running program.
Result<std::filesystem::path> NeighbourProgram(const std::string& name);

/// The last lines of a log, for messages.
std::string LastLines(const std::filesystem::path& log, std::size_t count);

}  // namespace isotherm
