// Policies, faults and warm-up of the supervisor.

#include "edge/nuc/nuc_supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/nuc/testing/supervised_camera.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;
using enum NucState;
using S = Shows;

TEST_F(NucSupervisorTest, ManualAndCameraPoliciesOrderNothingByThemselves) {
  for (const auto policy : {NucOptions::MANUAL, NucOptions::CAMERA}) {
    options_.set_policy(policy);
    options_.set_max_interval_s(5);
    Start();
    Frames(S::kSaysDesired, 30);
    EXPECT_TRUE(Triggers().empty());
    ASSERT_FALSE(orders_.empty());
    EXPECT_EQ(orders_.back().first,
              policy == NucOptions::CAMERA ? NucOrder::kAutomaticOn : NucOrder::kAutomaticOff);
  }
}

TEST_F(NucSupervisorTest, ARequestWithinTheMinimumIntervalIsDoneWhenItIsOver) {
  Start();
  Frames(S::kSaysIdle, 1);
  Frames(S::kSaysClosed, 0.4);
  const CaptureTime opened = now_;
  Frames(S::kSaysIdle, 2);
  EXPECT_THAT(supervisor_->Request().value(), HasSubstr("corrections are at least 10 s apart"));
  Frames(S::kSaysIdle, 20);
  ASSERT_EQ(Triggers().size(), 2U) << "and again, since the camera did not follow";
  EXPECT_NEAR(ToSeconds(Triggers()[0] - opened), 10.0, 2 * ToSeconds(kPeriod));
}

TEST_F(NucSupervisorTest, AHoldPutsCorrectionsOffAndIsBounded) {
  options_.set_max_interval_s(5);
  Start();
  Frames(S::kSaysIdle, 1);
  EXPECT_THAT(supervisor_->Hold(3600).value(),
              AllOf(HasSubstr("held for 60 s"), HasSubstr("most")));
  Frames(S::kSaysIdle, 50);
  EXPECT_EQ(last_.state, kDesired);
  EXPECT_THAT(supervisor_->reason(), HasSubstr("held for 1"));
  EXPECT_FALSE(supervisor_->Request().has_value());
  EXPECT_THAT(supervisor_->Hold(30).value(), HasSubstr("held for 10 s"))
      << "counted from the first";
  EXPECT_TRUE(Triggers().empty());
  Frames(S::kSaysIdle, 10.1);
  EXPECT_EQ(Triggers().size(), 1U) << "due, and no longer held";
  EXPECT_FALSE(supervisor_->Hold(10).has_value()) << "one correction must come first";
  Frames(S::kSaysClosed, 0.4);
  Frames(S::kSaysIdle, 0.1);
  EXPECT_TRUE(supervisor_->Hold(10).has_value());
  EXPECT_THAT(supervisor_->Hold(0).value(), HasSubstr("not held"));
}

TEST_F(NucSupervisorTest, ACameraThatTellsNothingIsTakenAtItsOrder) {
  Start();
  Frames(S::kScene, 1);
  ASSERT_TRUE(supervisor_->Request().has_value());
  EXPECT_EQ(Frame(Observe(S::kScene)).order, NucOrder::kTrigger);
  EXPECT_EQ(Frames(S::kScene, 0.9).state, kInProgress);
  EXPECT_EQ(last_.source, NucSource::kCommanded);
  EXPECT_EQ(Frames(S::kScene, 0.2).state, kSettling);
  EXPECT_EQ(Frames(S::kScene, 0.6).state, kIdle);
}

TEST_F(NucSupervisorTest, WhoIsToldLateDoesNotTrustTheTimeBeforeTheShutterCloses) {
  Start();
  NucObservation seen = Observe(S::kSaysIdle);
  seen.camera->source = NucSource::kPolled;
  Frame(seen);
  ASSERT_TRUE(supervisor_->Request().has_value());
  Frame(seen);
  EXPECT_EQ(Frame(seen).state, kImminent);
  EXPECT_FALSE(last_.valid);
}

TEST_F(NucSupervisorTest, F05FrozenFramesAreAnErrorAndTheCameraIsOpenedAgain) {
  Start();
  Frames(S::kScene, 1);
  EXPECT_EQ(Frames(S::kFrozen, 1.9).state, kInProgress);
  EXPECT_EQ(Frames(S::kFrozen, 0.3).state, kError);
  EXPECT_FALSE(last_.valid);
  EXPECT_EQ(orders_.back().first, NucOrder::kRestartCamera);
  EXPECT_THAT(notices_, HasSubstr("thermal frames are frozen"));
  const std::size_t before = orders_.size();
  Frames(S::kFrozen, 8);
  EXPECT_EQ(orders_.size(), before) << "not again so soon";
  EXPECT_EQ(Frame(Observe(S::kScene)).state, kSettling);
}

