#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Notices that the ground is heard, and gets nothing of what is published: receipts come and name
/// no newer frame. Pure: time enters through arguments. Thread-compatible.
class ArrivalWatch {
 public:
  /// Not tuned; smaller than what an operator waits.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(3);

  void BeginSession() { *this = ArrivalWatch(); }
  void OnReceipt(PeerHandle ground, const Receipt& receipt, SteadyTime now) {
    const std::array<std::uint64_t, 2> next = {receipt.depth.next, receipt.thermal.next};
    const bool has_progress = !heard_at_ || next != next_;
    if (has_progress) is_unheard_ = false;
    // What was published while nothing came from there either says nothing of one direction.
    if (has_progress || now - *heard_at_ > kRecent) lacking_since_.reset();
    ground_ = ground;
    next_ = next;
    heard_at_ = now;
  }
  /// To be called several times a second with one above the highest number published, by Sensor.
  /// `waits`: no more is published before a receipt names more.
  void Look(const std::array<std::uint64_t, 2>& published, bool waits, SteadyTime now) {
    // Without receipts what was last known stands: the ground goes on hearing nothing, and falls
    // silent when the middleware has forgotten this side.
    if (!heard_at_ || now - *heard_at_ > kRecent) return;
    if (published[0] <= next_[0] && published[1] <= next_[1]) {
      lacking_since_.reset();
      is_unheard_ = false;
      return;
    }
    const std::uint64_t sum = published[0] + published[1];
    if (!lacking_since_) {
      lacking_since_ = now;
      published_then_ = sum;
    }
    // A last frame that got lost says nothing.
    const bool are_many = waits || sum >= published_then_ + kManyFrames;
    if (are_many && now - *lacking_since_ >= kPatience) is_unheard_ = true;
  }
  /// Returns the ground at which nothing arrives; 0 = none.
  PeerHandle unheard_by() const { return is_unheard_ ? ground_ : 0; }

 private:
  static constexpr Nanoseconds kRecent = std::chrono::seconds(1);
  static constexpr std::uint64_t kManyFrames = 10;

  PeerHandle ground_ = 0;                ///< The one that sent the newest receipt.
  std::array<std::uint64_t, 2> next_{};  ///< One above the highest that has arrived, by Sensor.
  std::optional<SteadyTime> heard_at_;
  std::optional<SteadyTime> lacking_since_;  ///< Nothing has arrived since.
  std::uint64_t published_then_ = 0;         ///< At that time, both streams together.
  bool is_unheard_ = false;
};

}  // namespace isotherm
