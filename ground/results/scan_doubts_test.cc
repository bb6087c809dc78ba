#include "ground/results/scan_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "ground/results/outcome_text.h"
#include "ground/scan/stage_times.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ScanDoubtsTest : public ::testing::Test {
 protected:
  ScanDoubtsTest() {
    counts_.depth_in = 30;
    counts_.thermal_in = 40;
  }
  /// A scan of which everything came out well.
  ScanOutcome Good() const {
    return {.counts = counts_,
            .options = options_,
            .can_fuse = true,
            .poses = 30,
            .points = 5000,
            .measured_points = 3000};
  }
  ScanOutcome NothingTracked() const {
    ScanOutcome outcome = Good();
    outcome.poses = outcome.points = outcome.measured_points = 0;
    return outcome;
  }
  ScanOutcome NoTemperature() const {
    ScanOutcome outcome = Good();
    outcome.measured_points = 0;
    return outcome;
  }

  ScanCounts counts_;
  GroundOptions options_;
};

TEST_F(ScanDoubtsTest, AGoodScanIsNotDoubted) { EXPECT_THAT(DoubtsAboutResult(Good()), IsEmpty()); }

TEST_F(ScanDoubtsTest, ScansWithoutUsableThermalFramesMayHaveNoTemperatures) {
  ScanOutcome uncalibrated = NoTemperature();
  uncalibrated.can_fuse = false;
  EXPECT_THAT(DoubtsAboutResult(uncalibrated), IsEmpty());
  counts_.thermal_in = 0;
  EXPECT_THAT(DoubtsAboutResult(NoTemperature()), IsEmpty());
}

TEST_F(ScanDoubtsTest, NothingTrackedNamesTheCauseByItsReason) {
  counts_.depth_lost = {{LostReason::kTooFewPixels, 29}, {LostReason::kStep, 1}};
  EXPECT_THAT(DoubtsAboutResult(NothingTracked()),
              ElementsAre(AllOf(HasSubstr("none of 30 depth frames was tracked"),
                                HasSubstr("0.3 to 4 m"), HasSubstr("depth_scale"))));
  counts_.depth_lost = {{LostReason::kOutsideVolume, 30}};
  EXPECT_THAT(DoubtsAboutResult(NothingTracked()), ElementsAre(HasSubstr("--initial-pose")));
}

TEST_F(ScanDoubtsTest, AModelThatIsWrittenUnchangedIsSaid) {
  counts_.depth_lost = {{LostReason::kNotFound, 30}};
  ScanOutcome outcome = NothingTracked();
  outcome.continued = true;
  outcome.points = outcome.measured_points = 5000;  // The old model's.
  EXPECT_THAT(DoubtsAboutResult(outcome),
              ElementsAre(AllOf(HasSubstr("that model, unchanged"), Not(HasSubstr("model-2")))));
  outcome.maps = 2;
  EXPECT_THAT(DoubtsAboutResult(outcome), ElementsAre(HasSubstr("in model-2.iso")));
}

TEST_F(ScanDoubtsTest, NoTemperatureNamesTheCause) {
  counts_.thermal_left_out = {{LeftOutReason::kNuc, 3}, {LeftOutReason::kNoDepthAfter, 37}};
  EXPECT_THAT(
      DoubtsAboutResult(NoTemperature()),
      ElementsAre(AllOf(HasSubstr("none of 40 thermal frames"), HasSubstr("clocks differ"))));
  counts_.thermal_left_out = {};
  counts_.thermal_fused = 40;
  EXPECT_THAT(DoubtsAboutResult(NoTemperature()), ElementsAre(HasSubstr("T_thermal_depth right")));
  counts_.fusion.considered = 10000;
  EXPECT_THAT(DoubtsAboutResult(NoTemperature()),
              ElementsAre(AllOf(HasSubstr("0.9 m"), HasSubstr("thermal.expert.keep_bad"))));
}

/// Names that are written into stats.json must be there for every value, and in the order of the
/// values.
template <typename Enum>
void ExpectNamesInOrder(Enum first) {
  std::string last;
  for (const Enum value : AllValues<Enum>()) {
    if (value < first) continue;
    EXPECT_GT(std::string(ToString(value)), last) << static_cast<int>(value);
    last = ToString(value);
  }
}

TEST(OutcomeTextTest, EveryReasonAndStageHasANameInAlphabeticalOrder) {
  ExpectNamesInOrder(LostReason::kNotFound);
  ExpectNamesInOrder(LeftOutReason::kBehind);
  ExpectNamesInOrder(Stage::kDepthFrame);
  EXPECT_EQ(ToString(LostReason::kNone), "none");
}

TEST(OutcomeTextTest, ReasonsAreSentences) {
  for (const LostReason reason : AllValues<LostReason>()) {
    if (reason == LostReason::kNone) continue;
    const std::string name(ToString(reason));
    EXPECT_THAT(std::string(ExplainLost(reason)), AllOf(HasSubstr(" "), Not(HasSubstr(name))));
  }
  for (const LeftOutReason reason : AllValues<LeftOutReason>())
    EXPECT_THAT(std::string(ExplainLeftOut(reason)), HasSubstr(" ")) << ToString(reason);
}

TEST(OutcomeTextTest, TheMainReasonIsTheMostFrequentOne) {
  using LostCounts = EnumArray<LostReason, std::uint64_t>;
  EXPECT_EQ(MainReason(LostCounts{
                {LostReason::kResidual, 3}, {LostReason::kSingular, 7}, {LostReason::kStep, 1}}),
            LostReason::kSingular);
  EXPECT_EQ(MainReason(LostCounts{}), std::nullopt);
}

}  // namespace
}  // namespace isotherm
