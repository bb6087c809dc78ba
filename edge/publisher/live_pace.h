#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Decides which frames are sent while they are new (live policy), so that what the operator sees
/// is new also over a link that is too narrow for all of them. If frames take longer to the ground
/// than they did at their quickest, fewer are sent, in steps: every second depth frame, every
/// second thermal frame, every fourth, eighth, sixteenth of both; one step back after a while
/// without delay, the later the sooner that failed. If nothing arrives any more, only a frame now
/// and then. What is left comes from the recording when there is room. Pure: time enters through
/// arguments. Thread-compatible.
class LivePace {
 public:
  /// Longer than the quickest by this much: the link is full. What was lost twice takes as long on
  /// a link that is not full. Not tuned.
  static constexpr Nanoseconds kFullDelay = std::chrono::milliseconds(300);
  /// By this much: nothing arrives any more.
  static constexpr Nanoseconds kStalledDelay = std::chrono::milliseconds(900);
  /// A frame that is sent all the same, to see whether it arrives.
  static constexpr Nanoseconds kProbeInterval = std::chrono::milliseconds(500);
  /// One step back after this long without delay, at first.
  static constexpr Nanoseconds kFirstHold = std::chrono::seconds(2);
  static constexpr Nanoseconds kMaxHold = std::chrono::seconds(32);

  void BeginSession() { *this = LivePace(); }

  /// Says whether the next frame of a stream is to be sent, rather than left for later.
  bool TakesNext(Sensor sensor, SteadyTime now);
  /// Enters that it was sent. Numbers rise.
  void OnSent(Sensor sensor, std::uint64_t number, SteadyTime now);
  /// Enters what the ground has of both streams.
  void OnReceipt(const Receipt& receipt, SteadyTime now);

  /// Returns of how many frames of the stream one is sent.
  int stride(Sensor sensor) const { return kSteps.at(step_).at(static_cast<std::size_t>(sensor)); }
  /// Returns whether all frames are sent.
  bool is_full_rate() const { return step_ == 0; }
  /// Returns how long a frame and its receipt took at the quickest in the newest minute or half of
  /// one; 0: not known.
  Nanoseconds quickest() const {
    const Nanoseconds quickest = std::min(quickest_[0], quickest_[1]);
    return quickest == Nanoseconds::max() ? Nanoseconds(0) : quickest;
  }
  /// Returns whether a frame takes longer than its way explains.
  bool is_late(SteadyTime now) const { return Delay(now) > kFullDelay; }
  /// Returns whether frames are left, if it is asked at all.
  bool leaves_frames() const { return is_asked_ && !is_full_rate(); }

 private:
  /// By step and Sensor. Depth first: geometry is seen from many views, and the thermal camera has
  /// fewer pixels.
  static constexpr std::array<std::array<int, 2>, 6> kSteps = {
      {{1, 1}, {2, 1}, {2, 2}, {4, 4}, {8, 8}, {16, 16}}};

  /// A frame that was sent.
  struct Sent {
    std::uint64_t number;
    SteadyTime time;
  };
  /// One stream.
  struct Stream {
    std::deque<Sent> under_way;         ///< Sent and neither there nor given up, ascending.
    SteadyTime sent_at{};               ///< The newest.
    std::optional<SteadyTime> arrived;  ///< When the newest that is there was sent.
    int waiting = 0;                    ///< Frames since, with the next one.
  };

  Stream& Of(Sensor sensor) { return streams_.at(static_cast<std::size_t>(sensor)); }
  void TakeOut(Stream& stream, const StreamReceipt& receipt, SteadyTime now);
  void NoteQuickest(Nanoseconds took, SteadyTime now);
  /// Returns for how much longer than the quickest the oldest frame is under way.
  Nanoseconds Delay(SteadyTime now) const;
  bool IsStalled(SteadyTime now) const;
  /// At first nothing is known of the link: what the cameras take in a second may fill it for ten.
  bool IsUnproven(const Stream& stream, SteadyTime now) const;
  void Decide(SteadyTime now);
  void Change(std::size_t step, SteadyTime now);

  std::array<Stream, 2> streams_;  ///< By Sensor.
  std::size_t step_ = 0;
  bool is_asked_ = false;
  std::optional<SteadyTime> receipt_at_, first_arrival_;
  /// In the present time of kQuickestFor, and in the one before.
  std::array<Nanoseconds, 2> quickest_ = {Nanoseconds::max(), Nanoseconds::max()};
  SteadyTime quickest_since_{};
  SteadyTime changed_at_{};   ///< When the step was.
  SteadyTime clear_since_{};  ///< Without delay.
  Nanoseconds hold_ = kFirstHold;
  bool went_back_ = false;  ///< The last change was to more frames.
};

}  // namespace isotherm
