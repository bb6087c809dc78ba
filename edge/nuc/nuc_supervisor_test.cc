// Transitions of the state diagram in nuc_supervisor.h. A row of a table is a span of frames: what
// the camera shows in it, and in which state it ends.

#include "edge/nuc/nuc_supervisor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;
using enum NucState;

constexpr milliseconds kPeriod(25);  // 40 Hz.

/// What a camera shows for a while.
enum class Shows {
  kScene,     ///< The shutter is open, and the camera says nothing.
  kShutFlag,  ///< The frame says that the shutter is closed.
  kSaysIdle,  ///< A camera that tells its state in band.
  kSaysDesired,
  kSaysImminent,
  kSaysClosed,
  kSaysBlocked,
  kSaysError,
  kPolledClosed,
  kFrozen,   ///< The same picture, without a word.
  kUniform,  ///< Like the shutter, without a word.
};

NucObservation Observe(Shows shows) {
  NucObservation seen;
  const auto says = [&seen](NucState state, NucSource source = NucSource::kInBand) {
    seen.camera = CameraNuc{state, source, std::nullopt};
  };
  switch (shows) {
    case Shows::kScene:
      break;
    case Shows::kShutFlag:
      seen.shutter_closed = true;
      break;
    case Shows::kSaysIdle:
      says(kIdle);
      break;
    case Shows::kSaysDesired:
      says(kDesired);
      break;
    case Shows::kSaysImminent:
      says(kImminent);
      break;
    case Shows::kSaysClosed:
      says(kInProgress);
      break;
    case Shows::kSaysBlocked:
      says(kBlocked);
      break;
    case Shows::kSaysError:
      says(kError);
      break;
    case Shows::kPolledClosed:
      says(kInProgress, NucSource::kPolled);
      break;
    case Shows::kFrozen:
      seen.picture.is_frozen = true;
      break;
    case Shows::kUniform:
      seen.picture.is_like_shutter = true;
      break;
  }
  return seen;
}

class NucSupervisorTest : public testing::Test {
 protected:
  NucSupervisorTest() {
    options_.set_settle_time_s(0.5);
    options_.set_warm_up(NucOptions::IGNORE);
    options_.set_max_interval_s(0);
  }

  void Start(NucSupervisor::Role role = NucSupervisor::Role::kSupervise) {
    supervisor_ = std::make_unique<NucSupervisor>(options_, role);
  }
  /// One frame; orders are kept and answered with `answer_`.
  NucStatus Frame(NucObservation seen) {
    seen.time = now_;
    if (!std::isfinite(seen.housekeeping.housing_celsius))
      seen.housekeeping.housing_celsius = housing_celsius_;
    last_ = supervisor_->Update(seen);
    if (last_.order) {
      orders_.push_back({*last_.order, now_});
      supervisor_->OnAnswer(*last_.order, answer_);
    }
    for (NucNotice& notice : supervisor_->TakeNotices()) notices_ += notice.text + "\n";
    now_ += kPeriod;
    return last_;
  }
  NucStatus Frames(Shows shows, double seconds) {
    for (double t = 0.0; t < seconds - 1e-9; t += ToSeconds(kPeriod)) Frame(Observe(shows));
    return last_;
  }
  std::vector<CaptureTime> Triggers() const {
    std::vector<CaptureTime> times;
    for (const auto& [order, time] : orders_)
      if (order == NucOrder::kTrigger) times.push_back(time);
    return times;
  }

  NucOptions options_;
  std::unique_ptr<NucSupervisor> supervisor_;
  CaptureTime now_{std::chrono::hours(1)};
  float housing_celsius_ = 30.0F;
  Status answer_;
  NucStatus last_;
  std::vector<std::pair<NucOrder, CaptureTime>> orders_;
  std::string notices_;
};

struct Transition {
  const char* name;
  std::vector<std::pair<Shows, double>> before;  ///< What is shown, and for how many seconds.
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
    {"ClosesByFrozenPictures", {{S::kScene, 1}}, S::kFrozen, kInProgress, false, N::kInferred},
    {"ClosesByUniformPicture", {{S::kScene, 1}}, S::kUniform, kInProgress, false, N::kInferred},
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
  options_.set_require_initial_nuc(true);
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
  answer_ = Unavailable("it is a Seek");
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
  answer_ = Unavailable("no shutter to command");
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
  EXPECT_NEAR(supervisor_->shutter().closed_share(), 0.5, 0.05);
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
  EXPECT_NEAR(supervisor_->shutter().closed_share(), 1.0, 1e-9);
  EXPECT_EQ(notices_.find("does not end"), notices_.rfind("does not end"));
  EXPECT_NE(notices_.find("does not end"), std::string::npos);
}

TEST_F(NucSupervisorTest, WarmUpIsWarnedOfOrWaitedFor) {
  for (const auto warm_up : {NucOptions::WARN, NucOptions::WAIT}) {
    options_.set_warm_up(warm_up);
    options_.set_max_housing_drift_k(0);
    notices_.clear();
    Start();
    for (int i = 0; i < 40 * 40; ++i, housing_celsius_ += 0.001F) Frame(Observe(S::kSaysIdle));
    EXPECT_TRUE(supervisor_->is_warming_up()) << "2.4 K/min";
    EXPECT_THAT(notices_, HasSubstr("warms up by +2.4 K/min"));
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
