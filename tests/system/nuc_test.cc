// The way of an operator's wish about the shutter: isotherm nuc -> DDS -> isotherm-edge -> the
// simulated camera -> its frames -> the recording.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

constexpr int kRefused = 69;  // EX_UNAVAILABLE of sysexits.h.

class NucTest : public ::testing::Test {
 protected:
  /// A simulated scan that is played again and again; small, since only the shutter matters.
  Command Edge(std::vector<std::string> settings) const {
    Command edge{EdgeDaemon(), {"--scene", "plane", "--domain", std::to_string(OwnDomain())}, {}};
    edge.arguments.insert(edge.arguments.end(), {"--record", folder_.path() / "edge.mcap"});
    settings.insert(
        settings.begin(),
        {"source.loops=0", "source.expert.cache_dir=" + folder_.path().string(),
         "source.simulation.duration_s=2", "source.simulation.depth.rate_hz=2",
         "source.simulation.thermal.rate_hz=20", "source.simulation.shutter.interval_s=0"});
    for (const std::string& setting : settings)
      edge.arguments.insert(edge.arguments.end(), {"--set", setting});
    return edge;
  }
  static Finished Nuc(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "nuc");
    arguments.insert(arguments.end(), {"--domain", std::to_string(OwnDomain()), "--timeout", "60"});
    return RunToEnd({Tool(), std::move(arguments), {}}, kPatience);
  }
  /// Returns what the thermal frames of the edge's recording say, and its log.
  std::string Inspect() const {
    return RunToEnd({Tool(), {"inspect", folder_.path() / "edge.mcap"}, {}}, kPatience).output;
  }

  TemporaryDirectory folder_;
};

TEST_F(NucTest, F07ACorrectionThatIsAskedForClosesTheShutterAndEnds) {
  Process edge(Edge({}));
  ASSERT_TRUE(edge.WaitForOutput("started", kPatience)) << edge.output();
  const Finished asked = Nuc({"--now"});
  EXPECT_EQ(asked.status, 0) << asked.output;
  EXPECT_THAT(asked.output, HasSubstr("edge: the camera has the order"));
  EXPECT_TRUE(edge.WaitForOutput("shutter open after 0.40 s", kPatience)) << edge.output();
  const Finished again = Nuc({"--now"});
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_THAT(again.output, HasSubstr("corrections are at least 10 s apart"));
  const Finished held = Nuc({"--hold", "500"});
  EXPECT_EQ(held.status, 0) << held.output;
  EXPECT_THAT(held.output, HasSubstr("corrections are held for 60 s, the most"));
  const Finished refused = Nuc({"--now"});
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.output, HasSubstr("edge refuses: corrections are held for another"));
  const Finished state = Nuc({});
  EXPECT_EQ(state.status, 0) << state.output;
  EXPECT_THAT(state.output, AllOf(HasSubstr("known by      its frames"), HasSubstr("s ago"),
                                  HasSubstr("corrections 1, shutter closed"),
                                  HasSubstr("policy        automatic")));
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_THAT(Inspect(),
              AllOf(HasSubstr("8 in progress"), ContainsRegex("(9|1[01]) settling"),
                    HasSubstr("info: nuc: correction ordered: asked for"),
                    HasSubstr("info: nuc: shutter closed as ordered"), HasSubstr("event from")));
}

TEST_F(NucTest, F07AShutterOfWhichTheCameraDoesNotTellIsFoundInItsImages) {
  Process edge(Edge({"source.simulation.shutter.expert.reports_shutter=false",
                     "nuc.expert.commanded_duration_s=0"}));
  ASSERT_TRUE(edge.WaitForOutput("started", kPatience)) << edge.output();
  EXPECT_EQ(Nuc({"--now"}).status, 0);
  EXPECT_TRUE(edge.WaitForOutput("known by its images", kPatience)) << edge.output();
  EXPECT_TRUE(edge.WaitForOutput("shutter open after", kPatience)) << edge.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
}

TEST_F(NucTest, F08AStormIsReportedWithWhatItCostsAndNothingIsOrderedOnTop) {
  Process edge(
      Edge({"source.simulation.shutter.first_s=0.4", "source.simulation.shutter.interval_s=0.8",
            "source.simulation.shutter.duration_s=0.2"}));
  ASSERT_TRUE(
      edge.WaitForOutput("storm of corrections: 7 corrections in the last minute, shutter "
                         "closed for",
                         kPatience))
      << edge.output();
  const Finished refused = Nuc({"--now"});
  EXPECT_EQ(refused.status, kRefused);
  EXPECT_THAT(refused.output, HasSubstr("corrections in the last minute, more than 6"));
  EXPECT_THAT(Nuc({}).output, AllOf(HasSubstr("shutter closed for"), HasSubstr("(storm)")));
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_THAT(edge.output(), Not(HasSubstr("correction ordered")));
}

TEST_F(NucTest, F08AnOrderThatIsNotFollowedIsReported) {
  Process edge(Edge({"source.simulation.shutter.expert.follows_orders=false",
                     "nuc.expert.max_attempts=1", "nuc.expert.answer_s=0.5"}));
  ASSERT_TRUE(edge.WaitForOutput("started", kPatience)) << edge.output();
  EXPECT_EQ(Nuc({"--now"}).status, 0);
  EXPECT_TRUE(edge.WaitForOutput("did not close within 0.5 s (attempt 1 of 1)", kPatience))
      << edge.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
}

TEST_F(NucTest, F08AShutterThatStaysClosedIsReportedAndTheScanGoesOn) {
  Process edge(Edge({"source.simulation.shutter.duration_s=1000", "nuc.expert.max_duration_s=1"}));
  ASSERT_TRUE(edge.WaitForOutput("started", kPatience)) << edge.output();
  EXPECT_EQ(Nuc({"--now"}).status, 0);
  EXPECT_TRUE(edge.WaitForOutput("the correction does not end", kPatience)) << edge.output();
  // The status comes once a second.
  std::string state;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (state.find("error") == std::string::npos && std::chrono::steady_clock::now() < deadline)
    state = Nuc({}).output;
  EXPECT_THAT(state, HasSubstr("correction    error: shutter closed for"));
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
}

TEST(NucCommandTest, WithoutARigItSaysWhatToCheck) {
  const Finished nuc = RunToEnd(
      {Tool(), {"nuc", "--domain", std::to_string(OwnDomain()), "--timeout", "0.5", "--now"}, {}},
      kPatience);
  EXPECT_EQ(nuc.status, kRefused);
  EXPECT_THAT(nuc.output, HasSubstr("no status from any rig"));
}

}  // namespace
}  // namespace isotherm::system_test
