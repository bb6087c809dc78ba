// isotherm-edge as a process, when whoever reads its messages stops or is gone.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

#include "tests/system/edge_failure.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

/// The daemon writes to a pipe of which the test has both ends.
class OutputPipeTest : public EdgeFailureTest {
 protected:
  OutputPipeTest() {
    if (mkfifo(pipe_.c_str(), 0600) != 0) return;
    reader_ = open(pipe_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    writer_ = open(pipe_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  }
  ~OutputPipeTest() override {
    CloseReader();
    close(writer_);
  }
  void CloseReader() {
    if (reader_ >= 0) close(std::exchange(reader_, -1));
  }
  /// Until nothing more fits.
  void Fill() const {
    const std::string page(4096, 'x');
    while (write(writer_, page.data(), page.size()) > 0) {
    }
  }
  Command WithIts(Command command, const std::string& descriptor = "2") const {
    const std::string script = "exec \"$0\" \"$@\" " + descriptor + ">" + pipe_.string();
    command.arguments.insert(command.arguments.begin(), {"-c", script, command.program});
    command.program = "/bin/sh";
    return command;
  }
  /// It does what it should although nobody reads what it says.
  void ExpectAllIsWell(Process& edge) {
    ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience));
    ASSERT_TRUE(WaitForSize(edge, file_, 50'000));
    EXPECT_LT(manager_.LongestSilence(kFed, Seconds(12)), kWatchdogSec);
    EXPECT_LT(Leave(edge, 0), kTimeToLeave + kSlack);
    EXPECT_TRUE(ReadRecording(file_).complete);
    EXPECT_TRUE(CountersOf(edge.output(), Sensor::kDepth, "recorded").Closes());
  }

  const std::filesystem::path pipe_ = folder_.path() / "output";
  int reader_ = -1;
  int writer_ = -1;
};

TEST_F(OutputPipeTest, F38AReaderThatIsGoneDoesNotEndTheScan) {
  Process edge(WithIts(Replay({"--record", file_, "--log-level", "debug"})));
  ASSERT_TRUE(manager_.WaitFor("READY=1", kPatience));
  close(std::exchange(writer_, -1));
  CloseReader();
  ExpectAllIsWell(edge);
}

TEST_F(OutputPipeTest, F39AFullPipeThatNobodyReadsHoldsUpNothing) {
  Fill();
  Process edge(WithIts(Replay({"--record", file_, "--log-level", "debug"})));
  ExpectAllIsWell(edge);
}

TEST_F(OutputPipeTest, F39AForcedExitDoesNotWaitForWhoReadsTheSummary) {
  Fill();
  const std::filesystem::path disk = folder_.path() / "pipe";
  ASSERT_EQ(mkfifo(disk.c_str(), 0600), 0);
  const int stuck = open(disk.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(stuck, 0);
  Process edge(WithIts(Replay({"--record", disk}), "1"));
  ASSERT_TRUE(manager_.WaitFor(kFed, kPatience));
  EXPECT_TRUE(edge.WaitForOutput("the disk does not answer", kPatience)) << edge.output();
  EXPECT_LT(Leave(edge, 73), Seconds(3.5) + kSlack);
  EXPECT_THAT(edge.output(), HasSubstr("the disk did not end"));
  close(stuck);
}

}  // namespace
}  // namespace isotherm::system_test
