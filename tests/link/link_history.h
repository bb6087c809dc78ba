#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/codec/codec.h"
#include "common/recording/recording_parts.h"
#include "common/time/clock.h"
#include "edge/backfill/backfill.h"
#include "edge/options/edge_options.pb.h"
#include "edge/publisher/outgoing_stream.h"
#include "edge/publisher/testing/idle_publisher.h"
#include "edge/spool/interrupted_scan.h"
#include "edge/spool/spool.h"
#include "ground/subscriber/stream_receiver.h"

/// Both ends of the link in virtual time: recording, backfill, what is known of receipts, and the
/// order of frames are those of the daemons. The link between them, and the daemons' lives, are
/// what a test says.
namespace isotherm::link_test {

inline constexpr std::array kSensors = {Sensor::kDepth, Sensor::kThermal};
inline constexpr std::size_t IndexOf(Sensor sensor) { return static_cast<std::size_t>(sensor); }

/// A frame of either stream.
using AnyFrame = std::variant<EncodedDepthFrame, EncodedThermalFrame>;
inline const FrameHeader& HeaderOf(const AnyFrame& frame) {
  return std::visit([](const auto& content) -> const FrameHeader& { return content.header; },
                    frame);
}
inline Sensor SensorOf(const AnyFrame& frame) {
  return std::holds_alternative<EncodedDepthFrame>(frame) ? Sensor::kDepth : Sensor::kThermal;
}

/// Carries messages that arrive later, in another order, twice or never.
template <typename Message>
class LossyWay {
 public:
  void Send(const Message& message, SteadyTime now, std::mt19937& random) {
    const auto draw = [&random] { return std::uniform_real_distribution(0.0, 1.0)(random); };
    do {
      if (!carries || draw() < loss) continue;
      const auto jitter = FromSeconds(draw() * 2.0 * ToSeconds(delay));
      under_way_.push_back({now + jitter, message});
    } while (draw() < doubled);
    most_under_way_ = std::max(most_under_way_, under_way_.size());
  }
  std::vector<Message> Arrived(SteadyTime now) {
    std::vector<Message> arrived;
    std::erase_if(under_way_, [&](UnderWay& item) {
      if (item.arrival > now) return false;
      arrived.push_back(std::move(item.message));
      return true;
    });
    return arrived;
  }

  /// Returns how many messages were under way at once at most.
  std::size_t most_under_way() const { return most_under_way_; }

  bool carries = true;
  double loss = 0.0;
  double doubled = 0.0;
  Nanoseconds delay = std::chrono::milliseconds(5);  ///< In the mean.

 private:
  struct UnderWay {
    SteadyTime arrival;
    Message message;
  };
  std::vector<UnderWay> under_way_;
  std::size_t most_under_way_ = 0;
};

/// The ground's process: it puts frames in order, records them, and tells what it has.
class GroundEnd {
 public:
  /// Holds what has been recorded, by Sensor and number.
  using Recording = std::array<std::map<std::uint64_t, FrameHeader>, 2>;

  /// `before` was recorded by processes before, which this one has found out after `survey`.
  explicit GroundEnd(const Clock& clock, Recording before = {}, Nanoseconds survey = {})
      : clock_(clock), before_(std::move(before)), surveyed_(clock.SteadyNow() + survey) {}

  /// Returns what is on the disk when the process is killed: all but what was not flushed.
  Recording Kill() const {
    constexpr Nanoseconds kFlushInterval = std::chrono::milliseconds(500);
    Recording on_disk = before_;
    for (const Sensor sensor : kSensors) {
      for (const auto& [recorded, header] : recorded_.at(IndexOf(sensor))) {
        if (recorded + kFlushInterval < clock_.SteadyNow())
          on_disk.at(IndexOf(sensor)).emplace(header.frame_number, header);
      }
    }
    return on_disk;
  }

  void Take(const AnyFrame& frame) {
    const CaptureTime arrival = clock_.Now();
    const SteadyTime now = clock_.SteadyNow();
    if (const auto* depth = std::get_if<EncodedDepthFrame>(&frame))
      depth_.Add(EncodedDepthFrame(*depth), arrival, now);
    if (const auto* thermal = std::get_if<EncodedThermalFrame>(&frame))
      thermal_.Add(EncodedThermalFrame(*thermal), arrival, now);
    most_held_ = std::max(most_held_, depth_.held() + thermal_.held());
    ++since_receipt_;
  }
  /// Returns how many frames waited for others before them at most.
  std::size_t most_held() const { return most_held_; }
  /// Returns a receipt when one is due.
  std::optional<Receipt> Step(std::uint64_t session) {
    const SteadyTime now = clock_.SteadyNow();
    if (now >= surveyed_) Tell(session);
    depth_.DeliverDue(now);
    thermal_.DeliverDue(now);
    constexpr int kFramesPerReceipt = 8;
    if (now < next_receipt_ && since_receipt_ < kFramesPerReceipt) return std::nullopt;
    since_receipt_ = 0;
    next_receipt_ = now + std::chrono::milliseconds(200);
    Receipt receipt;
    receipt.session = session;
    receipt.depth = depth_.receipt(session);
    receipt.thermal = thermal_.receipt(session);
    if (receipt.depth.next + receipt.thermal.next == 0) return std::nullopt;
    return receipt;
  }

