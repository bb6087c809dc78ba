#include "ground/link_emulator/packet_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr SteadyTime kBegin{1000s};
constexpr std::size_t kPacket_bytes = 1250;

/// Holds what became of packets that were sent at even intervals.
struct Sent {
  std::vector<SteadyTime> sent;
  std::vector<std::vector<SteadyTime>> arrived;  ///< By packet.

  double LostFraction() const {
    const auto lost = std::ranges::count_if(arrived, [](const auto& at) { return at.empty(); });
    return static_cast<double>(lost) / static_cast<double>(arrived.size());
  }
  /// Returns the mean length of runs of packets that got lost.
  double MeanRun() const {
    double lost = 0.0, runs = 0.0;
    bool before = false;
    for (const auto& at : arrived) {
      lost += at.empty() ? 1.0 : 0.0;
      runs += at.empty() && !before ? 1.0 : 0.0;
      before = at.empty();
    }
    return lost / runs;
  }
};

Sent SendAll(const PathProperties& properties, int packets, Nanoseconds interval,
             std::uint64_t seed = 1) {
  PacketPath path(seed);
  path.Set(properties);
  Sent all;
  for (int i = 0; i < packets; ++i) {
    all.sent.push_back(kBegin + i * interval);
    const PacketPath::Arrivals arrivals = path.Send(all.sent.back(), kPacket_bytes);
    all.arrived.emplace_back(arrivals.times().begin(), arrivals.times().end());
  }
  return all;
}

TEST(PacketPathTest, WithoutPropertiesAllArrivesAtOnce) {
  const Sent all = SendAll({}, 100, 1ms);
  for (std::size_t i = 0; i < all.sent.size(); ++i)
    EXPECT_EQ(all.arrived[i], std::vector{all.sent[i]});
}

TEST(PacketPathTest, DelayIsTheSameForAllAndKeepsTheirOrder) {
  const Sent all = SendAll({.delay = 20ms}, 100, 1ms);
  for (std::size_t i = 0; i < all.sent.size(); ++i)
    EXPECT_EQ(all.arrived[i], std::vector{all.sent[i] + 20ms});
}

TEST(PacketPathTest, JitterIsEvenAndLetsPacketsOvertake) {
  const Sent all = SendAll({.delay = 20ms, .jitter = 10ms}, 10000, 1ms);
  double sum_s = 0.0;
  int overtaken = 0;
  for (std::size_t i = 0; i < all.sent.size(); ++i) {
    const Nanoseconds late = all.arrived[i].front() - all.sent[i];
    EXPECT_GE(late, 20ms);
    EXPECT_LE(late, 30ms);
    sum_s += ToSeconds(late);
    overtaken += i > 0 && all.arrived[i].front() < all.arrived[i - 1].front() ? 1 : 0;
  }
  EXPECT_NEAR(sum_s / 10000.0, 25e-3, 0.1e-3);
  // Of two that are 1 ms apart, with 10 ms of jitter: the second is earlier with (0.9^2) / 2.
  EXPECT_NEAR(overtaken / 10000.0, 0.405, 0.02);
}

TEST(PacketPathTest, LossesByThemselvesHaveTheirFractionAndNoMemory) {
  for (const double loss : {0.01, 0.2, 0.5}) {
    const Sent all = SendAll({.loss = loss}, 100000, 1ms);
    EXPECT_NEAR(all.LostFraction(), loss, 0.006) << loss;
    EXPECT_NEAR(all.MeanRun(), 1.0 / (1.0 - loss), 0.03 / (1.0 - loss)) << loss;
  }
  EXPECT_EQ(SendAll({.loss = 1.0}, 100, 1ms).LostFraction(), 1.0);
}

TEST(PacketPathTest, LossesInBurstsHaveTheirFractionAndLength) {
  // 10 000 s: some 2500 bursts.
  const Sent all = SendAll({.loss = 0.05, .burst = 200ms}, 1000000, 10ms);
  EXPECT_NEAR(all.LostFraction(), 0.05, 0.005);
  // Exponential with a mean of 20 packets, of which those with at least one are seen: 1 / (1 -
  // exp(-1/20)).
  EXPECT_NEAR(all.MeanRun(), 1.0 / (1.0 - std::exp(-1.0 / 20.0)), 1.5);
}

TEST(PacketPathTest, ARateSpreadsPacketsAndItsQueueHasAnEnd) {
  // A packet of 10 000 bits takes 10 ms. Eleven may wait up to 100 ms, the twelfth may not.
  const Sent all = SendAll({.rate_bit_s = 1e6, .max_wait = 100ms}, 20, 0ms);
  for (std::size_t i = 0; i < 20; ++i) {
    if (i < 11) {
      EXPECT_EQ(all.arrived[i], std::vector{kBegin + (static_cast<int>(i) + 1) * 10ms}) << i;
    } else {
      EXPECT_TRUE(all.arrived[i].empty()) << i;
    }
  }
}

TEST(PacketPathTest, WhatIsDoubledArrivesTwice) {
  PacketPath path(3);
  path.Set({.jitter = 5ms, .doubled = 0.25});
  std::size_t twice = 0;
  for (int i = 0; i < 10000; ++i)
    twice += path.Send(kBegin + i * 1ms, kPacket_bytes).times().size() == 2 ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(twice) / 10000.0, 0.25, 0.02);
  EXPECT_EQ(path.counts().doubled, twice);
  EXPECT_EQ(path.counts().packets, 10000U);
  EXPECT_EQ(path.counts().bytes, 10000U * kPacket_bytes);
}

TEST(PacketPathTest, TheSameSeedGivesTheSame) {
  const PathProperties poor{
      .delay = 5ms, .jitter = 5ms, .loss = 0.1, .burst = 50ms, .doubled = 0.1};
  EXPECT_EQ(SendAll(poor, 1000, 1ms, 7).arrived, SendAll(poor, 1000, 1ms, 7).arrived);
  EXPECT_NE(SendAll(poor, 1000, 1ms, 7).arrived, SendAll(poor, 1000, 1ms, 8).arrived);
}

}  // namespace
}  // namespace isotherm
