#include "tests/support/departure.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace isotherm::system_test {
namespace {

/// Far more than any of these needs.
constexpr Seconds kPatience{60};

TEST(DepartureTest, APauseIsTheProgramsOwn) {
  Process program(Shell("trap 'sleep 1; exit 3' TERM; echo ready; while :; do sleep 0.05; done"));
  ASSERT_TRUE(program.WaitForOutput("ready", kPatience));
  const Departure departure = Leave(program, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, 3);
  EXPECT_GE(departure.took.count(), 1.0);
  // It sleeps: however busy the computer is, it waits for a processor only around that.
  EXPECT_GE(departure.own().count(), 0.9) << departure.ToText();
}

TEST(DepartureTest, WaitingForAProcessorIsNot) {
  // Several that compute on one processor: this one gets a part of it only.
  const std::string one_processor = "taskset -pc 0 $$ >/dev/null; ";
  std::vector<std::unique_ptr<Process>> others;
  for (int i = 0; i < 4; ++i) {
    others.push_back(
        std::make_unique<Process>(Shell(one_processor + "echo at it; while :; do :; done")));
    ASSERT_TRUE(others.back()->WaitForOutput("at it", kPatience));
  }
  Process program(Shell(one_processor +
                        "trap 'i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done; exit 0' TERM; "
                        "echo ready; while :; do sleep 0.05; done"));
  ASSERT_TRUE(program.WaitForOutput("ready", kPatience));
  const Departure departure = Leave(program, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, 0);
  // It has a fifth of the processor: it waits for four fifths of the time.
  EXPECT_GT(departure.waited / departure.took, 0.5) << departure.ToText();
  EXPECT_GT(departure.own().count(), 0.0) << departure.ToText();
}

TEST(DepartureTest, OneThatDoesNotLeaveHasNoStatus) {
  Process program(Shell("trap '' TERM; echo ready; while :; do sleep 0.05; done"));
  ASSERT_TRUE(program.WaitForOutput("ready", kPatience));
  EXPECT_EQ(Leave(program, SIGTERM, Seconds(0.2)).status, std::nullopt);
}

TEST(DepartureTest, ADescendantThatHoldsTheOutputDoesNotDelayTheEnd) {
  Process program(Shell("sleep 5 & echo ready; exec sleep 60"));
  ASSERT_TRUE(program.WaitForOutput("ready", kPatience));
  const Departure departure = Leave(program, SIGTERM, kPatience);
  EXPECT_EQ(departure.status, 128 + SIGTERM);
  EXPECT_LT(departure.own().count(), 1.0) << departure.ToText();
}

}  // namespace
}  // namespace isotherm::system_test