  /// Frames of one stream that it has used: live ones, in the order of their use, and late ones.
  struct Used {
    std::vector<FrameHeader> live;
    std::vector<FrameHeader> late;
  };
  const Used& used(Sensor sensor) const { return used_.at(IndexOf(sensor)); }
  const std::map<std::uint64_t, FrameHeader>& before(Sensor sensor) const {
    return before_.at(IndexOf(sensor));
  }

 private:
  /// Tells the streams what is recorded.
  void Tell(std::uint64_t session) {
    surveyed_ = SteadyTime::max();
    for (const Sensor sensor : kSensors) {
      std::vector<RecordedNumbers::Frame> frames;
      for (const auto& [number, header] : before(sensor))
        frames.push_back({number, header.capture_time});
      const SteadyTime now = clock_.SteadyNow();
      if (sensor == Sensor::kDepth) depth_.AddRecorded(session, frames, now);
      if (sensor == Sensor::kThermal) thermal_.AddRecorded(session, frames, now);
    }
  }
  template <typename Received>
  std::function<void(Received)> Into(Sensor sensor, std::vector<FrameHeader> Used::*list) {
    return [this, sensor, list](const Received& received) {
      (used_.at(IndexOf(sensor)).*list).push_back(received.frame->header);
      recorded_.at(IndexOf(sensor)).emplace_back(clock_.SteadyNow(), received.frame->header);
    };
  }

  const Clock& clock_;
  const Recording before_;
  SteadyTime surveyed_;
  std::array<Used, 2> used_;
  std::array<std::vector<std::pair<SteadyTime, FrameHeader>>, 2> recorded_;  ///< And when.
  std::array<RefusalCounter, 2> refusals_;
  static constexpr Nanoseconds kReorderWindow = std::chrono::milliseconds(200);
  StreamReceiver<ReceivedDepth> depth_{"depth", kReorderWindow, &refusals_[0],
                                       Into<ReceivedDepth>(Sensor::kDepth, &Used::live),
                                       Into<ReceivedDepth>(Sensor::kDepth, &Used::late)};
  StreamReceiver<ReceivedThermal> thermal_{"thermal", kReorderWindow, &refusals_[1],
                                           Into<ReceivedThermal>(Sensor::kThermal, &Used::live),
                                           Into<ReceivedThermal>(Sensor::kThermal, &Used::late)};
  SteadyTime next_receipt_{};
  int since_receipt_ = 0;
  std::size_t most_held_ = 0;
};

/// The edge's end of the link as the daemon keeps it, without the middleware.
class EdgeLink final : public IdlePublisher {
 public:
  using IdlePublisher::Publish;

  EdgeLink(const Clock& clock, LossyWay<AnyFrame>& way, std::mt19937& random)
      : clock_(clock), way_(way), random_(random) {}

  Status BeginSession(const RigDescription&, const SessionBefore& before) override {
    streams_[0].BeginSession(before.depth);
    streams_[1].BeginSession(before.thermal);
    return OkStatus();
  }
  /// Returns false if it cannot be true, by what the edge knows of itself.
  bool TakeReceipt(const Receipt& receipt) {
    if (streams_[0].sent().Check(receipt.depth) || streams_[1].sent().Check(receipt.thermal))
      return false;
    streams_[0].OnReceipt(receipt.depth, clock_.SteadyNow());
    streams_[1].OnReceipt(receipt.thermal, clock_.SteadyNow());
    receipt_ = receipt;
    receipt_at_ = clock_.SteadyNow();
    return true;
  }

  Status Publish(const EncodedDepthFrame& frame, std::stop_token) override {
    return SendLive(frame);
  }
  Status Publish(const EncodedThermalFrame& frame, std::stop_token) override {
    return SendLive(frame);
  }
  Result<bool> Backfill(const EncodedDepthFrame& frame, int, const std::stop_token&) override {
    return SendAgain(frame);
  }
  Result<bool> Backfill(const EncodedThermalFrame& frame, int, const std::stop_token&) override {
    return SendAgain(frame);
  }
  PublisherStats stats() const override {
    PublisherStats stats;
    stats.depth = streams_[0].counts();
    stats.thermal = streams_[1].counts();
    if (receipt_) stats.receipt_age = clock_.SteadyNow() - receipt_at_;
    stats.ground_present = stats.takes_backfill = true;
    return stats;
  }
  std::optional<Receipt> receipt() const override { return receipt_; }
  std::uint64_t backfilled() const { return backfilled_; }

 private:
  OutgoingStream& Of(const AnyFrame& frame) { return streams_.at(IndexOf(SensorOf(frame))); }
  Status SendLive(const AnyFrame& frame) {
    const FrameHeader& header = HeaderOf(frame);
    Of(frame).sent().Note(header.frame_number, header.capture_time);
    way_.Send(frame, clock_.SteadyNow(), random_);
    Of(frame).OnPublished(header.frame_number);
    return OkStatus();
  }
  Result<bool> SendAgain(const AnyFrame& frame) {
    ++backfilled_;
    Of(frame).sent().NoteAgain(HeaderOf(frame).frame_number);
    way_.Send(frame, clock_.SteadyNow(), random_);
    return Of(frame).OnBackfilled(HeaderOf(frame).frame_number);
  }

  const Clock& clock_;
  LossyWay<AnyFrame>& way_;
  std::mt19937& random_;
  std::array<OutgoingStream, 2> streams_ = {OutgoingStream{28, std::chrono::seconds(10)},
                                            OutgoingStream{28, std::chrono::seconds(10)}};
  std::optional<Receipt> receipt_;
  SteadyTime receipt_at_{};
  std::uint64_t backfilled_ = 0;
};

}  // namespace isotherm::link_test
