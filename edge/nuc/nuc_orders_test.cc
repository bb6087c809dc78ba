#include "edge/nuc/nuc_orders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::Field;
using State = NucOrders::State;
using Consequence = NucOrders::Consequence;

class NucOrdersTest : public testing::Test {
 protected:
  static NucOptions Options() {
    NucOptions options;
    options.mutable_expert()->set_min_interval_s(10);
    options.mutable_expert()->set_answer_s(3);
    options.mutable_expert()->set_max_attempts(2);
    return options;
  }
  /// An attempt that the camera refuses for now.
  Consequence RefusedAt(CaptureTime time) {
    orders_.Trigger(time, "drift");
    return orders_.OnAnswer(IoError("it stalls"));
  }

  NucNotices notices_;
  NucOrders orders_{Options(), notices_};
  const CaptureTime start_{std::chrono::hours(1)};
};

/// Each state of the diagram in nuc_orders.h.
enum class Before { kNone, kUnanswered, kAwaited };
enum class Event { kAccepted, kRefused, kImpossible, kShutterCloses, kTimeIsOver, kCameraAway };

struct Transition {
  Before before;
  Event event;
  State after;
};

class NucOrdersTransitionTest : public NucOrdersTest,
                                public testing::WithParamInterface<Transition> {
 protected:
  void Bring(Before before) {
    if (before == Before::kNone) return;
    orders_.Trigger(start_, "drift");
    if (before == Before::kUnanswered) return;
    ASSERT_EQ(orders_.OnAnswer(OkStatus()), Consequence::kAwaitShutter);
    orders_.Await(start_);
  }
  void Happens(Event event) {
    switch (event) {
      case Event::kAccepted:
        orders_.OnAnswer(OkStatus());
        return;
      case Event::kRefused:
        orders_.OnAnswer(IoError("it stalls"));
        return;
      case Event::kImpossible:
        orders_.OnAnswer(FailedPrecondition("no shutter to command"));
        return;
      case Event::kShutterCloses:
        return orders_.OnShutterClosed();
      case Event::kTimeIsOver:
        orders_.IsLastOneMissed(start_ + seconds(3));
        return;
      case Event::kCameraAway:
        return orders_.OnCameraAway();
    }
  }
};

TEST_P(NucOrdersTransitionTest, LeadsToItsState) {
  Bring(GetParam().before);
  Happens(GetParam().event);
  EXPECT_EQ(orders_.state(), GetParam().after);
}

INSTANTIATE_TEST_SUITE_P(
    , NucOrdersTransitionTest,
    testing::Values(Transition{Before::kNone, Event::kAccepted, State::kNone},
                    Transition{Before::kNone, Event::kRefused, State::kNone},
                    Transition{Before::kNone, Event::kShutterCloses, State::kNone},
                    Transition{Before::kNone, Event::kTimeIsOver, State::kNone},
                    // Accepted, it is awaited only if the owner says that the camera tells.
                    Transition{Before::kUnanswered, Event::kAccepted, State::kNone},
                    Transition{Before::kUnanswered, Event::kRefused, State::kNone},
                    Transition{Before::kUnanswered, Event::kImpossible, State::kNone},
                    Transition{Before::kUnanswered, Event::kShutterCloses, State::kNone},
                    Transition{Before::kUnanswered, Event::kTimeIsOver, State::kUnanswered},
                    Transition{Before::kUnanswered, Event::kCameraAway, State::kNone},
                    Transition{Before::kAwaited, Event::kAccepted, State::kAwaited},
                    Transition{Before::kAwaited, Event::kShutterCloses, State::kNone},
                    Transition{Before::kAwaited, Event::kTimeIsOver, State::kNone},
                    Transition{Before::kAwaited, Event::kCameraAway, State::kAwaited}));

TEST_F(NucOrdersTest, AnAnswerAfterTheShutterClosedHasNoConsequence) {
  orders_.Trigger(start_, "drift");
  orders_.OnShutterClosed();
  EXPECT_EQ(orders_.OnAnswer(OkStatus()), Consequence::kNothing);
}

