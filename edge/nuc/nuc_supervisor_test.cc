#include "edge/nuc/nuc_supervisor.h"

#include <gtest/gtest.h>

#include "edge/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr bool kOpen = false;
constexpr bool kClosed = true;

class NucSupervisorTest : public testing::Test {
 protected:
  NucSupervisorTest() { options_.set_settle_time_s(0.5); }

  /// Frames every 25 ms from now on, the shutter closed for the first `closed`, then one open.
  NucStatus CloseShutterFor(int closed) {
    for (int i = 0; i < closed; ++i, now_ += milliseconds(25)) supervisor_.Update(now_, kClosed);
    return supervisor_.Update(now_, kOpen);
  }

  NucOptions options_;
  CaptureTime now_{std::chrono::hours(1)};
  NucSupervisor supervisor_{options_};
};

TEST_F(NucSupervisorTest, WithoutAnyCorrectionFramesAreTakenAsCorrected) {
  const NucStatus status = supervisor_.Update(now_, kOpen);
  EXPECT_EQ(status.state, NucState::kIdle);
  EXPECT_TRUE(status.valid);
  EXPECT_EQ(status.source, NucSource::kUnknown);
  EXPECT_EQ(status.seconds_since_nuc, std::nullopt);
}

TEST_F(NucSupervisorTest, ARequiredInitialNucMakesFramesInvalidUntilThen) {
  options_.set_require_initial_nuc(true);
  NucSupervisor supervisor(options_);
  EXPECT_EQ(supervisor.Update(now_, kOpen).state, NucState::kUnknown);
  EXPECT_FALSE(supervisor.Update(now_ + std::chrono::hours(1), kOpen).valid);
  supervisor.Update(now_ + std::chrono::hours(2), kClosed);
  supervisor.Update(now_ + std::chrono::hours(3), kOpen);
  EXPECT_TRUE(supervisor.Update(now_ + std::chrono::hours(4), kOpen).valid);
}

TEST_F(NucSupervisorTest, F07FramesAreInvalidWhileTheShutterIsClosed) {
  supervisor_.Update(now_, kOpen);
  const NucStatus status = supervisor_.Update(now_ + milliseconds(25), kClosed);
  EXPECT_EQ(status.state, NucState::kInProgress);
  EXPECT_EQ(status.source, NucSource::kInBand);
  EXPECT_FALSE(status.valid);
}

TEST_F(NucSupervisorTest, F07FramesAreInvalidUntilSettled) {
  EXPECT_EQ(CloseShutterFor(15).state, NucState::kSettling);
  EXPECT_FALSE(supervisor_.Update(now_ + milliseconds(499), kOpen).valid);
  const NucStatus settled = supervisor_.Update(now_ + milliseconds(500), kOpen);
  EXPECT_EQ(settled.state, NucState::kIdle);
  EXPECT_TRUE(settled.valid);
}

TEST_F(NucSupervisorTest, CountsSecondsFromTheOpeningOfTheShutter) {
  EXPECT_DOUBLE_EQ(CloseShutterFor(15).seconds_since_nuc.value(), 0.0);
  EXPECT_DOUBLE_EQ(supervisor_.Update(now_ + milliseconds(1250), kOpen).seconds_since_nuc.value(),
                   1.25);
}

TEST_F(NucSupervisorTest, AShutterThatClosesWhileSettlingStartsAgain) {
  CloseShutterFor(15);
  now_ += milliseconds(400);
  EXPECT_EQ(supervisor_.Update(now_, kClosed).state, NucState::kInProgress);
  now_ += milliseconds(25);
  EXPECT_EQ(supervisor_.Update(now_, kOpen).state, NucState::kSettling);
  EXPECT_FALSE(supervisor_.Update(now_ + milliseconds(499), kOpen).valid);
  EXPECT_TRUE(supervisor_.Update(now_ + milliseconds(500), kOpen).valid);
}

TEST_F(NucSupervisorTest, WithoutSettleTimeTheFirstOpenFrameIsValid) {
  options_.set_settle_time_s(0.0);
  NucSupervisor supervisor(options_);
  supervisor.Update(now_, kClosed);
  EXPECT_TRUE(supervisor.Update(now_ + milliseconds(25), kOpen).valid);
}

}  // namespace
}  // namespace isotherm
