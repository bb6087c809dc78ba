#include "edge/thermal_camera/frame_novelty.h"

#include <gtest/gtest.h>

#include "edge/thermal_camera/counter.h"

namespace isotherm {
namespace {

using Kind = Novelty::Kind;
constexpr Nanoseconds kPeriod = std::chrono::milliseconds(100);

/// Frames 100 ms apart.
class FrameNoveltyTest : public testing::Test {
 protected:
  Novelty Next(FrameNovelty& novelty, std::uint16_t image,
               std::optional<std::uint64_t> counter = std::nullopt) {
    RawThermalFrame frame;
    frame.counts = Image<std::uint16_t>(4, 3, image);
    frame.device_counter = counter;
    frame.first_packet.steady = time_;
    if (correcting_) frame.nuc = CameraNuc{NucState::kInProgress, NucSource::kInBand, {}};
    time_ += kPeriod;
    return novelty.Process(frame);
  }
  SteadyTime time_{};
  bool correcting_ = false;
};

TEST_F(FrameNoveltyTest, F06NativeDuplicatesAreRepeatsAndNoLoss) {
  FrameNovelty novelty(3, 1);
  EXPECT_EQ(Next(novelty, 1, 100).kind, Kind::kNew);
  EXPECT_EQ(Next(novelty, 1, 100).kind, Kind::kRepeat);
  const Novelty next = Next(novelty, 2, 103);
  EXPECT_EQ(next.kind, Kind::kNew);
  EXPECT_EQ(next.lost, 0U);
}

TEST_F(FrameNoveltyTest, F06WithoutCounterThePixelsDecide) {
  FrameNovelty novelty(0, 1);
  Next(novelty, 1);
  EXPECT_EQ(Next(novelty, 1).kind, Kind::kRepeat);
  EXPECT_EQ(Next(novelty, 2).kind, Kind::kNew);
}

TEST_F(FrameNoveltyTest, F05ThreeTimesTheNativeRepeatsIsFrozen) {
  for (const int native : {1, 2, 3}) {
    FrameNovelty novelty(0, native);
    Next(novelty, 1);
    for (int i = 1; i < 3 * native; ++i) EXPECT_EQ(Next(novelty, 1).kind, Kind::kRepeat);
    const Novelty frozen = Next(novelty, 1);
    EXPECT_EQ(frozen.kind, Kind::kFrozen);
    EXPECT_EQ(frozen.frozen_for, 3 * native * kPeriod);
    EXPECT_EQ(Next(novelty, 2).kind, Kind::kNew);
    EXPECT_EQ(Next(novelty, 2).kind, Kind::kRepeat);
  }
}

TEST_F(FrameNoveltyTest, F05StalledCounterIsFrozenWhateverThePixels) {
  FrameNovelty novelty(3, 1);
  for (std::uint16_t i = 0; i < 3; ++i) Next(novelty, i, 100);
  EXPECT_EQ(Next(novelty, 5, 100).kind, Kind::kFrozen);
}

TEST_F(FrameNoveltyTest, F05SamePixelsAreFrozenWhateverTheCounter) {
  FrameNovelty novelty(3, 1);
  for (std::uint64_t i = 0; i < 3; ++i) Next(novelty, 1, 3 * i);
  EXPECT_EQ(Next(novelty, 1, 9).kind, Kind::kFrozen);
}

TEST_F(FrameNoveltyTest, CountsWhatTheCameraCountedAndDidNotArrive) {
  FrameNovelty novelty(3, 1);
  Next(novelty, 1, 100);
  EXPECT_EQ(Next(novelty, 2, 112).lost, 3U);
  // The step is the nominal one: now and then it is one less or more.
  EXPECT_EQ(Next(novelty, 3, 114).lost, 0U);
  EXPECT_EQ(Next(novelty, 4, 118).lost, 0U);
}

TEST_F(FrameNoveltyTest, F09ResetCounterIsNoLoss) {
  FrameNovelty novelty(3, 1);
  Next(novelty, 1, 1'000);
  const Novelty next = Next(novelty, 2, 3);
  EXPECT_EQ(next.kind, Kind::kNew);
  EXPECT_EQ(next.lost, 0U);
}

TEST_F(FrameNoveltyTest, F09AFlippedBitOfTheCounterCostsNoNumbers) {
  // Beyond what a bit can add or take while it still looks like frames that were lost: 3 * 1000.
  for (int bit = 12; bit < 32; ++bit) {
    FrameNovelty novelty(3, 1);
    std::uint64_t lost = 0;
    std::uint64_t counter = 1'000'000'000;
    for (int i = 0; i < 20; ++i, counter += 3) {
      const std::uint64_t flipped = counter ^ (i == 7 ? std::uint64_t{1} << bit : 0U);
      const Novelty next = Next(novelty, static_cast<std::uint16_t>(i), flipped);
      EXPECT_EQ(next.kind, Kind::kNew) << "bit " << bit << ", frame " << i;
      lost += next.lost;
    }
    EXPECT_EQ(lost, 0U) << "bit " << bit;
  }
}

TEST_F(FrameNoveltyTest, F09WhatIsLostBesideAFlippedBitIsCountedStill) {
  FrameNovelty novelty(3, 1);
  Next(novelty, 1, 3'000);
  EXPECT_EQ(Next(novelty, 2, 3'003 + (1U << 24U)).lost, 0U);
  EXPECT_EQ(Next(novelty, 3, 3'018).lost, 4U) << "3006, 3009, 3012 and 3015";
}

TEST_F(FrameNoveltyTest, F09ACounterThatWasSetForwardGoesOnFromThere) {
  FrameNovelty novelty(3, 1);
  Next(novelty, 1, 3'000);
  EXPECT_EQ(Next(novelty, 2, 9'000'000).lost, 0U);
  EXPECT_EQ(Next(novelty, 3, 9'000'003).lost, 0U);
  EXPECT_EQ(Next(novelty, 4, 9'000'012).lost, 2U);
}

TEST_F(FrameNoveltyTest, F09ACounterThatIsNoiseNeverMakesNumbersJump) {
  FrameNovelty novelty(3, 1);
  std::uint64_t lost = 0;
  std::uint32_t noise = 1;
  constexpr int kFrames = 1'000;
  for (std::uint16_t i = 0; i < kFrames; ++i) {
    noise = noise * 1'664'525 + 1'013'904'223;
    lost += Next(novelty, i, noise).lost;
  }
  // By chance a value follows another one closely: 3000 of 2^32, twice a frame.
  EXPECT_LE(lost, 3 * MissedFrames::kMaxMissed);
}

TEST_F(FrameNoveltyTest, JumpAfterACorrectionIsNoLoss) {
  FrameNovelty novelty(1, 1);
  correcting_ = true;
  Next(novelty, 1, 100);
  correcting_ = false;
  EXPECT_EQ(Next(novelty, 2, 106).lost, 0U);
}

TEST(UnwrapperTest, F09GoesOnBeyondTheWrap) {
  Unwrapper unwrapper(16);
  EXPECT_EQ(unwrapper.Process(65'530), 65'530U);
  EXPECT_EQ(unwrapper.Process(4), 65'540U);
  EXPECT_EQ(unwrapper.Process(65'000), 131'072U - 536U);
  EXPECT_EQ(unwrapper.Process(1), 131'073U);
}

TEST(UnwrapperTest, F09ResetGoesBackwards) {
  Unwrapper unwrapper(32);
  EXPECT_EQ(unwrapper.Process(60'000), 60'000U);
  EXPECT_EQ(unwrapper.Process(115), 115U);
  EXPECT_EQ(unwrapper.Process(230), 230U);
}

}  // namespace
}  // namespace isotherm
