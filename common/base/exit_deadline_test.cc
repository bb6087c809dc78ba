#include "common/base/exit_deadline.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
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

TEST(ExitDeadlineTest, StagesCannotAddUpToMoreThanTheBound) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Bound(milliseconds(100));
        for (int stage = 0; stage < 20; ++stage) {
          deadline.Arm(milliseconds(60), kStatus, "stage " + std::to_string(stage));
          std::this_thread::sleep_for(milliseconds(50));
        }
        _exit(0);  // A second after the beginning.
      },
      testing::ExitedWithCode(kStatus),
      "stage [0-9]* did not end within 0\\.0|no time was left for stage");
}

TEST(ExitDeadlineTest, AStageThatBeginsBehindTheBoundIsSaidToHaveHadNoTime) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Bound(milliseconds(0));
        std::this_thread::sleep_for(milliseconds(5));
        deadline.Arm(hours(1), kStatus, "the network");
        Hang();
      },
      testing::ExitedWithCode(kStatus), "no time was left for the network");
}

TEST(ExitDeadlineTest, ABoundMovesUpADeadlineThatIsThere) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Arm(hours(1), kStatus, "the network");
        deadline.Bound(milliseconds(20));
        deadline.Bound(hours(1));  // The first one counts.
        Hang();
      },
      testing::ExitedWithCode(kStatus), "the network did not end");
}

TEST(ExitDeadlineTest, ABoundAloneEndsNothing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExitDeadline deadline;
        deadline.Bound(milliseconds(1));
        std::this_thread::sleep_for(milliseconds(50));
        _exit(0);
      },
      testing::ExitedWithCode(0), "");
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
