#include "tests/support/machine_load.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "tests/support/process.h"

namespace isotherm::system_test {
namespace {

/// The kernel counts in hundredths of a second.
constexpr double kTicks = 0.05;

TEST(MachineLoadTest, WhatThisProcessAndItsChildrenTakeIsNoExcuse) {
  // As much as there is, from here and from a child; what others took can only be in the rest.
  const MachineLoad load;
  const Process child({"/bin/sh", {"-c", "while :; do :; done"}, {}, {}});
  const auto start = std::chrono::steady_clock::now();
  const auto end = start + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end) {
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const double own_s = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  const double all_s = Seconds(std::chrono::steady_clock::now() - start).count() *
                       static_cast<double>(::sysconf(_SC_NPROCESSORS_ONLN));
  EXPECT_LE(load.others_fraction(), 1.0 - own_s / all_s + kTicks) << load.ToText();
}

TEST(MachineLoadTest, WhatOthersTakeIsOne) {
  // A process that is nobody's child here: its parent has left.
  Process starter(
      {"/bin/sh", {"-c", "(while :; do :; done) </dev/null >/dev/null 2>&1 & echo $!"}, {}, {}});
  ASSERT_EQ(starter.WaitForExit(Seconds(20)), 0);
  const pid_t other = std::stoi(starter.output());
  const MachineLoad load;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (load.worst_others_fraction() < 0.1 && std::chrono::steady_clock::now() < end) {
    starter.WaitForExit(Seconds(0.1));
  }
  EXPECT_GE(load.worst_others_fraction(), 0.1) << load.ToText();
  EXPECT_LE(load.excused_fraction(), 0.25) << "however busy";
  ::kill(other, SIGKILL);
}

}  // namespace
}  // namespace isotherm::system_test
