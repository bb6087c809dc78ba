#include "common/messages/feedback_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Eigen::Quaterniond Rotation(double deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(deg * kRadPerDeg, axis));
}

TEST(FeedbackTextTest, MovesAreSaidInTheOperatorsWords) {
  EXPECT_EQ(MoveText(RigidTransform::Identity()), "here");
  EXPECT_EQ(MoveText(MakeTransform({0.3, 0, 0}, Eigen::Quaterniond::Identity())), "0.30 m right");
  EXPECT_EQ(MoveText(MakeTransform({-0.3, 0.1, -0.2}, Eigen::Quaterniond::Identity())),
            "0.30 m left, 0.10 m down, 0.20 m back");
  // About y (down), x (right) turns to the back: a positive angle looks to the right.
  EXPECT_EQ(MoveText(MakeTransform({0, 0, 0}, Rotation(30, Eigen::Vector3d::UnitY()))),
            "turn 30 deg right");
  EXPECT_EQ(MoveText(MakeTransform({0, -0.1, 0.01}, Rotation(20, Eigen::Vector3d::UnitX()))),
            "0.10 m up, turn 20 deg up");
}

TEST(FeedbackTextTest, OneLineHasStateCoverageAdviceAndWay) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  feedback.view.good = 0.615F;
  feedback.model.good = 0.25F;
  feedback.covered_area_m2 = 0.8;
  feedback.advice = {Advice::kMoveCloser};
  feedback.advice_reason = "40 % of the surface is farther than 0.60 m";
  feedback.T_depth_next = MakeTransform({0.3, 0, 0}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(
      FeedbackText(feedback),
      "closer (40 % of the surface is farther than 0.60 m), tracked, view 62 % good, all 25 % "
      "of 0.80 m2, next view: 0.30 m right");
}

TEST(FeedbackTextTest, F48ThatTheGroundIsBehindStandsBeforeTheReasonWithWhatToDo) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  feedback.advice = {Advice::kMoveCloser};
  feedback.advice_reason = "40 % of the surface is farther than 0.60 m";
  feedback.frames_left_out = 764;
  EXPECT_THAT(
      FeedbackParts(feedback, {"NO NETWORK"}),
      ElementsAre("closer", "NO NETWORK", "ground BEHIND 764: reconstruct its scan.mcap again",
                  "40 % of the surface is farther than 0.60 m", "tracked"));
  feedback.advice = {};
  EXPECT_EQ(FeedbackText(feedback),
            "40 % of the surface is farther than 0.60 m, ground BEHIND 764: reconstruct its "
            "scan.mcap again, tracked");
}

TEST(FeedbackTextTest, WithoutAdviceTheOperatorGoesOn) {
  Feedback feedback;
  EXPECT_EQ(AdviceText(feedback), "go on");
  feedback.advice_reason = "90 % in view is measured well: go on";
  EXPECT_EQ(AdviceText(feedback), "90 % in view is measured well: go on");
}

TEST(FeedbackTextTest, WhileLostTheLineSaysWhereTrackingWorked) {
  Feedback feedback;
  feedback.tracking_state = TrackingState::kLost;
  feedback.advice = {Advice::kGoBackToRelocalise};
  feedback.advice_reason = "tracking is lost: return to where it worked";
  feedback.T_world_depth_next = MakeTransform({0.5, 0.59, -0.11}, Eigen::Quaterniond::Identity());
  EXPECT_EQ(FeedbackText(feedback),
            "go back (tracking is lost: return to where it worked), LOST, it worked at (0.50 0.59 "
            "-0.11) m looking (0.00 0.00 1.00)");
}

TEST(FeedbackReporterTest, TellsChangesOfStateOnly) {
  FeedbackReporter reporter;
  Feedback feedback;
  feedback.tracking_state = TrackingState::kTracked;
  EXPECT_TRUE(reporter.Report(feedback).has_value());
  feedback.view.good = 0.7F;
  feedback.advice_reason = "other numbers";
  EXPECT_FALSE(reporter.Report(feedback).has_value());
  feedback.advice = {Advice::kSlower};
  EXPECT_THAT(reporter.Report(feedback).value_or(""), HasSubstr("slower"));
  EXPECT_FALSE(reporter.Report(feedback).has_value());
  feedback.tracking_state = TrackingState::kLost;
  EXPECT_THAT(reporter.Report(feedback).value_or(""), HasSubstr("LOST"));
  feedback.done = true;
  EXPECT_TRUE(reporter.Report(feedback).has_value());
}

}  // namespace
}  // namespace isotherm
