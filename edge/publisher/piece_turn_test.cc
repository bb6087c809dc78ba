#include "edge/publisher/piece_turn.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using enum PiecePriority;

constexpr double kRate_bit_s = 8e6;  // A kilobyte in a millisecond.

TEST(PieceTurnTest, PiecesLeaveEvenlyAtTheRate) {
  PieceTurn turn;
  SteadyTime now(10s);
  for (int i = 0; i < 1'000; ++i) {
    const Nanoseconds wait = turn.Take(1'000, kRate_bit_s, kLive, now);
    now += wait;
    if (wait > 0ns) {
      EXPECT_EQ(turn.Take(1'000, kRate_bit_s, kLive, now), 0ns);
    }
  }
  EXPECT_NEAR(ToSeconds(now - SteadyTime(10s)), 1.0, 0.003);
}

TEST(PieceTurnTest, ThreadsThatWakeLateLoseNothingAndPausesAreNotMadeUpFor) {
  PieceTurn turn;
  SteadyTime now(10s);
  for (int i = 0; i < 1'000; ++i) {
    now += turn.Take(1'000, kRate_bit_s, kLive, now);
    now += 300us;  // Each time.
    if (turn.Take(1'000, kRate_bit_s, kLive, now) > 0ns) continue;
  }
  now += 10s;
  int at_once = 0;
  while (turn.Take(1'000, kRate_bit_s, kLive, now) == 0ns) ++at_once;
  EXPECT_LE(at_once, 3);
}

TEST(PieceTurnTest, WhatIsLiveGoesFirst) {
  PieceTurn turn;
  const SteadyTime now(10s);
  turn.NoteLive(true);
  EXPECT_GT(turn.Take(1'000, kRate_bit_s, kBackfill, now), 0ns);
  EXPECT_EQ(turn.Take(3'000, kRate_bit_s, kLive, now), 0ns);
  turn.NoteLive(false);
  EXPECT_GT(turn.Take(1'000, kRate_bit_s, kBackfill, now), 0ns) << "the link is taken";
  EXPECT_EQ(turn.Take(1'000, kRate_bit_s, kBackfill, now + 3ms), 0ns);
}

}  // namespace
}  // namespace isotherm
