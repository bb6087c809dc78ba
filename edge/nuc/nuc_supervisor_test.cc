// Transitions of the state diagram in nuc_supervisor.h. A row of a table is a span of frames: what
// the camera shows in it, and in which state it ends.

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

struct Transition {
  const char* name;
  std::vector<std::pair<Shows, double>> before;  ///< Shown before, each for so many seconds.
  Shows then;
  NucState state;
  bool valid;
  NucSource source;
};

class TransitionTest : public NucSupervisorTest, public testing::WithParamInterface<Transition> {};

TEST_P(TransitionTest, LeadsToItsState) {
  Start();
  for (const auto& [shows, seconds] : GetParam().before) Frames(shows, seconds);
  const NucStatus status = Frame(Observe(GetParam().then));
  EXPECT_EQ(status.state, GetParam().state) << ToString(status.state);
  EXPECT_EQ(status.valid, GetParam().valid);
  EXPECT_EQ(status.source, GetParam().source) << ToString(status.source);
}

using S = Shows;
using N = NucSource;
const Transition kTransitions[] = {
    {"FirstFrameIsIdle", {}, S::kScene, kIdle, true, N::kUnknown},
    {"ClosesByFlag", {{S::kScene, 1}}, S::kShutFlag, kInProgress, false, N::kInBand},
    {"ClosesByCamera", {{S::kSaysIdle, 1}}, S::kSaysClosed, kInProgress, false, N::kInBand},
    {"ClosesByPolling", {{S::kSaysIdle, 1}}, S::kPolledClosed, kInProgress, false, N::kPolled},
    {"ClosesByFrozenImages", {{S::kScene, 1}}, S::kFrozen, kInProgress, false, N::kInferred},
    {"ClosesByUniformImage", {{S::kScene, 1}}, S::kUniform, kInProgress, false, N::kInferred},
    {"UniformIsASceneIfTheCameraTells", {{S::kSaysIdle, 1}}, S::kUniform, kIdle, true, N::kUnknown},
    {"FrozenCountsEvenIfTheCameraTells",
     {{S::kSaysIdle, 1}},
     S::kFrozen,
     kInProgress,
     false,
     N::kInferred},
    {"OpensToSettling", {{S::kShutFlag, 0.4}}, S::kScene, kSettling, false, N::kInBand},
    {"SettlesForItsTime",
     {{S::kShutFlag, 0.4}, {S::kScene, 0.5}},
     S::kScene,
     kIdle,
     true,
     N::kInBand},
    {"NotAFrameSooner",
     {{S::kShutFlag, 0.4}, {S::kScene, 0.475}},
     S::kScene,
     kSettling,
     false,
     N::kInBand},
    {"ClosesAgainWhileSettling",
     {{S::kShutFlag, 0.4}, {S::kScene, 0.3}},
     S::kShutFlag,
     kInProgress,
     false,
     N::kInBand},
    {"NeverEnds", {{S::kShutFlag, 5.025}}, S::kShutFlag, kError, false, N::kInBand},
    {"LongButInTime", {{S::kShutFlag, 4.95}}, S::kShutFlag, kInProgress, false, N::kInBand},
    {"EndsAfterAll", {{S::kShutFlag, 8}}, S::kScene, kSettling, false, N::kInBand},
    {"DesiredByCamera", {{S::kSaysIdle, 1}}, S::kSaysDesired, kDesired, true, N::kInBand},
    {"AnnouncedByCamera", {{S::kSaysIdle, 1}}, S::kSaysImminent, kImminent, true, N::kInBand},
    {"BlockedByCamera", {{S::kSaysIdle, 1}}, S::kSaysBlocked, kBlocked, true, N::kInBand},
    {"ErrorOfCamera", {{S::kSaysIdle, 1}}, S::kSaysError, kError, false, N::kInBand},
};
INSTANTIATE_TEST_SUITE_P(NucSupervisorTest, TransitionTest, testing::ValuesIn(kTransitions),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_F(NucSupervisorTest, ARequiredFirstNucMakesFramesInvalidUntilThen) {
  options_.mutable_expert()->set_require_initial_nuc(true);
  Start(NucSupervisor::Role::kFollow);
  EXPECT_EQ(Frames(S::kScene, 10).state, kUnknown);
  EXPECT_FALSE(last_.valid);
  Frames(S::kShutFlag, 0.4);
  EXPECT_FALSE(Frame(Observe(S::kScene)).valid);
  EXPECT_TRUE(Frames(S::kScene, 0.55).valid);
}

TEST_F(NucSupervisorTest, CountsSecondsFromTheOpeningOfTheShutter) {
  Start();
  EXPECT_EQ(Frame(Observe(S::kScene)).seconds_since_nuc, std::nullopt);
  Frames(S::kShutFlag, 0.4);
  EXPECT_DOUBLE_EQ(Frame(Observe(S::kScene)).seconds_since_nuc.value(), 0.0);
  Frames(S::kScene, 1.25);
  EXPECT_DOUBLE_EQ(last_.seconds_since_nuc.value(), 1.25);
}

TEST_F(NucSupervisorTest, TakesTheCamerasAgeUntilItHasSeenACorrection) {
  Start();
  NucObservation seen = Observe(S::kSaysIdle);
  seen.camera->seconds_since = 77.0;
  EXPECT_EQ(Frame(seen).seconds_since_nuc, 77.0);
}

TEST_F(NucSupervisorTest, SwitchesTheCamerasOwnCorrectionsOffAndSaysIfItCannot) {
  answer_ = FailedPrecondition("it is a Seek");
  Start();
  Frames(S::kSaysIdle, 5);
  ASSERT_EQ(orders_.size(), 1U) << "once, not with every frame";
  EXPECT_EQ(orders_[0].first, NucOrder::kAutomaticOff);
  EXPECT_THAT(notices_, HasSubstr("cannot be switched off: it is a Seek"));
}

TEST_F(NucSupervisorTest, F07ACorrectionThatTheCameraRunsByItselfIsReported) {
  Start();
  Frames(S::kSaysIdle, 1);
  Frames(S::kSaysClosed, 0.4);
  Frames(S::kSaysIdle, 1);
  EXPECT_THAT(notices_, AllOf(HasSubstr("shutter closed, not ordered by us, known by its frames"),
                              HasSubstr("shutter open after 0.40 s")));
}

TEST_F(NucSupervisorTest, BeforeTheScanACorrectionIsOrderedAndWaitedFor) {
  options_.set_before_scan(true);
  Start();
  Frame(Observe(S::kSaysIdle));
  EXPECT_FALSE(last_.valid);
  EXPECT_EQ(Frame(Observe(S::kSaysIdle)).order, NucOrder::kTrigger);
  EXPECT_EQ(Frame(Observe(S::kSaysIdle)).state, kImminent);
  EXPECT_FALSE(last_.valid) << "announced, but the first one is still to come";
  Frames(S::kSaysClosed, 0.4);
  EXPECT_FALSE(Frame(Observe(S::kSaysIdle)).valid);
  EXPECT_TRUE(Frames(S::kSaysIdle, 0.55).valid);
  Frames(S::kSaysIdle, 60);
  EXPECT_EQ(Triggers().size(), 1U);
  EXPECT_THAT(notices_, AllOf(HasSubstr("ordered: start of the scan"), HasSubstr("as ordered")));
}

TEST_F(NucSupervisorTest, ACameraThatTakesNoOrdersScansWithoutAFirstCorrection) {
  options_.set_before_scan(true);
  answer_ = FailedPrecondition("no shutter to command");
  Start();
  Frames(S::kSaysIdle, 1);
  EXPECT_EQ(last_.state, kIdle);
  EXPECT_TRUE(last_.valid);
  EXPECT_THAT(notices_, HasSubstr("no first correction: the scan goes on without"));
  Frames(S::kSaysIdle, 60);
  EXPECT_EQ(Triggers().size(), 1U);
}

TEST_F(NucSupervisorTest, AnOrderThatIsNotFollowedIsRepeatedSomeTimesAndThenBlocked) {
  options_.set_max_interval_s(20);
  Start();
  Frames(S::kSaysIdle, 21);
  EXPECT_EQ(last_.state, kImminent);
  Frames(S::kSaysIdle, 4);
  EXPECT_EQ(last_.state, kDesired) << "waits for the next attempt";
  Frames(S::kSaysIdle, 600);
  EXPECT_EQ(last_.state, kBlocked);
  EXPECT_TRUE(last_.valid) << "no worse than without an order";
  EXPECT_EQ(Triggers().size(), 3U);
  EXPECT_THAT(notices_, HasSubstr("did not close within 3.0 s (attempt 3 of 3)"));
  EXPECT_THAT(supervisor_->reason(), HasSubstr("does not follow"));
  // Asking for it tries again.
  EXPECT_EQ(supervisor_->Request().value(), "");
  EXPECT_EQ(Frame(Observe(S::kSaysIdle)).order, NucOrder::kTrigger);
}

TEST_F(NucSupervisorTest, DriftOfTheHousingMakesACorrectionDue) {
  Start();
  Frames(S::kSaysIdle, 1);
  housing_celsius_ += 0.45F;
  Frames(S::kSaysIdle, 1);
  EXPECT_TRUE(Triggers().empty());
  housing_celsius_ += 0.1F;
  Frames(S::kSaysIdle, 0.1);
  EXPECT_EQ(Triggers().size(), 1U);
  EXPECT_THAT(notices_, HasSubstr("the housing is +0.55 K off"));
  Frames(S::kSaysClosed, 0.4);
  Frames(S::kSaysIdle, 60);
  EXPECT_EQ(Triggers().size(), 1U) << "the reference is the last correction";
}

TEST_F(NucSupervisorTest, DriftOfTheDetectorMakesACorrectionDue) {
  Start();
  NucObservation seen = Observe(S::kSaysIdle);
  seen.housekeeping.fpa_celsius = 34.0F;
  Frame(seen);
  seen.housekeeping.fpa_celsius = 32.9F;
  Frame(seen);
  EXPECT_EQ(Triggers().size(), 1U);
  EXPECT_THAT(notices_, HasSubstr("the detector is -1.10 K off"));
}

TEST_F(NucSupervisorTest, TheIntervalCountsFromTheLastCorrection) {
  options_.set_max_interval_s(100);
  Start();
  Frames(S::kSaysIdle, 50);
  Frames(S::kSaysClosed, 0.4);
  const CaptureTime opened = now_;
  Frames(S::kSaysIdle, 101);
  ASSERT_EQ(Triggers().size(), 1U);
  EXPECT_NEAR(ToSeconds(Triggers()[0] - opened), 100.0, 2 * ToSeconds(kPeriod));
}

}  // namespace
}  // namespace isotherm
