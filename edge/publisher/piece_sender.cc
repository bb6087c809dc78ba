#include "edge/publisher/piece_sender.h"

#include <utility>

#include "common/pieces/cut_frame.h"
#include "common/transport/frame_packet.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Pieces that leave at once: a thread that waits for each of them does nothing else.
constexpr std::size_t kPiecesAtOnce = 4;
/// Another ground is heard when the one before has been silent for so long.
constexpr Nanoseconds kSilence = 2s;
/// A piece takes so much besides its bytes: our names for it, the middleware's, UDP and IP.
constexpr std::size_t kOverhead_bytes = 180;

}  // namespace

void PieceSender::BeginSession() {
  MutexLock lock(mutex_);
  parity_.BeginSession();
  pace_.BeginSession();
}

std::optional<RefusalCause> PieceSender::OnReport(PeerHandle ground, const PieceReport& report) {
  MutexLock lock(mutex_);
  const SteadyTime now = clock_.SteadyNow();
  if (report.next_order > next_order_) return RefusalCause::kImpossibleNumber;
  if (ground != ground_) {
    if (ground_ != 0 && now - report_at_ < kSilence) return std::nullopt;
    ground_ = ground;
    parity_.ForgetReports();
    pace_.ForgetReports();
  }
  report_at_ = now;
  parity_.OnReport(report, report.queued > PiecePace::kFullQueue, now);
  pace_.OnReport(report, now);
  return std::nullopt;
}

bool PieceSender::TakesNext(Sensor sensor, std::size_t newer) {
  MutexLock lock(mutex_);
  return pace_.TakesNext(sensor, newer, clock_.SteadyNow());
}

bool PieceSender::leaves_frames() const {
  MutexLock lock(mutex_);
  return pace_.leaves_frames();
}

template <typename Frame>
Status PieceSender::SendFrame(const Frame& frame, Sensor sensor, PiecePriority priority,
                              const std::stop_token& stop) {
  const std::vector<std::uint8_t> packet = PackFrame(frame);
  if (packet.size() > kMaxPiecedFrameBytes) return InvalidArgument("the frame is too large");
  std::vector<FramePiece> pieces = CutFrame(packet, [this](int data_pieces) {
    MutexLock lock(mutex_);
    return parity_.PiecesFor(data_pieces);
  });
  for (FramePiece& piece : pieces) {
    piece.session = frame.header.session;
    piece.sensor = sensor;
    piece.frame_number = frame.header.frame_number;
  }
  const auto note = [&](bool is_under_way) {
    if (priority != PiecePriority::kLive) return;
    MutexLock lock(mutex_);
    turn_.NoteLive(is_under_way);
  };
  note(true);
  Status sent = SendPieces(std::move(pieces), priority, stop);
  note(false);
  return sent;
}

Status PieceSender::Send(const EncodedDepthFrame& frame, PiecePriority priority,
                         const std::stop_token& stop) {
  return SendFrame(frame, Sensor::kDepth, priority, stop);
}

Status PieceSender::Send(const EncodedThermalFrame& frame, PiecePriority priority,
                         const std::stop_token& stop) {
  return SendFrame(frame, Sensor::kThermal, priority, stop);
}

Status PieceSender::SendPieces(std::vector<FramePiece>&& pieces, PiecePriority priority,
                               const std::stop_token& stop) {
  const std::size_t piece_bytes = pieces.front().bytes.size() + kOverhead_bytes;
  const SteadyTime until =
      clock_.SteadyNow() + (priority == PiecePriority::kLive ? kMaxLive : kMaxBackfill);
  std::size_t sent = 0;
  for (FramePiece& piece : pieces) {
    if (sent++ % kPiecesAtOnce == 0 &&
        !WaitForTurn(kPiecesAtOnce * piece_bytes, priority, until, stop)) {
      return Unavailable("the link is too slow for a frame, or told to stop");
    }
    {
      MutexLock lock(mutex_);
      piece.order = next_order_++;
    }
    piece.sent = clock_.SteadyNow().time_since_epoch();
    ISOTHERM_RETURN_IF_ERROR(writer_.Write(edge_id_, piece));
  }
  MutexLock lock(mutex_);
  pace_.OnSent(pieces.front().sensor, pieces.size(), piece_bytes, clock_.SteadyNow());
  return OkStatus();
}

bool PieceSender::WaitForTurn(std::size_t bytes, PiecePriority priority, SteadyTime until,
                              const std::stop_token& stop) {
  std::optional<SteadyTime> stopping_until;
  MutexLock lock(mutex_);
  while (true) {
    const SteadyTime now = clock_.SteadyNow();
    if (stop.stop_requested() && !stopping_until) stopping_until = now + kMaxStopping;
    if (now >= until || (stopping_until && now >= *stopping_until)) return false;
    const Nanoseconds wait = turn_.Take(bytes, pace_.rate_bit_s(), priority, now);
    if (wait == Nanoseconds(0)) return true;
    turn_changed_.wait_for(lock, wait);
  }
}

}  // namespace isotherm
