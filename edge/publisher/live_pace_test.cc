#include "edge/publisher/live_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// A rig with both cameras, a link of a certain rate, and a ground that says five times a second
/// what it has. Frames go over the link one behind the other, as a queue before a radio has them.
class PacedLink {
 public:
  static constexpr double kDepth_bits = 0.9e6, kThermal_bits = 0.5e6;  // Of the demo: 47 Mbit/s.

  explicit PacedLink(double rate_bit_s, Nanoseconds delay = 20ms)
      : rate_bit_s_(rate_bit_s), delay_(delay) {}

  void set_rate(double rate_bit_s) { rate_bit_s_ = rate_bit_s; }
  /// Nothing gets through in either direction; what is sent is lost.
  void set_cut(bool is_cut) { is_cut_ = is_cut; }
  void ForgetDelays() { delays_s_.clear(); }

  void Run(Nanoseconds duration) {
    const SteadyTime end = now_ + duration;
    for (; now_ < end; now_ += 1ms) {
      if (now_ >= next_[0]) Capture(Sensor::kDepth, kDepth_bits, 33333us);
      if (now_ >= next_[1]) Capture(Sensor::kThermal, kThermal_bits, 25ms);
      const bool has_news = now_ < kBegin + 3s && Received(now_) > Received(now_ - 1ms);
      if (now_ >= next_receipt_ || has_news) {
        next_receipt_ = now_ + 200ms;
        if (!is_cut_) receipts_.emplace(now_ + delay_, ReceiptNow());
      }
      while (!receipts_.empty() && receipts_.begin()->first <= now_) {
        pace_.OnReceipt(receipts_.begin()->second, now_);
        receipts_.erase(receipts_.begin());
      }
    }
  }

  LivePace& pace() { return pace_; }
  /// Counts the frames that were sent since the last ForgetDelays.
  double DelayQuantile_s(double quantile) const {
    std::vector<double> sorted = delays_s_;
    std::sort(sorted.begin(), sorted.end());
    return sorted.at(static_cast<std::size_t>(quantile * static_cast<double>(sorted.size() - 1)));
  }
  std::size_t sent() const { return delays_s_.size(); }
  /// Longest time between two depth frames that were sent.
  Nanoseconds longest_gap() const { return longest_gap_; }

 private:
  void Capture(Sensor sensor, double bits, Nanoseconds period) {
    const auto i = static_cast<std::size_t>(sensor);
    next_.at(i) += period;
    const std::uint64_t number = numbers_.at(i)++;
    if (!pace_.TakesNext(sensor, now_)) return;
    pace_.OnSent(sensor, number, now_);
    if (sensor == Sensor::kDepth) {
      longest_gap_ = std::max(longest_gap_, Nanoseconds(now_ - last_depth_));
      last_depth_ = now_;
    }
    if (is_cut_) return;
    free_at_ = std::max(free_at_, now_) + FromSeconds(bits / rate_bit_s_);
    arrivals_.at(i)[number] = free_at_ + delay_;
    delays_s_.push_back(ToSeconds(free_at_ + delay_ - now_));
  }
  std::size_t Received(SteadyTime by) const {
    std::size_t received = 0;
    for (const auto& stream : arrivals_)
      received += static_cast<std::size_t>(
          std::ranges::count_if(stream, [by](const auto& frame) { return frame.second <= by; }));
    return received;
  }
  /// Without holes: what was not sent is none that matters: the ground has given it up.
  Receipt ReceiptNow() const {
    Receipt receipt;
    for (const auto& [sensor, stream] : {std::pair(Sensor::kDepth, &receipt.depth),
                                         std::pair(Sensor::kThermal, &receipt.thermal)}) {
      for (const auto& [number, time] : arrivals_.at(static_cast<std::size_t>(sensor)))
        if (time <= now_) stream->next = stream->handled = number + 1;
    }
    return receipt;
  }

  static constexpr SteadyTime kBegin{1000s};

  double rate_bit_s_;
  const Nanoseconds delay_;
  bool is_cut_ = false;
  LivePace pace_;
  SteadyTime now_ = kBegin;
  std::array<SteadyTime, 2> next_ = {now_, now_};
  SteadyTime next_receipt_ = now_;
  std::array<std::uint64_t, 2> numbers_{};
  std::array<std::map<std::uint64_t, SteadyTime>, 2> arrivals_;
  std::multimap<SteadyTime, Receipt> receipts_;
  SteadyTime free_at_{};
  SteadyTime last_depth_ = now_;
  Nanoseconds longest_gap_{};
  std::vector<double> delays_s_;
};

