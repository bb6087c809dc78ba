#include "common/stamping/median_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

namespace isotherm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kDepthWindow = 15;
// The wall clock when the camera's counter was zero.
constexpr CaptureTime kEpoch{seconds(1'700'000'000)};

DeviceTicks Ticks(microseconds since_zero) { return DeviceTicks(since_zero); }

/// A seed that the log shows and ISOTHERM_TEST_SEED repeats.
unsigned Seed() {
  const char* given = std::getenv("ISOTHERM_TEST_SEED");
  const unsigned seed =
      given != nullptr ? static_cast<unsigned>(std::atoi(given)) : std::random_device{}();
  std::printf("ISOTHERM_TEST_SEED=%u\n", seed);
  return seed;
}

struct Sample {
  DeviceTicks ticks;
  CaptureTime arrival;
};

/// Frames at 30 Hz whose arrivals scatter as in fig. 5.15 of the thesis: a millisecond of noise and
/// now and then an impulse of up to 20 ms.
std::vector<Sample> JitteredFrames(int count, double noise_s, double impulse_fraction,
                                   unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_s);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    const microseconds time = i * microseconds(33'333);
    double delay_s = 0.040 + noise(random);
    if (uniform(random) < impulse_fraction) delay_s += 0.020 * uniform(random);
    samples.push_back({Ticks(time), kEpoch + time + FromSeconds(delay_s)});
  }
  return samples;
}

/// (5.4) as it is written: sort the last N differences and take the middle.
std::vector<CaptureTime> ReferenceStamps(const std::vector<Sample>& samples, std::size_t window) {
  std::vector<CaptureTime> stamps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<std::int64_t> differences;
    for (std::size_t j = i + 1 > window ? i + 1 - window : 0; j <= i; ++j) {
      differences.push_back(
          (samples[j].arrival.time_since_epoch() - Nanoseconds(samples[j].ticks.time_since_epoch()))
              .count());
    }
    std::sort(differences.begin(), differences.end());
    const std::size_t n = differences.size();
    const std::int64_t lower = differences[(n - 1) / 2];
    const std::int64_t median = lower + (differences[n / 2] - lower) / 2;
    stamps.push_back(CaptureTime(samples[i].ticks.time_since_epoch() + Nanoseconds(median)));
  }
  return stamps;
}

double StandardDeviation(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double variance = 0.0;
  for (const double value : values) {
    variance += (value - mean) * (value - mean) / static_cast<double>(values.size());
  }
  return std::sqrt(variance);
}

TEST(MedianClockTest, EqualsTheMedianAsItIsDefined) {
  for (const int window : {1, 2, 15, 21}) {
    const std::vector<Sample> samples = JitteredFrames(400, 0.001, 0.05, Seed());
    const std::vector<CaptureTime> expected =
        ReferenceStamps(samples, static_cast<std::size_t>(window));
    MedianClock clock(window);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Stamp stamp = clock.Process(samples[i].ticks, samples[i].arrival);
      ASSERT_EQ(ToNanoseconds(stamp.time), ToNanoseconds(expected[i]))
          << "window " << window << " frame " << i;
    }
  }
}

TEST(MedianClockTest, TheFirstFrameGetsItsOwnArrival) {
  MedianClock clock(kDepthWindow);
  const Stamp stamp = clock.Process(Ticks(seconds(5)), kEpoch);
  EXPECT_EQ(stamp.time, kEpoch);
  EXPECT_EQ(stamp.sigma, Nanoseconds(0)) << "one frame says nothing about the spread";
}

TEST(MedianClockTest, EqualTicksAndArrivalPassUnchanged) {
  MedianClock clock(kDepthWindow);
  for (int i = 0; i < 100; ++i) {
    const microseconds time = kEpoch.time_since_epoch() / microseconds(1) * microseconds(1) +
                              i * microseconds(33'333 + i);
    EXPECT_EQ(clock.Process(Ticks(time), CaptureTime(time)).time, CaptureTime(time));
  }
}

TEST(MedianClockTest, ASingleLateFrameDoesNotMoveTheStamps) {
  MedianClock clock(kDepthWindow);
  for (int i = 0; i < 60; ++i) {
    const microseconds time = i * microseconds(33'333);
    const Nanoseconds stall = i == 30 ? milliseconds(200) : milliseconds(0);
    EXPECT_EQ(clock.Process(Ticks(time), kEpoch + time + stall).time, kEpoch + time) << i;
  }
}

TEST(MedianClockTest, JitterShrinksAsInTheThesis) {
  // Figures 5.15 and 5.16: impulses vanish, noise shrinks by about sqrt(N) / 1.25.
  constexpr double kNoise_s = 0.001;
  const std::vector<Sample> samples = JitteredFrames(3000, kNoise_s, 0.02, Seed());
  MedianClock clock(kDepthWindow);
  std::vector<double> errors_s;
  double worst_s = 0.0;
  double sigma_sum_s = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Stamp stamp = clock.Process(samples[i].ticks, samples[i].arrival);
    if (i < kDepthWindow) continue;
    const CaptureTime truth = kEpoch + samples[i].ticks.time_since_epoch() + milliseconds(40);
    errors_s.push_back(ToSeconds(stamp.time - truth));
    worst_s = std::max(worst_s, std::abs(errors_s.back()));
    sigma_sum_s += ToSeconds(stamp.sigma);
  }
  const double deviation_s = StandardDeviation(errors_s);
  const double mean_sigma_s = sigma_sum_s / static_cast<double>(errors_s.size());
  // The standard error of a median of 15 is 0.32 of one sample's; 3000 overlapping windows scatter
  // by a tenth.
  EXPECT_NEAR(deviation_s / kNoise_s, 0.33, 0.08);
  EXPECT_LT(worst_s, 0.002) << "an impulse came through";
  EXPECT_NEAR(mean_sigma_s / deviation_s, 1.0, 0.35)
      << "sigma does not say how uncertain the stamps are";
}

TEST(MedianClockTest, F09CounterResetStartsTheFilterAgainAtThatFrame) {
  MedianClock clock(kDepthWindow);
  for (int i = 0; i < 100; ++i) {
    const microseconds time = i * microseconds(33'333);
    const microseconds ticks = i < 50 ? time + seconds(4000) : time - 50 * microseconds(33'333);
    const CaptureTime stamp = clock.Process(Ticks(ticks), kEpoch + time).time;
    EXPECT_EQ(stamp, kEpoch + time) << i;
  }
  EXPECT_EQ(clock.resets(), 1U);
}

}  // namespace
}  // namespace isotherm
