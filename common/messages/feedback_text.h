#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/messages/messages.h"

/// Feedback in the operator's words, the same on both sides of the link.
namespace isotherm {

/// Returns how to get from the depth camera's pose to another, in the operator's words: "0.30 m
/// left, 0.12 m up, turn 25 deg right". Small parts are left out; it is "here" if all are.
std::string MoveText(const RigidTransform& T_depth_next);

/// Returns what to do now and why: "closer (40 % of the surface is farther than 0.60 m)"; "go on"
/// if nothing is to be changed.
std::string AdviceText(const Feedback& feedback);

/// Returns what the ground says, a part per fact, the most important first: advice, tracking,
/// coverage of view and model, where to go next. What is `urgent`, such as that the ground is
/// behind, stands behind the advice and before its reason. For FitLine(): what does not fit is left
/// out.
std::vector<std::string> FeedbackParts(const Feedback& feedback,
                                       std::vector<std::string> urgent = {});

/// The same in one line.
std::string FeedbackText(const Feedback& feedback);

/// "p50 48 ms, p99 92 ms"; "unknown" if there is none.
std::string LatencyText(const FeedbackLatency& latency);

/// Says what has changed in the feedback, for a journal. Thread-compatible.
class FeedbackReporter {
 public:
  /// A line if tracking state, advice or "done" differ from the last time.
  std::optional<std::string> Report(const Feedback& feedback);

 private:
  std::optional<Feedback> reported_;
};

}  // namespace isotherm
