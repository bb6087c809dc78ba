// isotherm-edge as a process, when whoever reads its messages stops or is gone.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/system/edge_failure.h"
#include "tests/system/output_pipe.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

class OutputPipeTest : public EdgeFailureTest {
 protected:
  /// It does what it should although nobody reads what it says.
  void ExpectAllIsWell(Process& edge) {
    ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience));
    ASSERT_TRUE(WaitForSize(edge, file_, 50'000));
    EXPECT_LT(manager_.LongestSilence(kFed, Seconds(12)), kWatchdogSec);
    ExpectToLeave(edge, 0);
    EXPECT_TRUE(ReadRecording(file_).complete);
    EXPECT_TRUE(CountersOf(edge.output(), Sensor::kDepth, "recorded").Closes());
  }

  OutputPipe pipe_{folder_.path()};
};

TEST_F(OutputPipeTest, F38AReaderThatIsGoneDoesNotEndTheScan) {
  Process edge(pipe_.From(Replay({"--record", file_, "--log-level", "debug"})));
  ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience));
  pipe_.CloseAll();
  ExpectAllIsWell(edge);
}

TEST_F(OutputPipeTest, F39AFullPipeThatNobodyReadsHoldsUpNothing) {
  pipe_.Fill();
  Process edge(pipe_.From(Replay({"--record", file_, "--log-level", "debug"})));
  ExpectAllIsWell(edge);
}

TEST_F(OutputPipeTest, F39AForcedExitDoesNotWaitForWhoReadsTheSummary) {
  pipe_.Fill();
  const std::filesystem::path disk = folder_.path() / "pipe";
  ASSERT_EQ(mkfifo(disk.c_str(), 0600), 0);
  const int stuck = open(disk.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(stuck, 0);
  Process edge(pipe_.From(Replay({"--record", disk}), "1"));
  ASSERT_TRUE(manager_.WaitFor(kFed, kPatience));
  EXPECT_TRUE(edge.WaitForOutput("the disk does not answer", kPatience)) << edge.output();
  ExpectToLeave(edge, 73, kForTheDisk + kTimeToLeave);
  EXPECT_THAT(edge.output(), HasSubstr("the disk did not end"));
  close(stuck);
}

}  // namespace
}  // namespace isotherm::system_test
