#include "tests/system/machine_load.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <string>

#include "tests/system/process.h"

namespace isotherm::system_test {
namespace {

TEST(MachineLoadTest, WhatThisProcessAndItsChildrenTakeIsNoExcuse) {
  // As much as there is, from here and from a child, for a second; whatever else runs takes its
  // part as well, so that only the sum is known: all of it.
  const MachineLoad load;
  const Process child({"/bin/sh", {"-c", "while :; do :; done"}, {}, {}});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end) {
  }
  // Two busy threads get at least a tenth of the computer even among many others.
  EXPECT_LT(load.others_share(), 0.9);
}

TEST(MachineLoadTest, WhatOthersTakeIsOne) {
  // A process that is nobody's child here: its parent has left.
  Process starter(
      {"/bin/sh", {"-c", "(while :; do :; done) </dev/null >/dev/null 2>&1 & echo $!"}, {}, {}});
  ASSERT_EQ(starter.WaitForExit(Seconds(20)), 0);
  const pid_t other = std::stoi(starter.output());
  const MachineLoad load;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (load.worst_others_share() < 0.1 && std::chrono::steady_clock::now() < end) {
    starter.WaitForExit(Seconds(0.1));
  }
  EXPECT_GE(load.worst_others_share(), 0.1) << load.ToText();
  ::kill(other, SIGKILL);
}

}  // namespace
}  // namespace isotherm::system_test
