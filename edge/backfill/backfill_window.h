#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/frame_number_set.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Decides how many frames may be sent from the recording beside those that are being captured: few
/// at first, more as the ground confirms them, less when they get lost, none while what is live has
/// to wait. Never more per second than asked for. Pure: time enters through arguments.
/// Thread-compatible.
class BackfillWindow {
 public:
  /// Frames under way at the start. Not tuned.
  static constexpr double kFirstLimit = 4.0;
  /// With one that got lost, another shows that the link works.
  static constexpr double kMinLimit = 2.0;
  /// A frame that the ground still lacks after this long was lost, and is sent again. The ground
  /// sends five receipts a second. Smaller: frames are sent twice over a slow link. Not tuned.
  static constexpr Nanoseconds kLostAfter = std::chrono::seconds(2);

  /// `max_frames` of both streams together may be under way at once.
  BackfillWindow(std::size_t max_frames, double frames_per_s)
      : max_frames_(max_frames), frames_per_s_(frames_per_s) {}

  /// The ground lacks the frames in `holes`, ascending, of a stream. Returns which of those under
  /// way got lost.
  std::vector<std::uint64_t> OnReceipt(Sensor sensor, const std::vector<FrameRange>& holes,
                                       SteadyTime now) {
    const bool was_full = IsFull();
    // The middleware keeps the order of a topic: what was sent before a frame that is there, and is
    // not, got lost.
    SteadyTime newest{};
    for (const auto& [number, sent] : UnderWay(sensor)) {
      if (!IsIn(number, holes)) newest = std::max(newest, sent);
    }
    std::size_t confirmed = 0;
    std::vector<std::uint64_t> lost;
    std::erase_if(UnderWay(sensor), [&](const auto& frame) {
      const bool is_missing = IsIn(frame.first, holes);
      const bool is_lost =
          is_missing && (frame.second < newest || now - frame.second >= kLostAfter);
      confirmed += is_missing ? 0 : 1;
      if (is_lost) lost.push_back(frame.first);
      return !is_missing || is_lost;
    });
    confirmed_ += confirmed;
    // As TCP does: only a window that was used up is too small.
    if (was_full && lost.empty()) limit_ += static_cast<double>(confirmed);
    if (!lost.empty()) limit_ /= 2.0;
    limit_ = std::clamp(limit_, kMinLimit, static_cast<double>(max_frames_));
    return lost;
  }
  /// Live frames have to wait: the link is full. To be called at most ten times a second.
  void OnLiveBehind() { limit_ = std::max(kMinLimit, limit_ / 2.0); }
  void OnSent(Sensor sensor, std::uint64_t number, SteadyTime now) {
    UnderWay(sensor)[number] = now;
    // Time that was not used is not made up for.
    next_ = std::max(next_, now - kBurst) + FromSeconds(1.0 / frames_per_s_);
  }

  /// The last of it has left only now.
  void OnLeft(Sensor sensor, std::uint64_t number, SteadyTime now) {
    const auto found = UnderWay(sensor).find(number);
    if (found != UnderWay(sensor).end()) found->second = now;
  }

  bool MaySend(SteadyTime now) const { return !IsFull() && now >= next_; }
  bool IsUnderWay(Sensor sensor, std::uint64_t number) const {
    return under_way_[static_cast<std::size_t>(sensor)].contains(number);
  }
  std::size_t under_way() const { return under_way_[0].size() + under_way_[1].size(); }
  /// Frames that the ground had after they were sent.
  std::uint64_t confirmed() const { return confirmed_; }

 private:
  static constexpr Nanoseconds kBurst = std::chrono::milliseconds(20);

  bool IsFull() const { return static_cast<double>(under_way()) >= limit_; }
  std::map<std::uint64_t, SteadyTime>& UnderWay(Sensor sensor) {
    return under_way_[static_cast<std::size_t>(sensor)];
  }

  const std::size_t max_frames_;
  const double frames_per_s_;
  std::array<std::map<std::uint64_t, SteadyTime>, 2> under_way_;  ///< By Sensor: number, when sent.
  double limit_ = kFirstLimit;
  std::uint64_t confirmed_ = 0;
  SteadyTime next_{};
};

}  // namespace isotherm