TEST(LivePaceTest, AWideLinkCarriesAllFrames) {
  for (const Nanoseconds delay : {0ms, 20ms, 600ms}) {
    PacedLink link(100e6, delay);
    link.Run(5s);  // Before the first have arrived, few are sent.
    link.ForgetDelays();
    link.Run(30s);
    EXPECT_TRUE(link.pace().is_full_rate());
    EXPECT_EQ(link.sent(), 30U * 30U + 30U * 40U) << ToSeconds(delay);
  }
}

TEST(LivePaceTest, WhatANarrowLinkCarriesIsNew) {
  for (const double mbit_s : {24.0, 16.0, 8.0, 4.0}) {
    PacedLink link(mbit_s * 1e6);
    link.Run(15s);  // What was sent before anything was known of the link has arrived.
    link.ForgetDelays();
    link.Run(60s);
    // A frame alone takes up to a quarter of a second at 4 Mbit/s.
    EXPECT_LE(link.DelayQuantile_s(0.5), 0.3) << mbit_s;
    EXPECT_LE(link.DelayQuantile_s(0.99), 1.0) << mbit_s;
    EXPECT_FALSE(link.pace().is_full_rate());
    EXPECT_LE(link.longest_gap(), 800ms) << mbit_s;
  }
}

TEST(LivePaceTest, AllFramesAreSentAgainWhenTheLinkIsWideAgain) {
  PacedLink link(100e6);
  link.Run(5s);
  link.set_rate(8e6);
  link.Run(10s);
  EXPECT_FALSE(link.pace().is_full_rate());
  link.set_rate(100e6);
  link.Run(30s);
  EXPECT_TRUE(link.pace().is_full_rate());
}

TEST(LivePaceTest, AnOutageIsNoNarrowLink) {
  PacedLink link(100e6);
  link.Run(5s);
  link.set_cut(true);
  link.ForgetDelays();
  link.Run(10s);
  link.set_cut(false);
  link.Run(3s);
  EXPECT_TRUE(link.pace().is_full_rate());
}

TEST(LivePaceTest, WithoutReceiptsAllFramesAreSent) {
  LivePace pace;
  SteadyTime now{1000s};
  for (std::uint64_t number = 0; number < 1000; ++number, now += 33ms) {
    ASSERT_TRUE(pace.TakesNext(Sensor::kDepth, now));
    pace.OnSent(Sensor::kDepth, number, now);
  }
}

TEST(LivePaceTest, AFrameThatTheGroundHasGivenUpHoldsNothingUp) {
  LivePace pace;
  SteadyTime now{1000s};
  Receipt receipt;
  for (std::uint64_t number = 0; number < 1000; ++number, now += 33ms) {
    ASSERT_TRUE(pace.TakesNext(Sensor::kDepth, now));
    pace.OnSent(Sensor::kDepth, number, now);
    receipt.depth.next = receipt.depth.handled = number + 1;
    receipt.depth.holes = {{5, 7}};
    pace.OnReceipt(receipt, now + 10ms);
  }
  EXPECT_TRUE(pace.is_full_rate());
}

TEST(LivePaceTest, TheLastFrameOfACameraThatIsGoneHoldsTheOtherNotUp) {
  LivePace pace;
  SteadyTime now{1000s};
  pace.OnSent(Sensor::kThermal, 0, now);  // It never arrives.
  Receipt receipt;
  std::uint64_t sent = 0;
  for (std::uint64_t number = 0; number < 300; ++number, now += 33ms) {
    if (!pace.TakesNext(Sensor::kDepth, now)) continue;
    ++sent;
    pace.OnSent(Sensor::kDepth, number, now);
    receipt.depth.next = receipt.depth.handled = number + 1;
    pace.OnReceipt(receipt, now + 10ms);
  }
  EXPECT_GT(sent, 250U);
  EXPECT_TRUE(pace.is_full_rate());
}

TEST(LivePaceTest, ALinkThatStaysNarrowForMinutesIsNotTakenForOneThatIsSlow) {
  PacedLink link(8e6);
  link.Run(5min);
  link.ForgetDelays();
  link.Run(1min);
  EXPECT_LE(link.DelayQuantile_s(0.5), 0.3);
  EXPECT_LE(link.DelayQuantile_s(0.99), 1.0);
}

}  // namespace
}  // namespace isotherm
