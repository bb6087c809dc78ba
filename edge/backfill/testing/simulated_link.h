#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "common/messages/frame_number_set.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "edge/publisher/testing/idle_publisher.h"

namespace isotherm {

inline std::size_t SensorIndex(Sensor sensor) { return static_cast<std::size_t>(sensor); }

/// A link and a ground behind it, in virtual time: frames arrive after a delay or never, receipts
/// tell of them.
class SimulatedLink final : public IdlePublisher {
 public:
  static constexpr std::uint64_t kSession = 7;

  SimulatedLink(const Clock& clock, std::uint64_t seed) : clock_(clock), random_(seed) {}

  /// Sends a frame as it is captured.
  void SendLive(Sensor sensor, std::uint64_t number) {
    next_published_[SensorIndex(sensor)] = number + 1;
    Carry(sensor, number);
  }
  void Deliver() {
    const SteadyTime now = clock_.SteadyNow();
    std::erase_if(under_way_, [&](const Frame& frame) {
      if (frame.arrival > now) return false;
      if (!has_.at(SensorIndex(frame.sensor)).Add(frame.number)) ++duplicates;
      ++since_receipt_;
      return true;
    });
    constexpr int kFramesPerReceipt = 8;
    if (!carries || !ground_is_there) return;
    if (now < next_receipt_ && since_receipt_ < kFramesPerReceipt) return;
    since_receipt_ = 0;
    next_receipt_ = now + std::chrono::milliseconds(200);
    Receipt receipt;
    receipt.session = kSession;
    receipt.depth = ReceiptOf(Sensor::kDepth);
    receipt.thermal = ReceiptOf(Sensor::kThermal);
    if (receipt.depth.next + receipt.thermal.next == 0) return;
    receipt_ = receipt;
    receipt_at_ = now;
  }
  /// The ground is started again, and knows nothing.
  void RestartGround() { has_ = std::array<FrameNumberSet, 2>(); }

  std::uint64_t Missing(Sensor sensor, std::uint64_t captured) const {
    return captured - has_.at(SensorIndex(sensor)).size();
  }

  // What the test sets.
  bool carries = true;
  bool ground_is_there = true;
  bool leaves_frames = false;  // The link is too narrow for all of them.
  double loss = 0.0;
  Nanoseconds delay = std::chrono::milliseconds(5);
  std::optional<std::uint64_t> refused;  // A number that the ground never takes, of both streams.
  // What it counts.
  std::uint64_t duplicates = 0;
  std::uint64_t backfilled = 0;

  Result<bool> Backfill(const EncodedDepthFrame& frame, int, const std::stop_token&) override {
    return SendAgain(Sensor::kDepth, frame.header);
  }
  Result<bool> Backfill(const EncodedThermalFrame& frame, int, const std::stop_token&) override {
    return SendAgain(Sensor::kThermal, frame.header);
  }
  PublisherStats stats() const override {
    PublisherStats stats;
    stats.depth.next_frame_number = next_published_[0];
    stats.thermal.next_frame_number = next_published_[1];
    if (receipt_) stats.receipt_age = clock_.SteadyNow() - receipt_at_;
    // The middleware notices late that somebody is gone.
    const bool is_noticed =
        !receipt_ || clock_.SteadyNow() - receipt_at_ > std::chrono::seconds(10);
    stats.ground_present = stats.takes_backfill = (carries && ground_is_there) || !is_noticed;
    stats.leaves_frames = leaves_frames;
    return stats;
  }
  std::optional<Receipt> receipt() const override { return receipt_; }

 private:
  struct Frame {
    Sensor sensor{};
    std::uint64_t number = 0;
    SteadyTime arrival;
  };
  Result<bool> SendAgain(Sensor sensor, const FrameHeader& header) {
    EXPECT_EQ(header.session, kSession);
    ++backfilled;
    Carry(sensor, header.frame_number);
    return false;
  }
  void Carry(Sensor sensor, std::uint64_t number) {
    const bool is_lost = number == refused || !carries || !ground_is_there ||
                         std::uniform_real_distribution(0.0, 1.0)(random_) < loss;
    if (!is_lost) under_way_.push_back({sensor, number, clock_.SteadyNow() + delay});
  }
  StreamReceipt ReceiptOf(Sensor sensor) const {
    const FrameNumberSet& has = has_.at(SensorIndex(sensor));
    return {.next = has.next(),
            .handled = has.next(),
            .received = has.size(),
            .holes = has.NewestHoles(kMaxHoles)};
  }

  const Clock& clock_;
  std::mt19937_64 random_;
  std::vector<Frame> under_way_;
  std::array<FrameNumberSet, 2> has_;
  std::array<std::uint64_t, 2> next_published_{};
  std::optional<Receipt> receipt_;
  SteadyTime receipt_at_{};
  SteadyTime next_receipt_{};
  int since_receipt_ = 0;
};

}  // namespace isotherm
