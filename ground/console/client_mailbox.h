#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/time/time_types.h"
#include "ground/console/live_message.h"

namespace isotherm {

/// Holds what one client still has to get. Each slot keeps the newest message only, so a slow
/// client gets less, never older; what it gets is limited in bytes per second. In turn: answers,
/// what is small and urgent, then surface that the client never had, the nearest first, surface
/// that has become better, and images between them. Owns no clock. Thread-bound.
class ClientMailbox {
 public:
  struct Limits {
    double bytes_per_s = 5e6;
    std::size_t max_answers = 64;
  };

  ClientMailbox(const Limits& limits, SteadyTime now);

  /// Notes what the client has from an earlier connection: it is not sent again.
  void Have(const GroupKey& group, std::uint32_t version) { sent_[group] = version; }
  /// Replaces what waits in the message's slot. A scan with another model empties all.
  void Offer(const LiveMessagePtr& message);
  /// An answer to this client. False if it asks faster than it reads.
  bool Answer(LiveMessagePtr answer);

  void set_eye(const Eigen::Vector3d& eye_world) { eye_world_ = eye_world; }
  /// Returns whether it wants something now that it did not before.
  bool set_wants(bool details, bool images);
  /// Images with all their values; nobody wants them at first.
  void set_wants_raw(bool raw) { wants_raw_ = raw; }
  /// The client's own limit, no higher than the service's; 0 = none.
  void set_bytes_per_s(double bytes_per_s);

  /// Returns the next message to be sent; nullptr if there is none now.
  LiveMessagePtr Take(SteadyTime now);
  /// Returns when Take gives something again; nullopt: when something is offered.
  std::optional<SteadyTime> NextTake() const;

  std::size_t waiting() const { return waiting_.size() + answers_.size(); }
  std::uint64_t replaced() const { return replaced_; }
  std::uint64_t sent_bytes() const { return sent_bytes_; }

 private:
  using Waiting = std::map<LiveSlot, LiveMessagePtr>;
  bool IsWanted(const LiveMessage& message) const;
  Waiting::iterator Urgent();
  Waiting::iterator NearestGroup();
  Waiting::iterator Image();
  Waiting::iterator Next();
  LiveMessagePtr Remove(Waiting::iterator found);
  void Pay(std::size_t bytes, SteadyTime now);

  const Limits limits_;
  double bytes_per_s_ = limits_.bytes_per_s;
  Waiting waiting_;
  std::deque<LiveMessagePtr> answers_;
  std::map<GroupKey, std::uint32_t> sent_;  ///< Newest version of each group.
  std::uint64_t model_ = 0;
  Eigen::Vector3d eye_world_ = Eigen::Vector3d::Zero();
  bool wants_details_ = false;
  bool wants_images_ = true;
  bool wants_raw_ = false;
  SteadyTime paid_until_;  ///< All that was sent is within the limit from this time on.
  std::uint64_t replaced_ = 0;
  std::uint64_t sent_bytes_ = 0;
  double surface_bytes_ = 0.0;  ///< Lately, for the fraction that images may have.
  double image_bytes_ = 0.0;
};

}  // namespace isotherm
