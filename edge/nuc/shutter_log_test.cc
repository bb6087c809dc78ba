#include "edge/nuc/shutter_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/testing/test_seed.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Nanoseconds are summed exactly; only the division rounds.
constexpr double kRounding = 1e-12;

class ShutterLogTest : public ::testing::Test {
 protected:
  /// Frames at 10 Hz for `time`; the first one comes one period after the newest before.
  void Frames(Nanoseconds time, std::optional<NucSource> closed_by) {
    for (Nanoseconds passed{0}; passed < time; passed += 100ms) {
      now_ += 100ms;
      log_.Update(now_, closed_by);
    }
  }

  ShutterLog log_;
  CaptureTime now_{1h};
};

TEST_F(ShutterLogTest, BeforeTheFirstFrameNothingWasClosed) {
  EXPECT_FALSE(log_.is_closed());
  EXPECT_EQ(log_.source(), NucSource::kUnknown);
  EXPECT_EQ(log_.closed_fraction(), 0.0);
  EXPECT_EQ(log_.opened_at(), std::nullopt);
}

TEST_F(ShutterLogTest, ClosingAndOpeningAreToldWithOneFrameEach) {
  Frames(1s, std::nullopt);
  EXPECT_FALSE(log_.just_closed() || log_.just_opened());
  Frames(100ms, NucSource::kInBand);
  EXPECT_TRUE(log_.just_closed());
  Frames(100ms, NucSource::kInBand);
  EXPECT_FALSE(log_.just_closed());
  EXPECT_TRUE(log_.is_closed());
  Frames(100ms, std::nullopt);
  EXPECT_TRUE(log_.just_opened());
  EXPECT_FALSE(log_.is_closed());
  EXPECT_EQ(log_.opened_at(), now_);
  EXPECT_EQ(log_.closed_for(), 200ms);
  Frames(100ms, std::nullopt);
  EXPECT_FALSE(log_.just_opened());
  EXPECT_EQ(log_.closed_for(), 200ms) << "the last time";
}

TEST_F(ShutterLogTest, TheSourceIsTheOneThatSaidItLast) {
  Frames(200ms, NucSource::kInferred);
  Frames(200ms, NucSource::kInBand);
  EXPECT_EQ(log_.source(), NucSource::kInBand);
  Frames(1s, std::nullopt);
  EXPECT_EQ(log_.source(), NucSource::kInBand);
  EXPECT_EQ(log_.closings(), 1U) << "who says it does not make it another closing";
}

TEST_F(ShutterLogTest, AClosingIsForgottenAMinuteAfterItsEndButCountedInAll) {
  Frames(1s, std::nullopt);
  Frames(500ms, NucSource::kInBand);
  Frames(100ms, std::nullopt);
  EXPECT_EQ(log_.closings_per_minute(), 1);
  Frames(60s, std::nullopt);
  EXPECT_EQ(log_.closings_per_minute(), 1);
  Frames(100ms, std::nullopt);
  EXPECT_EQ(log_.closings_per_minute(), 0);
  EXPECT_EQ(log_.closed_fraction(), 0.0);
  EXPECT_EQ(log_.closings(), 1U);
}

TEST_F(ShutterLogTest, AShutterThatStaysClosedFillsTheMinute) {
  Frames(100ms, NucSource::kInBand);
  EXPECT_EQ(log_.closed_fraction(), 1.0) << "from the first frame on";
  Frames(3min, NucSource::kInBand);
  EXPECT_EQ(log_.closings_per_minute(), 1);
  EXPECT_EQ(log_.closed_fraction(), 1.0);
  EXPECT_EQ(log_.closed_for(), 3min);
  Frames(30s, std::nullopt);
  EXPECT_NEAR(log_.closed_fraction(), 30.1 / 60.0, kRounding) << "open since 29.9 s";
}

TEST_F(ShutterLogTest, FractionIsTheTimeFromEachClosedFrameToTheNextOverTheLastMinute) {
  std::mt19937 random(testing::Seed());
  std::vector<std::pair<CaptureTime, bool>> frames;
  bool closed = false;
  for (int i = 0; i < 3000; ++i) {
    now_ += 1ms * (1 + random() % 100);
    if (random() % 50 == 0) closed = !closed;
    frames.emplace_back(now_, closed);
    log_.Update(now_, closed ? std::optional(NucSource::kPolled) : std::nullopt);
    if (i == 0) continue;
    const CaptureTime start = std::max(frames.front().first, now_ - 1min);
    Nanoseconds truth{0};
    for (std::size_t k = 1; k < frames.size(); ++k) {
      if (!frames[k - 1].second || frames[k].first <= start) continue;
      truth += frames[k].first - std::max(frames[k - 1].first, start);
    }
    ASSERT_NEAR(log_.closed_fraction(), ToSeconds(truth) / ToSeconds(now_ - start), kRounding)
        << "frame " << i;
  }
}

}  // namespace
}  // namespace isotherm
