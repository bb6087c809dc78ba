#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <stop_token>
#include <utility>

#include "common/time/clock.h"
#include "common/time/line_limiter.h"
#include "ground/ground_options.pb.h"
#include "ground/session_item.h"

namespace isotherm {

/// Turns what the subscriber delivers into items for both consumers. Frames that arrive before
/// their session's calibration are kept until it is there. Thread-bound to the receive thread.
class Distributor {
 public:
  Distributor(const GroundOptions& options, bool single_scan, const Clock& clock,
              ItemQueue& reconstruction, ItemQueue& recording)
      : options_(options),
        single_scan_(single_scan),
        clock_(clock),
        reconstruction_(reconstruction),
        recording_(recording) {}

  /// Reconstruction stops waiting for room when `stop` is requested; the recording does not.
  void SetStop(std::stop_token stop) { stop_ = std::move(stop); }

  void OnRig(const RigDescription& rig);
  void OnFrame(Item item);
  void OnClock(const ClockAccount& clock) { recording_.Push(clock, {}); }
  void OnLate(Item item) { recording_.Push(std::move(item), {}); }
  void OnSessionEnd(const SessionAccount& account);

 private:
  void Send(Item item);

  const GroundOptions& options_;
  const bool single_scan_;
  const Clock& clock_;
  ItemQueue& reconstruction_;
  ItemQueue& recording_;
  std::stop_token stop_;
  std::optional<std::uint64_t> session_;
  std::deque<Item> early_;
  LineLimiter early_limiter_;
};

}  // namespace isotherm
