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
  Novelty Next(FrameNovelty& novelty, std::uint16_t picture,
               std::optional<std::uint64_t> counter = std::nullopt) {
    RawThermalFrame frame;
    frame.counts = Image<std::uint16_t>(4, 3, picture);
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

TEST_F(FrameNoveltyTest, F05MoreThanThreeTimesTheNativeRepeatsIsFrozen) {
  for (const int native : {1, 2, 3}) {
    FrameNovelty novelty(0, native);
    Next(novelty, 1);
    for (int i = 0; i < 3 * native; ++i) EXPECT_EQ(Next(novelty, 1).kind, Kind::kRepeat);
    const Novelty frozen = Next(novelty, 1);
    EXPECT_EQ(frozen.kind, Kind::kFrozen);
    EXPECT_EQ(frozen.frozen_for, (3 * native + 1) * kPeriod);
    EXPECT_EQ(Next(novelty, 2).kind, Kind::kNew);
    EXPECT_EQ(Next(novelty, 2).kind, Kind::kRepeat);
  }
}

TEST_F(FrameNoveltyTest, F05StalledCounterIsFrozenWhateverThePixels) {
  FrameNovelty novelty(3, 1);
  for (std::uint16_t i = 0; i < 4; ++i) Next(novelty, i, 100);
  EXPECT_EQ(Next(novelty, 5, 100).kind, Kind::kFrozen);
}

TEST_F(FrameNoveltyTest, F05SamePixelsAreFrozenWhateverTheCounter) {
  FrameNovelty novelty(3, 1);
  for (std::uint64_t i = 0; i < 4; ++i) Next(novelty, 1, 3 * i);
  EXPECT_EQ(Next(novelty, 1, 12).kind, Kind::kFrozen);
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
