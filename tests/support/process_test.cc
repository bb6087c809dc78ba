#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace isotherm::system_test {
namespace {

/// Far more than any of these needs.
constexpr Seconds kPatience{20};

TEST(ProcessTest, CollectsOutputAndExitStatus) {
  const Finished finished = RunToEnd(Shell("echo out; echo err >&2; exit 3"), kPatience);
  EXPECT_EQ(finished.status, 3);
  EXPECT_NE(finished.output.find("out\n"), std::string::npos);
  EXPECT_NE(finished.output.find("err\n"), std::string::npos);
}

TEST(ProcessTest, EndBySignalReadsAsInAShell) {
  EXPECT_EQ(RunToEnd(Shell("kill -TERM $$"), kPatience).status, 128 + SIGTERM);
}

TEST(ProcessTest, ARunningProgramIsSeenAndKilled) {
  Process process(Shell("echo started; exec sleep 1000"));
  EXPECT_TRUE(process.WaitForOutput("started", kPatience));
  EXPECT_EQ(process.WaitForExit(Seconds(0)), std::nullopt);
  process.Signal(SIGKILL);
  EXPECT_EQ(process.WaitForExit(kPatience), 128 + SIGKILL);
}

TEST(ProcessTest, TextThatNeverComesEndsTheWait) {
  Process process(Shell("echo something"));
  EXPECT_FALSE(process.WaitForOutput("else", kPatience));
}

TEST(ProcessTest, TheEnvironmentCanBeReplaced) {
  const Finished finished =
      RunToEnd({"/bin/sh", {"-c", "echo $HOME"}, {"HOME=elsewhere"}}, kPatience);
  EXPECT_EQ(finished.output, "elsewhere\n");
}

TEST(ProcessTest, FullOutputFileIsSeenByTheProgram) {
  EXPECT_NE(RunToEnd({"/bin/sh", {"-c", "echo lost"}, {}, "/dev/full"}, kPatience).status, 0);
}

}  // namespace
}  // namespace isotherm::system_test
