#include "common/simulation/simulated_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "common/base/noise.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 5;
const CaptureTime kStart = CaptureTimeFromNanoseconds(1'735'689'600'000'000'000);
constexpr double kRate_hz = 30.0;

class SimulatedClockTest : public ::testing::Test {
 protected:
  SimulatedClockTest() { std::cout << "seed " << kSeed << '\n'; }

  std::vector<SimulatedFrameTime> Run(int frames) {
    SimulatedClock clock(options_, kRate_hz, kStart, kStart, NoiseStream(kSeed, 2, 0));
    std::vector<SimulatedFrameTime> times;
    for (int i = 0; i < frames; ++i) times.push_back(clock.Next());
    return times;
  }
  static double DelayS(const SimulatedFrameTime& time) {
    return ToSeconds(time.arrival - time.exposure);
  }
  static double DeviceS(const SimulatedFrameTime& time) {
    return std::chrono::duration<double>(time.device_ticks.time_since_epoch()).count();
  }

  ClockOptions options_;
};

TEST_F(SimulatedClockTest, AnIdealClockAndLinkAddNothing) {
  const auto times = Run(100);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(ToSeconds(times[i].exposure - kStart), static_cast<double>(i) / kRate_hz, 1e-9);
    EXPECT_NEAR(DeviceS(times[i]), static_cast<double>(i) / kRate_hz, 1e-6);
    EXPECT_EQ(times[i].arrival, times[i].exposure);
  }
}

TEST_F(SimulatedClockTest, OffsetAndDriftShowInTheTicks) {
  options_.set_offset_s(1000.0);
  options_.set_drift_ppm(200.0);
  const auto times = Run(30 * 600);
  EXPECT_NEAR(DeviceS(times.front()), 1000.0, 1e-6);
  const double true_s = ToSeconds(times.back().exposure - kStart);
  EXPECT_NEAR(DeviceS(times.back()) - 1000.0, true_s * (1.0 + 200e-6), 2e-6);
  // The camera triggers by its own clock: equidistant ticks, a slightly shorter true period.
  EXPECT_NEAR(true_s, (30.0 * 600.0 - 1.0) / kRate_hz / (1.0 + 200e-6), 1e-6);
}

TEST_F(SimulatedClockTest, JitterHasItsMeanAndNeverArrivesEarly) {
  options_.set_delay_s(0.020);
  options_.set_jitter_s(0.002);
  const auto times = Run(20000);
  double sum = 0.0, squares = 0.0;
  for (const auto& time : times) {
    const double extra_s = DelayS(time) - 0.020;
    EXPECT_GE(extra_s, -1e-9);
    sum += extra_s;
    squares += extra_s * extra_s;
  }
  const double count = static_cast<double>(times.size());
  EXPECT_NEAR(sum / count, 0.002, 0.0001);
  EXPECT_NEAR(squares / count, 2.0 * 0.002 * 0.002, 0.4e-6);  // Exponential: second moment 2 m^2.
}

TEST_F(SimulatedClockTest, ImpulsesAreRareAndBounded) {
  options_.set_delay_s(0.020);
  options_.set_impulse_fraction(0.02);
  options_.set_impulse_max_s(0.030);
  const auto times = Run(20000);
  int impulses = 0;
  for (const auto& time : times) {
    EXPECT_LE(DelayS(time), 0.050 + 1e-9);
    impulses += DelayS(time) > 0.0201;
  }
  EXPECT_NEAR(impulses, 0.02 * 20000, 60);
}

TEST_F(SimulatedClockTest, FramesNeverOvertakeEachOther) {
  options_.set_impulse_fraction(0.3);
  options_.set_impulse_max_s(0.2);
  const auto times = Run(2000);
  for (std::size_t i = 1; i < times.size(); ++i) {
    EXPECT_GT(times[i].arrival, times[i - 1].arrival);
  }
}

TEST_F(SimulatedClockTest, TheCounterWraps) {
  options_.set_offset_s(0.5);
  options_.set_wrap_us(1'000'000);
  const auto times = Run(60);
  int wraps = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    EXPECT_LT(DeviceS(times[i]), 1.0);
    wraps += times[i].device_ticks < times[i - 1].device_ticks;
  }
  EXPECT_EQ(wraps, 2);
}

}  // namespace
}  // namespace isotherm