TEST_F(NucSupervisorTest, F08AStormOfCorrectionsIsReportedWithItsDutyCycle) {
  options_.set_max_interval_s(2);
  Start();
  int closings = 0;
  while (!supervisor_->is_storm() && closings < 100) {
    Frames(S::kSaysClosed, 0.5);
    Frames(S::kSaysIdle, 0.5);
    ++closings;
  }
  EXPECT_EQ(closings, 7) << "more than six per minute";
  EXPECT_NEAR(supervisor_->shutter().closed_fraction(), 0.5, 0.05);
  EXPECT_THAT(notices_, HasSubstr("storm of corrections: 7 corrections in the last minute"));
  EXPECT_FALSE(supervisor_->Request().has_value());
  const std::size_t orders = orders_.size();
  Frames(S::kSaysIdle, 50);
  EXPECT_EQ(orders_.size(), orders) << "none is ordered on top";
  Frames(S::kSaysIdle, 15);
  EXPECT_FALSE(supervisor_->is_storm());
  EXPECT_THAT(notices_, HasSubstr("storm is over"));
}

TEST_F(NucSupervisorTest, F08AShutterThatStaysClosedIsAnErrorOnce) {
  Start();
  Frames(S::kSaysClosed, 60);
  EXPECT_EQ(last_.state, kError);
  EXPECT_NEAR(supervisor_->shutter().closed_fraction(), 1.0, 1e-9);
  EXPECT_EQ(notices_.find("does not end"), notices_.rfind("does not end"));
  EXPECT_NE(notices_.find("does not end"), std::string::npos);
}

TEST_F(NucSupervisorTest, WarmUpIsWarnedOfOrWaitedFor) {
  for (const auto warm_up : {NucOptions::WARN, NucOptions::WAIT}) {
    options_.set_warm_up(warm_up);
    options_.mutable_expert()->set_max_housing_drift_k(0);
    options_.mutable_expert()->set_warm_up_housing_stable_s(30);
    notices_.clear();
    Start();
    for (int i = 0; i < 40 * 40; ++i, housing_celsius_ += 0.001F) Frame(Observe(S::kSaysIdle));
    EXPECT_TRUE(supervisor_->is_warming_up()) << "2.4 K/min";
    EXPECT_THAT(notices_, HasSubstr("housing changes by +2.40 K/min"));
    EXPECT_EQ(last_.valid, warm_up == NucOptions::WARN);
    Frames(S::kSaysIdle, 40);
    EXPECT_TRUE(last_.valid);
    EXPECT_THAT(notices_, HasSubstr("is warm"));
  }
}

TEST_F(NucSupervisorTest, ACameraThatWasAwayGetsItsModeAndItsFirstCorrectionAgain) {
  options_.set_before_scan(true);
  Start();
  Frames(S::kSaysIdle, 0.1);
  Frames(S::kSaysClosed, 0.4);
  Frames(S::kSaysIdle, 20);
  ASSERT_TRUE(last_.valid);
  const std::size_t orders = orders_.size();
  now_ += std::chrono::seconds(3);
  EXPECT_FALSE(Frame(Observe(S::kSaysIdle)).valid);
  Frame(Observe(S::kSaysIdle));
  ASSERT_EQ(orders_.size(), orders + 2);
  EXPECT_EQ(orders_[orders].first, NucOrder::kAutomaticOff);
  EXPECT_EQ(orders_[orders + 1].first, NucOrder::kTrigger);
}

TEST_F(NucSupervisorTest, AWallClockThatJumpsBackDoesNotStopSettling) {
  Start();
  Frames(S::kShutFlag, 0.4);
  Frames(S::kScene, 0.2);
  now_ -= std::chrono::hours(1);
  EXPECT_TRUE(Frames(S::kScene, 0.6).valid);
}

TEST_F(NucSupervisorTest, ARecordingIsFollowedAndNeverCommanded) {
  options_.set_before_scan(true);
  options_.set_max_interval_s(1);
  Start(NucSupervisor::Role::kFollow);
  Frames(S::kScene, 30);
  EXPECT_EQ(last_.state, kIdle);
  EXPECT_TRUE(orders_.empty());
  EXPECT_FALSE(supervisor_->Request().has_value());
  EXPECT_FALSE(supervisor_->Hold(1).has_value());
  EXPECT_FALSE(supervisor_->SetPolicy(NucPolicy::kManual).ok());
}

}  // namespace
}  // namespace isotherm
