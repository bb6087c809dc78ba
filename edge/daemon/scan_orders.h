#pragma once

#include <cstdint>

#include "common/messages/messages.h"

namespace isotherm {

/// Decides on the orders to stop a scan and to start the next one. A scan that was told to stop, or
/// whose source has ended, is over once its frames are on the disk and on the link; only then may
/// another begin. Thread-bound.
class ScanOrders {
 public:
  enum class State : std::uint8_t {
    kScanning = 0,
    kEnding = 1,    ///< Told to stop; frames are still under way.
    kEnded = 2,     ///< The recording is closed.
    kStarting = 3,  ///< Told to start the next one.
  };

  /// Takes an order of the kinds kStartScan and kStopScan (CHECK). Returns its answer.
  CommandResult Execute(const Command& order);
  /// To be called when the source has ended and none of its frames is under way. Returns true if
  /// the recording is to be closed now.
  bool NoteFinished();

  State state() const { return state_; }

 private:
  /// Returns why the order cannot be followed now; nullptr if it can.
  const char* ReasonAgainst(CommandKind kind) const;

  State state_ = State::kScanning;
};

}  // namespace isotherm
