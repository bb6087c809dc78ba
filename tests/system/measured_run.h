#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/programs.h"

namespace isotherm::system_test {

/// A program may take this for a file: memory, and processor time by the size of the file. The time
/// that starting and a file of no size take is on top, for a busy machine.
inline constexpr long kMaxMemoryKilobytes = 256 * 1024;
inline constexpr double kSecondsPerMegabyte = 1.0;
inline constexpr double kSecondsForNothing = 4.0;

struct Measured {
  int status = -1;
  long peak_kilobytes = 0;
  double processor_s = 0.0;
  std::string output;
};

/// Runs the tool. A processor time of a minute ends it.
inline Measured RunMeasured(std::vector<std::string> arguments,
                            const std::filesystem::path& output) {
  arguments.insert(arguments.begin(), Tool());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    const rlimit minute{.rlim_cur = 60, .rlim_max = 60};
    setrlimit(RLIMIT_CPU, &minute);
    execv(argv[0], argv.data());
    _exit(127);
  }
  Measured measured;
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child) return measured;
  measured.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  measured.peak_kilobytes = usage.ru_maxrss;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  measured.processor_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  std::ifstream file(output, std::ios::binary);
  measured.output.assign(std::istreambuf_iterator<char>(file), {});
  return measured;
}

/// It has not crashed, and needed no more than the size of its input justifies.
inline void ExpectModest(const Measured& run, const std::string& command, std::uintmax_t bytes) {
  const double allowed_s =
      kSecondsForNothing + kSecondsPerMegabyte * 1e-6 * static_cast<double>(bytes);
  std::printf("%s: %ju bytes, peak %ld kB, %.2f s, status %d\n", command.c_str(), bytes,
              run.peak_kilobytes, run.processor_s, run.status);
  EXPECT_LT(run.status, 126) << run.output;
  EXPECT_LT(run.peak_kilobytes, kMaxMemoryKilobytes) << command;
  EXPECT_LT(run.processor_s, allowed_s) << command << " of " << bytes << " bytes";
}

}  // namespace isotherm::system_test
