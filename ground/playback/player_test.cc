#include "ground/playback/player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/codec/codec.h"
#include "common/testing/temporary_directory.h"
#include "ground/options/option_geometry.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int kFrames = 5;
/// Frames of the recording are so far apart.
constexpr Nanoseconds kPeriod = 100ms;
constexpr double kDuration_s = 0.4;
/// Times are kept in nanoseconds.
constexpr double kRounding_s = 1e-6;

/// A recording of five depth frames at 10 Hz, and a player of it with a clock that the test turns.
class PlayerTest : public ::testing::Test {
 protected:
  PlayerTest() {
    VolumeOptions& volume = *options_.mutable_volume();
    volume = testing::SmallVolume();
    *volume.mutable_expert()->mutable_initial_pose() = ToOptions(testing::FirstPose());
    options_.mutable_calibration_check()->mutable_expert()->set_enabled(false);
    options_.set_threads(1);
  }

  void Record(int depth_frames) {
    auto writer = RecordingWriter::Create(path_, {});
    ASSERT_TRUE(writer.has_value()) << writer.error().message();
    Rig rig;
    rig.depth = testing::SmallDepthCamera();
    ASSERT_TRUE((*writer)->Write(rig).ok());
    for (int i = 0; i < depth_frames; ++i) {
      const DepthFrame frame =
          testing::RenderDepth(testing::BallInCorner, *rig.depth, testing::FirstPose());
      EncodedDepthFrame depth;
      depth.header.frame_number = static_cast<std::uint64_t>(i);
      depth.header.capture_time = CaptureTime(std::chrono::seconds(1'700'000'000)) + i * kPeriod;
      depth.depth_scale = frame.depth_scale;
      depth.image = DepthEncoder().Encode(frame.depth_raw);
      ASSERT_TRUE((*writer)->Write(depth, std::nullopt).ok());
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }
  void Open() {
    Record(kFrames);
    auto player = Player::Open(clock_, options_, path_, feed_);
    ASSERT_TRUE(player.has_value()) << player.error().message();
    player_ = std::move(*player);
  }
  /// Does what is due now.
  void Settle() {
    while (player_->Step() == 0ns) {
    }
  }
  void Advance(Nanoseconds duration) {
    clock_.Advance(duration);
    Settle();
  }
  void SeekTo(double position_s) {
    live::PlaybackControl control;
    control.set_position_s(position_s);
    player_->Control(control);
    Settle();
  }
  void SetSpeed(double speed) {
    live::PlaybackControl control;
    control.set_speed(speed);
    player_->Control(control);
    Settle();
  }
  double position_s() const { return player_->state().position_s(); }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "scan.mcap";
  FakeClock clock_{CaptureTime(1000s)};
  GroundOptions options_;
  ConsoleInbox inbox_;
  ConsoleFeed feed_{options_, clock_, inbox_};
  std::unique_ptr<Player> player_;
};

TEST_F(PlayerTest, FramesArePlayedWhenTheirTimeHasCome) {
  Open();
  Settle();
  EXPECT_NEAR(position_s(), 0.0, kRounding_s);
  Advance(kPeriod);
  EXPECT_NEAR(position_s(), 0.1, kRounding_s);
  Advance(kPeriod / 2);
  EXPECT_NEAR(position_s(), 0.1, kRounding_s);
  Advance(kPeriod / 2);
  EXPECT_NEAR(position_s(), 0.2, kRounding_s);
}

TEST_F(PlayerTest, AtTwiceTheSpeedTheyComeInHalfTheTime) {
  Open();
  Settle();
  SetSpeed(2.0);
  Advance(kPeriod / 2);
  EXPECT_NEAR(position_s(), 0.1, kRounding_s);
  Advance(kPeriod);
  EXPECT_NEAR(position_s(), 0.3, kRounding_s);
}

TEST_F(PlayerTest, SpeedsEndAtAQuarterAndAtEight) {
  Open();
  SetSpeed(100.0);
  EXPECT_EQ(player_->state().speed(), 8.0);
  SetSpeed(0.0);
  EXPECT_EQ(player_->state().speed(), 0.25);
  SetSpeed(NAN);
  EXPECT_EQ(player_->state().speed(), 0.25);
}

TEST_F(PlayerTest, PausedItStandsStill) {
  Open();
  Settle();
  live::PlaybackControl control;
  control.set_playing(false);
  player_->Control(control);
  Advance(10 * kPeriod);
  EXPECT_NEAR(position_s(), 0.0, kRounding_s);
}

TEST_F(PlayerTest, AtTheEndItStops) {
  Open();
  for (int i = 0; i < kFrames; ++i) Advance(kPeriod);
  EXPECT_NEAR(position_s(), kDuration_s, kRounding_s);
  EXPECT_NEAR(player_->state().duration_s(), kDuration_s, kRounding_s);
  EXPECT_FALSE(player_->state().playing());
}

TEST_F(PlayerTest, ForwardsTheScanGoesOnAndBackwardsItBeginsAnew) {
  Open();
  Settle();
  const std::uint64_t scan = feed_.scan();
  SeekTo(0.25);
  EXPECT_EQ(feed_.scan(), scan);
  EXPECT_NEAR(position_s(), 0.25, kRounding_s);
  SeekTo(0.15);
  EXPECT_EQ(feed_.scan(), scan + 1);
  EXPECT_NEAR(position_s(), 0.15, kRounding_s);
  SeekTo(NAN);
  EXPECT_NEAR(position_s(), 0.15, kRounding_s);
}

TEST_F(PlayerTest, ARecordingWithoutDepthIsRefusedInWords) {
  Record(0);
  const auto player = Player::Open(clock_, options_, path_, feed_);
  ASSERT_FALSE(player.has_value());
  EXPECT_THAT(player.error().message(), HasSubstr("no depth frames"));
}

}  // namespace
}  // namespace isotherm
