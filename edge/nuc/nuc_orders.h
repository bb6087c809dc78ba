#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/time/time_types.h"
#include "edge/nuc/nuc_notices.h"

namespace isotherm {

class NucOptions;

/// Says what the camera is to do.
enum class NucOrder : std::uint8_t { kTrigger, kAutomaticOn, kAutomaticOff, kRestartCamera };

/// Keeps what was ordered of the camera and what became of it.
///
///   kNone       --(order given)----------------------------> kUnanswered
///   kUnanswered --(accepted: the shutter must close)-------> kAwaited
///   kUnanswered --(accepted, but no shutter is reported)---> kNone
///   kUnanswered --(refused)--------------------------------> kNone
///   kUnanswered --(the camera was away)--------------------> kNone
///   kAwaited    --(the shutter did not close in time)------> kNone
///   any         --(the shutter closes)---------------------> kNone
///
/// Orders to correct are at least min_interval_s apart, and max_attempts at most until the shutter
/// has opened or somebody asks again. Times are those of frames. Thread-compatible.
class NucOrders {
 public:
  /// Says how far an order to correct has come: kUnanswered by the camera, or kAwaited: accepted,
  /// but its shutter has not closed yet.
  enum class State : std::uint8_t { kNone, kUnanswered, kAwaited };
  /// Says how to go on after the camera's answer to an order to correct.
  enum class Consequence : std::uint8_t {
    kNothing,       ///< The answer came after the shutter closed, or another attempt is left.
    kAwaitShutter,  ///< It was accepted, and the shutter has not closed yet.
    kGiveUp,        ///< No attempt is left.
  };

  /// `notices` must outlive it.
  NucOrders(const NucOptions& options, NucNotices& notices);

  /// Somebody asks for a correction: as many attempts as ever, also to a camera that refused.
  void Request();
  /// Attempts count from none.
  void Renew() { attempts_ = 0; }
  /// Nothing is asked for any more.
  void Withdraw() { requested_ = false; }

  /// Returns whether a correction may be ordered at `now`, if the shutter opened last at
  /// `opened_at`.
  bool MayTrigger(CaptureTime now, std::optional<CaptureTime> opened_at) const;
  CaptureTime EarliestTrigger(CaptureTime now, std::optional<CaptureTime> opened_at) const;
  /// A correction is ordered, `why` in words.
  void Trigger(CaptureTime now, std::string why);
  /// The order that switches the camera's own corrections, if they are not as wanted.
  std::optional<NucOrder> SwitchAutomatic(bool on);

  Consequence OnAnswer(const Status& answer);
  /// The shutter must close from `now` on.
  void Await(CaptureTime now);
  void OnShutterClosed() { state_ = State::kNone; }
  void OnShutterOpened();
  /// The camera was away and may be as it was built.
  void OnCameraAway();
  /// True when the shutter did not close in time and no attempt is left.
  bool IsLastOneMissed(CaptureTime now);

  State state() const { return state_; }
  bool is_pending() const { return state_ != State::kNone; }
  bool is_requested() const { return requested_; }
  bool has_attempts_left() const { return attempts_ < limits_.max_attempts; }
  /// The camera has said that it takes no such order.
  bool is_impossible() const { return impossible_; }
  Nanoseconds min_interval() const { return limits_.min_interval; }
  const std::string& ordered_for() const { return ordered_for_; }

 private:
  /// Holds the options that bound attempts and waiting.
  struct Limits {
    Nanoseconds min_interval, answer;
    int max_attempts;
  };
  const Limits limits_;
  NucNotices& notices_;
  State state_ = State::kNone;
  bool requested_ = false;
  bool impossible_ = false;
  int attempts_ = 0;
  std::optional<CaptureTime> last_trigger_;
  CaptureTime awaited_since_{};    ///< While kAwaited.
  std::string ordered_for_;        ///< Why it was ordered.
  std::optional<bool> automatic_;  ///< As ordered last.
};

}  // namespace isotherm
