#pragma once

#include <optional>
#include <string>

#include "common/transport/messages.h"

namespace isotherm {

/// How to get from the depth camera's pose to another, in the operator's words: "0.30 m left, 0.12
/// m up, turn 25 deg right". Small parts are left out; "here" if all are.
std::string MoveText(const RigidTransform& T_depth_next);

/// What the ground says, in one line: tracking, coverage, advice with its reason, where to go next.
std::string FeedbackText(const Feedback& feedback);

/// "p50 48 ms, p99 92 ms"; "unknown" if there is none.
std::string LatencyText(const FeedbackLatency& latency);

/// Says what has changed in the feedback, for a journal. Thread-compatible.
class FeedbackNarrator {
 public:
  /// A line if tracking state, advice or "done" differ from the last time.
  std::optional<std::string> Tell(const Feedback& feedback);

 private:
  std::optional<Feedback> told_;
};

}  // namespace isotherm
