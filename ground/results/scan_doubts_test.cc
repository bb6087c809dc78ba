#include "ground/results/scan_doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ground/results/outcome_text.h"

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

  PipelineCounts counts_;
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
  counts_.depth_lost = {{"too_few_pixels", 29}, {"step", 1}};
  EXPECT_THAT(DoubtsAboutResult(NothingTracked()),
              ElementsAre(AllOf(HasSubstr("none of 30 depth frames was tracked"),
                                HasSubstr("0.3 to 4 m"), HasSubstr("depth_scale"))));
  counts_.depth_lost = {{"outside_volume", 30}};
  EXPECT_THAT(DoubtsAboutResult(NothingTracked()), ElementsAre(HasSubstr("--initial-pose")));
}

TEST_F(ScanDoubtsTest, AModelThatIsWrittenUnchangedIsSaid) {
  counts_.depth_lost = {{"not_found", 30}};
  ScanOutcome outcome = NothingTracked();
  outcome.continued = true;
  outcome.points = outcome.measured_points = 5000;  // The old model's.
  EXPECT_THAT(DoubtsAboutResult(outcome),
              ElementsAre(AllOf(HasSubstr("that model, unchanged"), Not(HasSubstr("model-2")))));
  outcome.maps = 2;
  EXPECT_THAT(DoubtsAboutResult(outcome), ElementsAre(HasSubstr("in model-2.iso")));
}

TEST_F(ScanDoubtsTest, NoTemperatureNamesTheCause) {
  counts_.thermal_left_out = {{"nuc", 3}, {"no_depth_after", 37}};
  EXPECT_THAT(
      DoubtsAboutResult(NoTemperature()),
      ElementsAre(AllOf(HasSubstr("none of 40 thermal frames"), HasSubstr("clocks differ"))));
  counts_.thermal_left_out.clear();
  counts_.thermal_fused = 40;
  EXPECT_THAT(DoubtsAboutResult(NoTemperature()), ElementsAre(HasSubstr("T_thermal_depth right")));
  counts_.fusion.considered = 10000;
  EXPECT_THAT(DoubtsAboutResult(NoTemperature()),
              ElementsAre(AllOf(HasSubstr("0.9 m"), HasSubstr("thermal.keep_bad"))));
}

TEST(OutcomeTextTest, ReasonsAreSentences) {
  for (const char* reason : {"too_few_pixels", "too_few_inliers", "residual", "step", "singular",
                             "not_found", "outside_volume"}) {
    EXPECT_THAT(ExplainLost(reason), AllOf(HasSubstr(" "), Not(HasSubstr(reason)))) << reason;
  }
  for (const char* reason :
       {"nuc", "wrong_size", "time_uncertain", "no_depth", "no_depth_after", "pose_unknown",
        "pose_uncertain", "depth_gap", "behind", "disk_full", "no_calibration", "counts"}) {
    EXPECT_THAT(ExplainLeftOut(reason), HasSubstr(" ")) << reason;
  }
  EXPECT_EQ(ExplainLost("something_new"), "something_new");
  EXPECT_EQ(MainReason({{"a", 3}, {"b", 7}, {"c", 1}}), "b");
  EXPECT_EQ(MainReason({}), "");
}

}  // namespace
}  // namespace isotherm
