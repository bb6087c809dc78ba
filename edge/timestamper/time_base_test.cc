#include "edge/timestamper/time_base.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

SourceOptions Options(SourceKind kind, double rate, bool rebase) {
  SourceOptions options;
  options.set_kind(kind);
  options.set_rate(rate);
  options.mutable_expert()->set_rebase(rebase);
  return options;
}

TEST(TimeBaseTest, CamerasAreOnTheWallClockWhateverIsSaidOfPlayback) {
  EXPECT_EQ(TimeBaseOf(Options(CAMERAS, 1.0, true)), TimeBase::kWallClock);
  EXPECT_EQ(TimeBaseOf(Options(CAMERAS, 0.0, false)), TimeBase::kWallClock);
}

TEST(TimeBaseTest, ARecordingInRealTimeIsOnTheWallClockOnlyIfItsTimesAreMovedThere) {
  for (const SourceKind kind : {REPLAY, SYNTHETIC}) {
    EXPECT_EQ(TimeBaseOf(Options(kind, 1.0, true)), TimeBase::kWallClock);
    EXPECT_EQ(TimeBaseOf(Options(kind, 1.0, false)), TimeBase::kShifted);
  }
}

TEST(TimeBaseTest, AtAnotherPaceMovingTheTimesDoesNotHelp) {
  for (const double rate : {0.0, 0.5, 2.0}) {
    EXPECT_EQ(TimeBaseOf(Options(REPLAY, rate, true)), TimeBase::kOther);
    EXPECT_EQ(TimeBaseOf(Options(REPLAY, rate, false)), TimeBase::kOther);
  }
}

}  // namespace
}  // namespace isotherm
