#include "ground/service/health.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

class HealthTest : public ::testing::Test {
 protected:
  std::optional<GroundThread> StuckBeforeEnd(GroundThread awaited) const {
    return health_.StuckBeforeEnd(awaited, now_);
  }
  const SteadyTime begin_ = SteadyTime(1000s);
  const SteadyTime now_ = begin_ + 100s;
  Health health_{200s};
};

TEST_F(HealthTest, WhatOthersAreStuckAtKeepsNobodyFromItsEnd) {
  health_.results.Busy(begin_);
  health_.recording.Busy(begin_);
  health_.reconstruction.Busy(now_ - 1s);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kReception), std::nullopt);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kReconstruction), std::nullopt) << "it goes on";
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kResults), GroundThread::kResults);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kRecording), GroundThread::kRecording);
}

TEST_F(HealthTest, AReconstructionThatWaitsForResultsThatAreStuckNamesThem) {
  health_.reconstruction.Idle();
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kReconstruction), std::nullopt);
  health_.results.Busy(begin_);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kReconstruction), GroundThread::kResults);
  health_.reconstruction.Busy(begin_);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kReconstruction), GroundThread::kReconstruction);
}

TEST_F(HealthTest, ResultsMayTakeAsLongAsTheyGoOn) {
  health_.results.Busy(now_ - 29s);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kResults), std::nullopt);
  health_.results.Busy(now_ - 31s);
  EXPECT_EQ(StuckBeforeEnd(GroundThread::kResults), GroundThread::kResults);
}

}  // namespace
}  // namespace isotherm
