#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Holds what the ground stations that are there make of this rig, by their receipts: they follow
/// it, or another one, or they refuse it because another process has its name. Each says so several
/// times in a second (a refusal once). Pure: time enters through arguments. Thread-compatible.
class GroundRelation {
 public:
  /// Whatever was said longer ago is over.
  static constexpr Nanoseconds kMemory = std::chrono::seconds(3);

  explicit GroundRelation(std::string edge_id) : edge_id_(std::move(edge_id)) {}

  /// A ground station has sent `receipt` to the rig `edge_id`; `session` is ours, 0 = none.
  void OnReceipt(const std::string& edge_id, const Receipt& receipt, std::uint64_t session,
                 SteadyTime now) {
    if (edge_id != edge_id_) {
      other_rig_ = edge_id;
      other_at_ = now;
      return;
    }
    followed_at_ = now;
    if (session == 0 || receipt.session != session) return;
    refused_at_.reset();
    if (receipt.verdict == SessionVerdict::kOtherRig) refused_at_ = now;
  }

  /// Our session is refused: nothing of it is received, and no receipt will come.
  bool IsRefused(SteadyTime now) const { return IsRecent(refused_at_, now); }

  /// Returns what is wrong and what to do, to follow "the ground station"; empty = nothing.
  std::string Problem(SteadyTime now) const {
    if (IsRefused(now)) {
      return "refuses this scan: another rig has the name \"" + edge_id_ +
             "\" and came first; give one of them another name (--edge-id)";
    }
    if (IsRecent(followed_at_, now) || !IsRecent(other_at_, now)) return "";
    return "is here but follows \"" + other_rig_ + "\", not \"" + edge_id_ +
           "\"; start one of them with the name of the other (--edge-id)";
  }

  /// Returns Problem() if it has changed since the last call.
  std::optional<std::string> News(SteadyTime now) {
    std::string problem = Problem(now);
    if (problem == reported_) return std::nullopt;
    reported_ = std::move(problem);
    return reported_;
  }

 private:
  static bool IsRecent(const std::optional<SteadyTime>& time, SteadyTime now) {
    return time && now < *time + kMemory;
  }

  const std::string edge_id_;
  std::string other_rig_;
  std::optional<SteadyTime> other_at_;
  std::optional<SteadyTime> followed_at_;
  std::optional<SteadyTime> refused_at_;
  std::string reported_;
};

}  // namespace isotherm
