#include "edge/daemon/scan_orders.h"

#include "common/base/check.h"

namespace isotherm {

const char* ScanOrders::ReasonAgainst(CommandKind kind) const {
  const bool starts = kind == CommandKind::kStartScan;
  switch (state_) {
    case State::kScanning:
      return starts ? "a scan is under way; stop it first" : nullptr;
    case State::kEnding:
      return starts ? "the scan before is still being written, or sent to a ground that lacks some "
                      "of it; try again"
                    : "the scan is ending already";
    case State::kEnded:
      return starts ? nullptr : "no scan is under way";
    case State::kStarting:
      return "a scan is about to begin";
  }
  return nullptr;
}

CommandResult ScanOrders::Execute(const Command& order) {
  CHECK(order.kind == CommandKind::kStartScan || order.kind == CommandKind::kStopScan);
  if (const char* reason = ReasonAgainst(order.kind)) {
    return {order.number, CommandOutcome::kRefused, reason};
  }
  if (order.kind == CommandKind::kStopScan) {
    state_ = State::kEnding;
    return {order.number, CommandOutcome::kDone, "the scan ends, and its recording is closed"};
  }
  state_ = State::kStarting;
  return {order.number, CommandOutcome::kDone, "the next scan begins once the cameras are open"};
}

bool ScanOrders::NoteFinished() {
  if (state_ != State::kScanning && state_ != State::kEnding) return false;
  state_ = State::kEnded;
  return true;
}

}  // namespace isotherm
