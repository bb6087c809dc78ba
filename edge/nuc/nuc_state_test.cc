#include "edge/nuc/nuc_state.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "common/messages/messages.h"

namespace isotherm {
namespace {

using enum NucState;

NucFacts CameraSays(NucState state, NucSource source = NucSource::kInBand) {
  NucFacts facts;
  facts.camera = CameraNuc{state, source, std::nullopt};
  return facts;
}

TEST(NucStateTest, WithoutAnythingToSayItIsIdleAndValid) {
  EXPECT_EQ(StateFrom({}), kIdle);
  EXPECT_TRUE(IsValid(kIdle, {}));
}

TEST(NucStateTest, WhatForbidsMoreWins) {
  // As the documentation's table: each row is added to those below it.
  NucFacts facts;
  const std::pair<std::function<void()>, NucState> rows[] = {
      {[&] { facts.is_due = true; }, kDesired},
      {[&] { facts.waits_for_first = true; }, kUnknown},
      {[&] { facts.is_given_up = true; }, kBlocked},
      {[&] { facts.is_ordered = true; }, kImminent},
      {[&] { facts.is_settling = true; }, kSettling},
      {[&] { facts.is_closed = true; }, kInProgress},
      {[&] { facts.is_stuck = true; }, kError},
  };
  for (const auto& [add, state] : rows) {
    add();
    EXPECT_EQ(StateFrom(facts), state) << ToString(StateFrom(facts));
  }
}

TEST(NucStateTest, ACameraThatIsNotWarmIsUnknownWhateverIsDue) {
  EXPECT_EQ(StateFrom({.waits_for_warm_up = true, .is_due = true}), kUnknown);
}

TEST(NucStateTest, WhatTheCameraSaysOfItselfIsFollowed) {
  for (const NucState state : {kDesired, kImminent, kSettling, kBlocked, kError}) {
    EXPECT_EQ(StateFrom(CameraSays(state)), state) << ToString(state);
  }
  // Its word about the shutter is weighed against others before.
  for (const NucState state : {kUnknown, kIdle, kInProgress}) {
    EXPECT_EQ(StateFrom(CameraSays(state)), kIdle) << ToString(state);
  }
}

TEST(NucStateTest, OnlyThreeStatesAreValidWhoeverTellsOfTheShutter) {
  const NucFacts told = {.is_shutter_reported = true};
  for (const NucFacts& facts : {NucFacts{}, told}) {
    for (const NucState state : {kUnknown, kInProgress, kSettling, kError})
      EXPECT_FALSE(IsValid(state, facts)) << ToString(state);
    for (const NucState state : {kIdle, kDesired, kBlocked})
      EXPECT_TRUE(IsValid(state, facts)) << ToString(state);
  }
}

TEST(NucStateTest, BeforeACorrectionFramesAreValidIfEachTellsOfTheShutter) {
  EXPECT_TRUE(IsValid(kImminent, CameraSays(kIdle, NucSource::kInBand)));
  EXPECT_FALSE(IsValid(kImminent, CameraSays(kIdle, NucSource::kPolled)));
  EXPECT_FALSE(IsValid(kImminent, CameraSays(kIdle, NucSource::kInferred)));
  EXPECT_TRUE(IsValid(kImminent, {.is_shutter_reported = true}));
  EXPECT_FALSE(IsValid(kImminent, {}));
}

TEST(NucStateTest, NothingIsValidWhileAFirstCorrectionOrAWarmUpIsWaitedFor) {
  for (const NucState state : {kIdle, kDesired, kBlocked, kImminent}) {
    EXPECT_FALSE(IsValid(state, {.waits_for_first = true, .is_shutter_reported = true}));
    EXPECT_FALSE(IsValid(state, {.waits_for_warm_up = true, .is_shutter_reported = true}));
  }
}

}  // namespace
}  // namespace isotherm
