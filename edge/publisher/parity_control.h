#pragma once

#include <cstdint>
#include <deque>

#include "common/messages/frame_piece.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Decides how much parity frames get that go in pieces: so much that at the fraction of pieces
/// that is being lost one block in a thousand is not whole, if losses are independent. If more are
/// not, they come in bursts: then more. What a full link does not carry is no reason for more.
/// Pure: time enters through arguments. Thread-compatible.
class ParityControl {
 public:
  /// Assumed until the ground has said what arrives, and not less than kMinLoss later: a first loss
  /// must not cost a frame.
  static constexpr double kFirstLoss = 0.02;
  static constexpr double kMinLoss = 0.005;
  /// Beyond, what is sent is mostly parity.
  static constexpr double kMaxLoss = 0.4;

  void BeginSession() { *this = ParityControl(); }
  /// The next report is another ground's.
  void ForgetReports() { heard_.clear(); }
  /// Enters what the ground has of the session, and whether the link is full.
  void OnReport(const PieceReport& report, bool is_full, SteadyTime now);

  /// Returns the number of parity pieces for a block of so many data pieces.
  int PiecesFor(int data_pieces) const;
  /// Returns the fraction of pieces that the parity is for, 0..1.
  double loss() const { return loss_; }

 private:
  /// A report and when it came.
  struct Heard {
    PieceReport report;
    SteadyTime time;
  };

  void Assess(const PieceReport& report, SteadyTime now);

  std::deque<Heard> heard_;  ///< In the newest second, and one before, since the link is not full.
  double loss_ = kFirstLoss;
  double factor_ = 1.0;  ///< The parity that independent losses need is multiplied by this.
  SteadyTime raised_at_{};
};

}  // namespace isotherm
