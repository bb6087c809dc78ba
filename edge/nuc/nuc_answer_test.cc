// A camera that answers orders some frames later.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/nuc/testing/supervised_camera.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using enum NucState;
using S = Shows;

class NucAnswerTest : public NucSupervisorTest {
 protected:
  NucAnswerTest() { answers_at_once_ = false; }
  /// Up to the frame at which the camera gets an order to correct itself.
  void RequestAndOrder() {
    Start();
    Frames(S::kSaysIdle, 1);
    ASSERT_TRUE(supervisor_->Request().has_value());
    ASSERT_EQ(Frame(Observe(S::kSaysIdle)).order, NucOrder::kTrigger);
  }
};

TEST_F(NucAnswerTest, UntilItComesACorrectionMayBeginAndIsNotOrderedAgain) {
  RequestAndOrder();
  Frames(S::kSaysIdle, 30);
  EXPECT_EQ(last_.state, kImminent);
  EXPECT_TRUE(last_.valid) << "each frame says whether the shutter is closed";
  EXPECT_EQ(Triggers().size(), 1U);
  EXPECT_EQ(supervisor_->Request().value(), "") << "that order's answer is the answer";
}

TEST_F(NucAnswerTest, ACameraThatTellsNothingIsNotTrustedUntilItComes) {
  Start();
  Frames(S::kScene, 1);
  ASSERT_TRUE(supervisor_->Request().has_value());
  Frames(S::kScene, 0.1);
  EXPECT_EQ(last_.state, kImminent);
  EXPECT_FALSE(last_.valid);
  supervisor_->OnAnswer(NucOrder::kTrigger, OkStatus());
  EXPECT_EQ(Frame(Observe(S::kScene)).source, NucSource::kCommanded);
}

TEST_F(NucAnswerTest, OkMeansThatTheShutterMustCloseFromThenOn) {
  options_.mutable_expert()->set_max_attempts(1);
  RequestAndOrder();
  Frames(S::kSaysIdle, 1);
  supervisor_->OnAnswer(NucOrder::kTrigger, OkStatus());
  EXPECT_EQ(Frames(S::kSaysIdle, 2.9).state, kImminent);
  Frames(S::kSaysIdle, 0.2);
  EXPECT_THAT(notices_, HasSubstr("did not close within 3.0 s (attempt 1 of 1)"));
}

TEST_F(NucAnswerTest, AShutterThatClosesBeforeItIsClosedAsOrderedAndNotAwaitedAgain) {
  RequestAndOrder();
  Frames(S::kSaysClosed, 0.2);
  supervisor_->OnAnswer(NucOrder::kTrigger, OkStatus());
  Frames(S::kSaysClosed, 0.2);
  Frames(S::kSaysIdle, 10);
  EXPECT_EQ(last_.state, kIdle);
  EXPECT_THAT(notices_, AllOf(HasSubstr("shutter closed as ordered"), Not(HasSubstr("attempt"))));
  EXPECT_EQ(Triggers().size(), 1U);
}

TEST_F(NucAnswerTest, ARefusalForNowIsAnAttempt) {
  RequestAndOrder();
  supervisor_->OnAnswer(NucOrder::kTrigger, IoError("it stalls"));
  EXPECT_EQ(Frame(Observe(S::kSaysIdle)).state, kIdle);
  EXPECT_TRUE(last_.valid);
  EXPECT_THAT(notices_, HasSubstr("correction refused (attempt 1 of 3): it stalls"));
}

TEST_F(NucAnswerTest, ACameraThatTakesNoOrdersScansWithoutAFirstCorrectionFromThenOn) {
  options_.set_before_scan(true);
  Start();
  Frames(S::kSaysIdle, 0.5);
  ASSERT_EQ(Triggers().size(), 1U);
  EXPECT_FALSE(last_.valid) << "the camera has not said that it cannot";
  supervisor_->OnAnswer(NucOrder::kTrigger, FailedPrecondition("no shutter to command"));
  EXPECT_TRUE(Frame(Observe(S::kSaysIdle)).valid);
  EXPECT_THAT(notices_, HasSubstr("the scan goes on without"));
  Frames(S::kSaysIdle, 60);
  EXPECT_EQ(Triggers().size(), 1U);
}

TEST_F(NucAnswerTest, ARequestToACameraThatTakesNoOrdersIsPassedOnToItAtOnce) {
  RequestAndOrder();
  supervisor_->OnAnswer(NucOrder::kTrigger, FailedPrecondition("no shutter to command"));
  Frame(Observe(S::kSaysIdle));
  EXPECT_EQ(supervisor_->Request().value(), "") << "it is the camera that answers";
  EXPECT_EQ(Frame(Observe(S::kSaysIdle)).order, NucOrder::kTrigger);
}

TEST_F(NucAnswerTest, ACameraThatWasAwayIsAskedAgainWithoutIt) {
  RequestAndOrder();
  now_ += std::chrono::seconds(20);
  Frame(Observe(S::kSaysIdle));
  ASSERT_TRUE(supervisor_->Request().has_value());
  Frames(S::kSaysIdle, 0.1);
  EXPECT_EQ(Triggers().size(), 2U);
}

}  // namespace
}  // namespace isotherm
