// Rows F15, F17 and F18 by the programs as they ship: the edge sees a wall clock that is wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "common/testing/temporary_directory.h"
#include "common/time/kernel_clock.h"
#include "tests/system/programs.h"

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

  /// A scan in real time; the edge's wall clock is `ahead_ms` ahead from `after_s` on.
  void Scan(int ahead_ms, int after_s = 0) {
    std::vector<std::string> arguments = {"--once", "--domain", std::to_string(TestDomain()),
                                          "--output", Path("ground")};
    for (const std::string& argument : QuickModel()) arguments.push_back(argument);
    Process ground({GroundService(), arguments, {}});
    ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
    const Finished edge = RunToEnd(
        {EdgeDaemon(),
         {"--recording", shared_->path() / "source.mcap", "--domain", std::to_string(TestDomain()),
          "--record", Path("edge.mcap"), "--rate", "1", "--wait-for-ground", "--exit-at-end"},
         {std::string("LD_PRELOAD=") + SHIFTED_CLOCK, "CLOCK_SHIFT_MS=" + std::to_string(ahead_ms),
          "CLOCK_SHIFT_AFTER_S=" + std::to_string(after_s)}},
        kPatience);
    EXPECT_EQ(edge.status, 0) << edge.output;
    EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
    edge_output_ = edge.output;
    ground_output_ = ground.output();
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
    if (HasFailure())
      std::cout << "edge:\n" << edge_output_ << "ground:\n" << ground_output_ << std::flush;
  }

  static std::unique_ptr<TemporaryDirectory> shared_;
  TemporaryDirectory folder_;
  std::string edge_output_;
  std::string ground_output_;
};

std::unique_ptr<TemporaryDirectory> ClockTest::shared_;

TEST_F(ClockTest, F18AWrongClockIsAnAlarmInLogAndStats) {
  Scan(2000);
  EXPECT_THAT(ground_output_, HasSubstr("CLOCK ALARM: the rig's clock is "));
  EXPECT_EQ(Number("alarms"), 1.0);
  EXPECT_NEAR(Difference("ms"), 2000.0, Difference("uncertainty_ms"));
  EXPECT_GT(Difference("largest_certain_ms"), 50.0);
  EXPECT_THAT(Inspect("ground/scan.mcap"), HasSubstr("CLOCK ALARM"));
}

TEST_F(ClockTest, F15AStepDuringTheScanIsInBothRecordings) {
  Scan(-3000, /*after_s=*/3);
  EXPECT_THAT(edge_output_, HasSubstr("the wall clock was set, step_s="));
  EXPECT_THAT(ground_output_, HasSubstr("the rig's clock was set by -3.000 s"));
  EXPECT_THAT(Inspect("edge.mcap"), HasSubstr("from there on UTC = capture time -3.000 s"));
  EXPECT_THAT(Inspect("ground/scan.mcap"), HasSubstr("from there on UTC = capture time -3.000 s"));
  EXPECT_EQ(Number("steps"), 1.0);
  EXPECT_NEAR(Number("step_sum_s"), -3.0, 0.001);
}

TEST_F(ClockTest, F17WhetherTheClockIsSynchronisedIsToldEverywhere) {
  Scan(0);
  EXPECT_EQ(Number("alarms"), 0.0);
  EXPECT_NEAR(Difference("ms"), 0.0, Difference("uncertainty_ms")) << "one computer, one clock";
  const bool synchronised = ReadKernelClock().synchronised;
  EXPECT_EQ(edge_output_.find("the wall clock is not synchronised") == std::string::npos,
            synchronised);
  EXPECT_EQ(ground_output_.find("the rig's clock is not synchronised") == std::string::npos,
            synchronised);
  for (const char* recording : {"edge.mcap", "ground/scan.mcap"}) {
    EXPECT_EQ(Inspect(recording).find("NOT SYNCHRONISED") == std::string::npos, synchronised)
        << recording;
  }
}

}  // namespace
}  // namespace isotherm::system_test
