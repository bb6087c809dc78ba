#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "tests/support/process.h"

namespace isotherm::system_test {

/// A pipe for what a program says, of which the test has both ends. Thread-compatible.
class OutputPipe {
 public:
  /// Makes it inside `folder`.
  explicit OutputPipe(const std::filesystem::path& folder) : path_(folder / "output") {
    CHECK(mkfifo(path_.c_str(), 0600) == 0);
    reader_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    writer_ = open(path_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    CHECK(reader_ >= 0 && writer_ >= 0);
  }
  ~OutputPipe() { CloseAll(); }
  OutputPipe(const OutputPipe&) = delete;
  OutputPipe& operator=(const OutputPipe&) = delete;

  /// The reader is gone, once a program has it.
  void CloseAll() {
    for (int* end : {&reader_, &writer_}) {
      if (*end >= 0) close(std::exchange(*end, -1));
    }
  }
  /// Until nothing more fits: its reader does not read.
  void Fill() const {
    const std::string page(4096, 'x');
    while (write(writer_, page.data(), page.size()) > 0) {
    }
  }
  /// The command with its standard error ("2") or standard output ("1") into the pipe.
  Command From(Command command, const std::string& descriptor = "2") const {
    const std::string script = "exec \"$0\" \"$@\" " + descriptor + ">" + path_.string();
    command.arguments.insert(command.arguments.begin(), {"-c", script, command.program});
    command.program = "/bin/sh";
    return command;
  }

 private:
  const std::filesystem::path path_;
  int reader_ = -1;
  int writer_ = -1;
};

}  // namespace isotherm::system_test
