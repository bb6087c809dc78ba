#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace isotherm::system_test {

/// A computer of its own: a copy of this one's system, kept in memory, with none of its settings of
/// /etc/systemd, booted by systemd-nspawn without a network. It starts nothing but what systemd
/// itself needs.
///
/// Its file systems exist for this process only, and it is killed with this process: nothing is
/// left behind, however the test ends. Needs root. Thread-compatible; create it in the main thread.
class Container {
 public:
  /// Makes the copy; `Boot` starts it. `folder` is created where there is none, and stays empty for
  /// everybody else.
  explicit Container(std::filesystem::path folder);
  ~Container();
  Container(const Container&) = delete;
  Container& operator=(const Container&) = delete;

  /// Why there is no container here; nullopt if it runs.
  std::optional<std::string> Boot();

  /// Its root, to put files into and read them.
  std::filesystem::path root() const { return folder_ / "root"; }
  /// Runs a program inside, as root.
  Finished Run(const std::vector<std::string>& command, Seconds timeout = Seconds(30)) const;
  /// The same for a line of shell; its output without the last line end.
  std::string Output(const std::string& shell_line, Seconds timeout = Seconds(30)) const;

 private:
  std::optional<std::string> MakeRoot();
  std::optional<std::string> WaitForBoot();

  std::filesystem::path folder_;
  std::filesystem::path
      cgroup_;  ///< A control group of its own, so that containers of other tests are not met.
  std::optional<std::string> obstacle_;
  std::unique_ptr<Process> nspawn_;
  pid_t init_ = -1;
};

}  // namespace isotherm::system_test
