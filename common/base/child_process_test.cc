#include "common/base/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>
#include <vector>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

class ChildProcessTest : public ::testing::Test {
 protected:
  /// Tells its number and then stays. The test's own time limit is the bound.
  const std::vector<std::string> stays_ = {"-c", "echo $$; exec sleep 1000"};
  static pid_t AwaitNumber(const std::filesystem::path& log) {
    pid_t number = 0;
    while (!(std::ifstream(log) >> number)) std::this_thread::yield();
    return number;
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path log_ = folder_.path() / "log";
};

TEST_F(ChildProcessTest, ItsOutputIsInTheLogAndItsExitStatusIsKnown) {
  auto child = ChildProcess::Start("/bin/sh", {"-c", "echo said; echo too >&2; exit 7"}, log_);
  ASSERT_TRUE(child.has_value());
  while (!child->Poll()) std::this_thread::yield();
  EXPECT_EQ(child->Poll(), 7);
  EXPECT_EQ(LastLines(log_, 5), "  said\n  too\n");
}

TEST_F(ChildProcessTest, AProgramThatIsNotThereIsNamed) {
  const auto child = ChildProcess::Start("/nowhere/program", {}, log_);
  ASSERT_FALSE(child.has_value());
  EXPECT_THAT(child.error().message(),
              HasSubstr("/nowhere/program: cannot be started: No such file"));
}

TEST_F(ChildProcessTest, SignalsThatAreBlockedHereReachIt) {
  sigset_t termination;
  sigemptyset(&termination);
  sigaddset(&termination, SIGTERM);
  ASSERT_EQ(sigprocmask(SIG_BLOCK, &termination, nullptr), 0);
  auto child = ChildProcess::Start("/bin/sh", stays_, log_);
  ASSERT_EQ(sigprocmask(SIG_UNBLOCK, &termination, nullptr), 0);
  ASSERT_TRUE(child.has_value());
  AwaitNumber(log_);
  child->Terminate();
  while (!child->Poll()) std::this_thread::yield();
  EXPECT_EQ(child->Poll(), 128 + SIGTERM);
}

TEST_F(ChildProcessTest, ItEndsWhenWhoStartedItIsKilled) {
  // Orphans come here instead of going to init.
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const pid_t starter = fork();
  ASSERT_GE(starter, 0);
  if (starter == 0) {
    const auto child = ChildProcess::Start("/bin/sh", stays_, log_);
    while (child.has_value()) pause();
    _exit(1);
  }
  const pid_t child = AwaitNumber(log_);
  ASSERT_EQ(kill(starter, SIGKILL), 0);
  ASSERT_EQ(waitpid(starter, nullptr, 0), starter);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

}  // namespace
}  // namespace isotherm