TEST_F(NucOrdersTest, KeepTheirDistanceFromTheLastOrderAndTheLastCorrection) {
  EXPECT_TRUE(orders_.MayTrigger(start_, std::nullopt));
  RefusedAt(start_);
  EXPECT_FALSE(orders_.MayTrigger(start_ + seconds(10) - Nanoseconds(1), std::nullopt));
  EXPECT_TRUE(orders_.MayTrigger(start_ + seconds(10), std::nullopt));
  EXPECT_FALSE(orders_.MayTrigger(start_ + seconds(10), start_ + seconds(1)));
  EXPECT_EQ(orders_.EarliestTrigger(start_ + seconds(10), start_ + seconds(1)),
            start_ + seconds(11));
}

TEST_F(NucOrdersTest, NoneIsGivenWhileOneIsUnderWay) {
  orders_.Trigger(start_, "drift");
  EXPECT_FALSE(orders_.MayTrigger(start_ + seconds(100), std::nullopt));
  orders_.OnAnswer(OkStatus());
  orders_.Await(start_);
  EXPECT_FALSE(orders_.MayTrigger(start_ + seconds(100), std::nullopt));
}

TEST_F(NucOrdersTest, AreGivenUpAfterTheLastAttemptAndTriedAgainWhenAskedFor) {
  EXPECT_EQ(RefusedAt(start_), Consequence::kNothing);
  EXPECT_EQ(RefusedAt(start_ + seconds(10)), Consequence::kGiveUp);
  EXPECT_FALSE(orders_.MayTrigger(start_ + seconds(100), std::nullopt));
  orders_.Request();
  EXPECT_TRUE(orders_.MayTrigger(start_ + seconds(100), std::nullopt));
}

TEST_F(NucOrdersTest, AreGivenUpWhenTheLastOneWasNotFollowedInTime) {
  for (const bool is_last : {false, true}) {
    orders_.Trigger(start_, "drift");
    orders_.OnAnswer(OkStatus());
    orders_.Await(start_);
    EXPECT_FALSE(orders_.IsLastOneMissed(start_ + seconds(3) - Nanoseconds(1)));
    EXPECT_EQ(orders_.IsLastOneMissed(start_ + seconds(3)), is_last);
  }
}

TEST_F(NucOrdersTest, ACorrectionEndsWhatWasAskedForAndRenewsTheAttempts) {
  orders_.Request();
  RefusedAt(start_);
  orders_.Request();
  orders_.OnShutterOpened();
  EXPECT_FALSE(orders_.is_requested());
  RefusedAt(start_ + seconds(10));
  EXPECT_TRUE(orders_.has_attempts_left());
}

TEST_F(NucOrdersTest, ACameraThatTakesNoneIsNotAskedAgainAndItsRefusalKeepsNoDistance) {
  orders_.Trigger(start_, "asked for");
  EXPECT_EQ(orders_.OnAnswer(FailedPrecondition("no shutter")), Consequence::kGiveUp);
  EXPECT_TRUE(orders_.is_impossible());
  EXPECT_EQ(orders_.EarliestTrigger(start_, std::nullopt), start_);
  orders_.OnCameraAway();
  EXPECT_FALSE(orders_.is_impossible()) << "it may be another camera";
}

TEST_F(NucOrdersTest, TheCamerasOwnAreSwitchedOnceAndAgainWhenItWasAway) {
  EXPECT_EQ(orders_.SwitchAutomatic(false), NucOrder::kAutomaticOff);
  EXPECT_EQ(orders_.SwitchAutomatic(false), std::nullopt);
  EXPECT_EQ(orders_.SwitchAutomatic(true), NucOrder::kAutomaticOn);
  orders_.OnCameraAway();
  EXPECT_EQ(orders_.SwitchAutomatic(true), NucOrder::kAutomaticOn);
}

TEST_F(NucOrdersTest, WhatBecameOfThemIsNoted) {
  RefusedAt(start_);
  orders_.Trigger(start_ + seconds(10), "asked for");
  orders_.OnAnswer(OkStatus());
  orders_.Await(start_ + seconds(10));
  orders_.IsLastOneMissed(start_ + seconds(13));
  const auto text = [](const char* expected) { return Field(&NucNotice::text, expected); };
  EXPECT_THAT(
      notices_.Take(),
      ElementsAre(text("correction refused (attempt 1 of 2): it stalls"),
                  text("correction ordered: asked for"),
                  text("ordered, but the shutter did not close within 3.0 s (attempt 2 of 2)")));
}

}  // namespace
}  // namespace isotherm
