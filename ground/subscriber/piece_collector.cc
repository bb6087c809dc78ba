#include "ground/subscriber/piece_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "common/transport/frame_packet.h"

namespace isotherm {
namespace {

/// The quickest piece of this long counts; of the two newest such times. Longer: where the way of
/// the pieces has become longer, the link is taken for full for as long; shorter: a queue that is
/// always there is taken for the way.
constexpr Nanoseconds kQuickestFor = std::chrono::seconds(5);
/// Single pieces may be late for many reasons; so many one after another wait in a queue.
constexpr int kRun = 16;

template <typename Frame>
std::optional<decltype(RigSample::content)> Unpack(std::span<const std::uint8_t> bytes,
                                                   std::uint64_t session, std::uint64_t number,
                                                   RefusalCounter* refusals) {
  Frame frame;
  std::optional<RefusalCause> cause = UnpackFrame(bytes, &frame);
  const bool is_another =
      !cause && (frame.header.session != session || frame.header.frame_number != number);
  if (is_another) cause = RefusalCause::kImpossibleNumber;
  if (!cause) return frame;
  refusals->Add(*cause, fmt::format("in pieces, session={} frame_number={}", session, number));
  return std::nullopt;
}

}  // namespace

std::optional<decltype(RigSample::content)> PieceCollector::Add(PeerHandle peer, PeerHandle owner,
                                                                FramePiece&& piece,
                                                                SteadyTime now) {
  if (peer == 0) return std::nullopt;  // Nobody is known as its sender.
  Sender& sender = SenderOf(peer, owner);
  Count(piece, now, &sender);
  const auto [session, sensor, number] =
      std::tuple(piece.session, piece.sensor, piece.frame_number);
  const std::optional<Bytes> bytes = sender.assembler.Add(std::move(piece));
  if (!bytes) return std::nullopt;
  return sensor == Sensor::kDepth
             ? Unpack<EncodedDepthFrame>(*bytes, session, number, &refusals_->depth)
             : Unpack<EncodedThermalFrame>(*bytes, session, number, &refusals_->thermal);
}

PieceCollector::Sender& PieceCollector::SenderOf(PeerHandle peer, PeerHandle owner) {
  Sender& sender = senders_[peer];
  sender.newest = ++pieces_;
  if (senders_.size() > kMaxProcesses) {
    senders_.erase(std::ranges::min_element(senders_, {}, [owner](const auto& item) {
      return std::pair(item.first == owner, item.second.newest);
    }));
  }
  return sender;
}

void PieceCollector::Count(const FramePiece& piece, SteadyTime now, Sender* sender) {
  sender->has_news = true;
  PieceReport& report = sender->report;
  if (report.received == 0 || report.session != piece.session) {
    report = {.session = piece.session};
    sender->frames_before = sender->assembler.frames();
    sender->broken_before = sender->assembler.broken();
    sender->delays = {};
  }
  sender->delays.Add(now.time_since_epoch() - piece.sent, now);
  report.next_order = std::max(report.next_order, piece.order + 1);
  report.received = std::min(report.received + 1, report.next_order);
}

std::optional<PieceReport> PieceCollector::TakeReport(PeerHandle peer) {
  const auto found = senders_.find(peer);
  if (found == senders_.end() || !std::exchange(found->second.has_news, false)) return std::nullopt;
  Sender& sender = found->second;
  PieceReport report = sender.report;
  report.frames = sender.assembler.frames() - sender.frames_before;
  report.broken = sender.assembler.broken() - sender.broken_before;
  report.queued = sender.delays.TakeQueued();
  return report;
}

void PieceCollector::Delays::Add(Nanoseconds took, SteadyTime now) {
  if (now - since > kQuickestFor) {
    // Long ago says nothing: clocks run apart.
    const bool is_recent = now - since < 2 * kQuickestFor;
    quickest = {Nanoseconds::max(), is_recent ? quickest[0] : Nanoseconds::max()};
    since = now;
  }
  quickest[0] = std::min(quickest[0], took);
  of_run = std::min(of_run, took);
  if (++run < kRun) return;
  run = 0;
  of_report = std::max(
      of_report, std::exchange(of_run, Nanoseconds::max()) - std::min(quickest[0], quickest[1]));
}

Nanoseconds PieceCollector::Delays::TakeQueued() {
  return std::exchange(of_report, Nanoseconds(0));
}

}  // namespace isotherm
