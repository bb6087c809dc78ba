// Rows F15, F17 and F18 by the programs as they ship: the edge sees a wall clock that is wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <iostream>
#include <memory>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

class ClockTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TemporaryDirectory>();
    SimulateScan(shared_->path() / "source.mcap", 4.0);
  }
  static void TearDownTestSuite() { shared_.reset(); }
  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }

  void StartGround() {
    std::vector<std::string> arguments = {"--once", "--domain", std::to_string(OwnDomain()),
                                          "--output", Path("ground")};
    for (const std::string& argument : QuickModel()) arguments.push_back(argument);
    ground_ = std::make_unique<Process>(
        Command{GroundService(),
                arguments,
                {std::string("LD_PRELOAD=") + SHIFTED_CLOCK, "CLOCK_STATE=" + clock_state_}});
    ASSERT_TRUE(ground_->WaitForOutput("ready", kPatience)) << ground_->output();
  }
  /// A scan in real time by an edge whose wall clock is `ahead_ms` ahead, from Step() on if that
  /// `waits`.
  void Start(int ahead_ms, bool waits = false) {
    StartGround();
    Command edge{EdgeDaemon(),
                 {"--recording", shared_->path() / "source.mcap", "--domain",
                  std::to_string(OwnDomain()), "--record", Path("edge.mcap"), "--rate", "1",
                  "--wait-for-ground", "--set", "source.loops=0"},
                 {std::string("LD_PRELOAD=") + SHIFTED_CLOCK,
                  "CLOCK_SHIFT_MS=" + std::to_string(ahead_ms), "CLOCK_STATE=" + clock_state_}};
    if (waits) edge.environment.push_back("CLOCK_SHIFT_WHEN=" + Path("now").string());
    edge_ = std::make_unique<Process>(edge);
  }
  void Step() const { std::ofstream(Path("now")) << "now\n"; }
  void Stop() {
    edge_->Signal(SIGTERM);
    EXPECT_EQ(edge_->WaitForExit(kPatience), 0);
    EXPECT_EQ(ground_->WaitForExit(kPatience), 0);
  }
  double Number(const std::string& name) const {
    return NumberAt(ReadStats(Path("ground")), {"link", "clock", name});
  }
  double Difference(const std::string& name) const {
    return NumberAt(ReadStats(Path("ground")), {"link", "clock", "minus_ground_clock", name});
  }
  std::string Inspect(const std::string& recording) const {
    return RunToEnd({Tool(), {"inspect", Path(recording)}, {}}, kPatience).output;
  }
  void TearDown() override {
    if (!HasFailure()) return;
    if (edge_) std::cout << "edge:\n" << edge_->output();
    std::cout << "ground:\n" << ground_->output() << std::flush;
  }

  static std::unique_ptr<TemporaryDirectory> shared_;
  std::string clock_state_ = "synchronised";  ///< The kernel tells both programs this.
  TemporaryDirectory folder_;
  std::unique_ptr<Process> ground_;
  std::unique_ptr<Process> edge_;
};

std::unique_ptr<TemporaryDirectory> ClockTest::shared_;

TEST_F(ClockTest, F18AWrongClockIsAnAlarmInLogAndStats) {
  Start(2000);
  EXPECT_TRUE(ground_->WaitForOutput("CLOCK ALARM: the rig's clock is ", kPatience));
  Stop();
  EXPECT_EQ(Number("alarms"), 1.0);
  EXPECT_NEAR(Difference("ms"), 2000.0, Difference("uncertainty_ms"));
  EXPECT_GT(Difference("largest_certain_ms"), 50.0);
  EXPECT_THAT(Inspect("ground/scan.mcap"), HasSubstr("CLOCK ALARM"));
}

TEST_F(ClockTest, F15AStepDuringTheScanIsInBothRecordings) {
  Start(-3000, /*waits=*/true);
  ASSERT_TRUE(ground_->WaitForOutput("first depth frame", kPatience));
  Step();
  EXPECT_TRUE(edge_->WaitForOutput("the wall clock was set, step_s=", kPatience));
  EXPECT_TRUE(ground_->WaitForOutput("the rig's clock was set by -3.000 s", kPatience));
  Stop();
  EXPECT_THAT(Inspect("edge.mcap"), HasSubstr("from there on UTC = capture time -3.000 s"));
  EXPECT_THAT(Inspect("ground/scan.mcap"), HasSubstr("from there on UTC = capture time -3.000 s"));
  EXPECT_EQ(Number("steps"), 1.0);
  EXPECT_NEAR(Number("step_sum_s"), -3.0, 0.001);
}

TEST_F(ClockTest, F17ASynchronisedClockIsNothingToTell) {
  Start(0);
  EXPECT_TRUE(ground_->WaitForOutput("rig's clock: ", kPatience)) << "the status line";
  Stop();
  EXPECT_EQ(Number("alarms"), 0.0);
  EXPECT_NEAR(Difference("ms"), 0.0, Difference("uncertainty_ms")) << "one computer, one clock";
  for (const Process* program : {edge_.get(), ground_.get()}) {
    EXPECT_THAT(program->output(), Not(HasSubstr("clock is not synchronised")));
  }
  for (const char* recording : {"edge.mcap", "ground/scan.mcap"}) {
    EXPECT_THAT(Inspect(recording), Not(HasSubstr("NOT SYNCHRONISED"))) << recording;
  }
}

TEST_F(ClockTest, F17AClockThatNobodyDisciplinesIsToldEverywhere) {
  clock_state_ = "free";
  Start(0);
  EXPECT_TRUE(edge_->WaitForOutput("clock is not synchronised", kPatience));
  EXPECT_TRUE(ground_->WaitForOutput("clock is not synchronised", kPatience));
  Stop();
  for (const char* recording : {"edge.mcap", "ground/scan.mcap"}) {
    EXPECT_THAT(Inspect(recording), HasSubstr("NOT SYNCHRONISED")) << recording;
  }
}

}  // namespace
}  // namespace isotherm::system_test
