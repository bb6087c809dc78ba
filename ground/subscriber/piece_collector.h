#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "common/messages/frame_piece.h"
#include "common/pieces/frame_assembler.h"
#include "common/transport/endpoints.h"
#include "common/transport/refusal.h"
#include "ground/subscriber/rig_gate.h"
#include "ground/subscriber/stream_refusals.h"

namespace isotherm {

/// Puts frames together that come in pieces, and counts what arrives. Each process has its own, so
/// that nobody's pieces get among another's. Thread-compatible.
class PieceCollector {
 public:
  /// Processes whose pieces are kept: that of the rig, and others that call themselves so.
  static constexpr std::size_t kMaxProcesses = 4;

  /// `refusals`, which must outlive the collector, get frames that cannot be used.
  explicit PieceCollector(StreamRefusals* refusals) : refusals_(refusals) {}

  /// Returns the frame that the piece of a process completes. That of the rig (`owner`, 0: not
  /// known) is kept, whoever else sends.
  std::optional<decltype(RigSample::content)> Add(PeerHandle peer, PeerHandle owner,
                                                  FramePiece&& piece, SteadyTime now);

  /// Returns what has arrived of the newest session of a process; nullopt: nothing since the last
  /// report.
  std::optional<PieceReport> TakeReport(PeerHandle peer);

 private:
  /// Times from sending to arrival, on clocks that do not know each other: differences count.
  struct Delays {
    /// The quickest of the time since `since`, and of kQuickestFor before.
    std::array<Nanoseconds, 2> quickest = {Nanoseconds::max(), Nanoseconds::max()};
    SteadyTime since{};
    /// The quickest of the run of pieces that is arriving, and how many it has.
    Nanoseconds of_run = Nanoseconds::max();
    int run = 0;
    Nanoseconds of_report{};  ///< The slowest run since the last report.

    void Add(Nanoseconds took, SteadyTime now);
    Nanoseconds TakeQueued();
  };
  /// One process.
  struct Sender {
    FrameAssembler assembler;
    PieceReport report;               ///< Counts of pieces; those of frames are the assembler's.
    std::uint64_t frames_before = 0;  ///< The assembler's counts when the session began.
    std::uint64_t broken_before = 0;
    std::uint64_t newest = 0;  ///< Grows with each piece of any.
    Delays delays;
    bool has_news = false;  ///< Since the last report.
  };

  Sender& SenderOf(PeerHandle peer, PeerHandle owner);
  static void Count(const FramePiece& piece, SteadyTime now, Sender* sender);

  StreamRefusals* refusals_;
  std::map<PeerHandle, Sender> senders_;
  std::uint64_t pieces_ = 0;
};

}  // namespace isotherm
