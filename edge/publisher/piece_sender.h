#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/frame_piece.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/transport/endpoints.h"
#include "common/transport/refusal.h"
#include "edge/publisher/parity_control.h"
#include "edge/publisher/piece_pace.h"
#include "edge/publisher/piece_turn.h"

namespace isotherm {

/// Sends frames in pieces, as fast as the link carries them and with the parity that its losses ask
/// for. Thread-safe: live frames and those of the recording may be sent at the same time.
class PieceSender {
 public:
  /// No frame is worth more of a thread's time. Those of the recording are tried again.
  static constexpr Nanoseconds kMaxLive = std::chrono::seconds(5);
  static constexpr Nanoseconds kMaxBackfill = std::chrono::seconds(2);
  /// After stop was requested.
  static constexpr Nanoseconds kMaxStopping = std::chrono::milliseconds(300);

  /// `clock` and `writer`, which somebody opens, must outlive the sender.
  PieceSender(const Clock& clock, std::string edge_id, Writer<FramePiece>& writer)
      : clock_(clock), edge_id_(std::move(edge_id)), writer_(writer) {}

  void BeginSession();
  /// Enters what a ground says that it has of the session. Others than the one that was heard last
  /// count when that one has been silent. Returns why it cannot be true.
  std::optional<RefusalCause> OnReport(PeerHandle ground, const PieceReport& report);
  /// As PiecePace::TakesNext.
  bool TakesNext(Sensor sensor, std::size_t newer);
  bool leaves_frames() const;

  /// Returns when the last piece has left, evenly at the rate of the link. kUnavailable: the link
  /// was too slow, or told to stop; the frame is not whole at the ground.
  Status Send(const EncodedDepthFrame& frame, PiecePriority priority, const std::stop_token& stop);
  Status Send(const EncodedThermalFrame& frame, PiecePriority priority,
              const std::stop_token& stop);

 private:
  template <typename Frame>
  Status SendFrame(const Frame& frame, Sensor sensor, PiecePriority priority,
                   const std::stop_token& stop);
  Status SendPieces(std::vector<FramePiece>&& pieces, PiecePriority priority,
                    const std::stop_token& stop);
  /// Waits until so many bytes may be sent; false: not by then, or not for long after stop.
  bool WaitForTurn(std::size_t bytes, PiecePriority priority, SteadyTime until,
                   const std::stop_token& stop);

  const Clock& clock_;
  const std::string edge_id_;
  Writer<FramePiece>& writer_;
  mutable Mutex mutex_;
  std::condition_variable_any
      turn_changed_;  // A short wait that lets the lock go; nobody notifies.
  ParityControl parity_ GUARDED_BY(mutex_);
  PiecePace pace_ GUARDED_BY(mutex_);
  PieceTurn turn_ GUARDED_BY(mutex_);
  std::uint64_t next_order_ GUARDED_BY(mutex_) = 0;
  PeerHandle ground_ GUARDED_BY(mutex_) = 0;  // Whose reports count.
  SteadyTime report_at_ GUARDED_BY(mutex_){};
};

}  // namespace isotherm
