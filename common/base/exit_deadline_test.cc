#include "common/base/exit_deadline.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

namespace isotherm {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

constexpr int kStatus = 73;

/// Something that never returns.
[[noreturn]] void Hang() {
  while (true) pause();
}

TEST(ExitDeadlineTest, EndsAProcessThatHangsWithItsStatusAndSaysWhy) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Arm(milliseconds(20), kStatus, "the network",
                     [] { static_cast<void>(!write(STDERR_FILENO, "last words\n", 11)); });
        Hang();
      },
      testing::ExitedWithCode(kStatus), "last words\n.*the network did not end within 0.02 s");
}

TEST(ExitDeadlineTest, TheNewestDeadlineCounts) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Arm(hours(1), 1, "the disk");
        deadline.Arm(milliseconds(20), kStatus, "the network");
        Hang();
      },
      testing::ExitedWithCode(kStatus), "the network did not end");
}

TEST(ExitDeadlineTest, LastWordsThatNobodyTakesDoNotHoldIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Arm(milliseconds(20), kStatus, "the network", [] { Hang(); });
        Hang();
      },
      testing::ExitedWithCode(kStatus), "the network did not end within 0.02 s");
}

TEST(ExitDeadlineTest, AFirstDeadlineLeavesOneThatIsThereAlone) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.ArmFirst(milliseconds(20), kStatus, "the disk");
        deadline.ArmFirst(hours(1), 1, "the network");
        Hang();
      },
      testing::ExitedWithCode(kStatus), "the disk did not end");
}

TEST(ExitDeadlineTest, NothingHappensToAProcessThatLeavesInTime) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        {
          ExitDeadline deadline;
          deadline.Arm(hours(1), kStatus, "the network");
        }
        _exit(0);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace isotherm
