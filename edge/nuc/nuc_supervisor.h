#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/log.h"
#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "edge/nuc/image_watch.h"
#include "edge/nuc/shutter_log.h"
#include "edge/nuc/warm_up_watch.h"

namespace isotherm {

class NucOptions;

/// Holds what one thermal frame tells about the correction.
struct NucObservation {
  CaptureTime time{};
  bool shutter_closed = false;        ///< The camera says so in the frame.
  std::optional<CameraNuc> camera{};  ///< What else the camera says; nullopt = nothing.
  ThermalHousekeeping housekeeping{};
  ImageEvidence image{};
};

/// Says what the camera is to do.
enum class NucOrder : std::uint8_t { kTrigger, kAutomaticOn, kAutomaticOff, kRestartCamera };

/// Holds what is known about the thermal camera's correction at one frame, and what follows.
struct NucStatus {
  NucState state = NucState::kUnknown;
  NucSource source = NucSource::kUnknown;
  std::optional<double> seconds_since_nuc;  ///< Since the shutter opened; nullopt = none seen yet.
  bool valid = false;                       ///< Temperatures may reach the model.
  std::optional<NucOrder> order;  ///< To be passed on; the camera's answer goes to OnAnswer.
};

/// Something that operator, log and recording should know.
struct NucNotice {
  CaptureTime time{};
  LogLevel level = LogLevel::kInfo;
  std::string text{};
};

/// Follows the non-uniformity correction (NUC) of the thermal camera, decides for every frame
/// whether its temperatures are valid, and when the camera is to correct itself
/// (thesis 3.2.3, 8.2).
///
///   kUnknown    --(no first NUC asked for, and warm or not waited for)--> kIdle
///   kIdle       --(due: request, start of scan, drift, interval)--------> kDesired
///   kDesired    --(allowed: order to the camera)------------------------> kImminent
///   kImminent   --(not followed in time)--------------------------------> kDesired, and after
///                                                            max_attempts kBlocked
///   kBlocked    --(a new request)---------------------------------------> kDesired
///   any         --(shutter closed: camera says so, order, images)-----> kInProgress
///   kInProgress --(open)------------------------------------------------> kSettling
///   kInProgress --(closed for longer than max_duration_s)---------------> kError
///   kError      --(open)------------------------------------------------> kSettling
///   kSettling   --(settle time elapsed)---------------------------------> kIdle
///
/// kDesired, kImminent and kBlocked also follow what the camera says of itself. Valid are kIdle,
/// kDesired and kBlocked, and kImminent if each frame itself tells whether the shutter is closed;
/// none before a first NUC that is asked for, none while a warm-up is waited for. Orders are at
/// least min_interval_s apart and come only with the shutter open, not during a hold and not in a
/// storm of corrections (failure F08).
///
/// Owns no device, thread or clock: time enters through Update, and other calls count from the last
/// frame. When the wall clock jumps back, no time passes here.
/// Thread-compatible.
class NucSupervisor {
 public:
  enum class Role : std::uint8_t {
    kFollow,     ///< A recording is played: nothing can be ordered, nothing is missed.
    kSupervise,  ///< There is a camera.
  };

  NucSupervisor(const NucOptions& options, Role role);
  ~NucSupervisor();

  /// Advances to a frame. At most one order comes of it.
  NucStatus Update(const NucObservation& seen);
  /// Takes what the camera says to an order, at once or some frames later. kFailedPrecondition: it
  /// takes no such order and is not asked again; anything else but ok counts as an attempt.
  void OnAnswer(NucOrder order, const Status& answer);

  /// A NUC as soon as it is allowed. Empty if the camera's answer to the order of the next frame,
  /// or to the one that it has not answered yet, is the answer to this; or a sentence that says
  /// when; an error if it will not be done.
  Result<std::string> Request();
  /// No orders for so long, camera's own included as far as it can be told; 0 ends a hold. Bounded
  /// by max_hold_s; says for how long, or fails if the time is used up.
  Result<std::string> Hold(double seconds);
  /// Fails if there is no camera.
  Status SetPolicy(NucPolicy policy);

  NucPolicy policy() const { return policy_; }
  /// The closings of the last minute, for the status.
  const ShutterLog& shutter() const { return shutter_; }
  bool is_storm() const { return storm_; }
  bool is_warming_up() const { return warm_up_state_ == WarmUpWatch::State::kCold; }
  /// Why the state is what it is, one sentence; empty if there is nothing to say.
  const std::string& reason() const { return reason_; }
  /// Since the last call.
  std::vector<NucNotice> TakeNotices();

 private:
  void Advance(const NucObservation& seen);
  void ForgetCamera(Nanoseconds gap);
  std::optional<NucSource> ClosedBy(const NucObservation& seen) const;
  void OnShutter(const NucObservation& seen);
  void FollowStorm();
  void FollowWarmUp(const ThermalHousekeeping& housekeeping);
  void FollowHold();
  void FollowOrder();
  /// Why a NUC is wanted now; empty = it is not.
  std::string DueReason(const NucObservation& seen) const;
  std::string DriftReason(const ThermalHousekeeping& housekeeping) const;
  std::optional<NucOrder> NextOrder(const NucObservation& seen);
  bool MayTrigger() const;
  CaptureTime EarliestTrigger() const;
  NucState NextState(const NucObservation& seen) const;
  bool IsValid(const NucObservation& seen) const;
  bool NeedsFirstNuc() const;
  bool WaitsForWarmUp() const;
  /// By the images alone: the camera does not say that its shutter is closed.
  bool IsFrozen(const NucObservation& seen) const;
  /// Closed, or frozen, for longer than a correction takes.
  bool IsStuck(const NucObservation& seen) const;
  void GiveUp();
  std::string Explain(const NucObservation& seen) const;
  bool IsHeld() const { return held_until_.has_value(); }
  void Note(LogLevel level, std::string text);

  const std::unique_ptr<const NucOptions> options_;
  const Role role_;
  NucPolicy policy_;

  CaptureTime frame_time_{};  ///< Time of the newest frame, as it came.
  CaptureTime now_{};         ///< The same, but never earlier than the frame before.
  std::optional<CaptureTime> first_frame_;
  ShutterLog shutter_;
  WarmUpWatch warm_up_;
  WarmUpWatch::State warm_up_state_ = WarmUpWatch::State::kNotAssessed;
  NucState state_ = NucState::kUnknown;
  std::string reason_;
  std::string due_;          ///< Why a NUC is wanted; empty = it is not.
  std::string ordered_for_;  ///< The same when it was ordered.
  bool storm_ = false;
  bool reported_stuck_ = false;
  bool reports_shutter_ = false;  ///< The camera says when its shutter is closed.
  bool cannot_trigger_ = false;   ///< The camera has said that it takes no such order.
  bool nuc_seen_ = false;
  bool first_nuc_waived_ = false;  ///< It did not come; the scan goes on without.
  /// At the last NUC, or at the first frame.
  ThermalHousekeeping reference_;

  bool requested_ = false;
  std::optional<CaptureTime> last_trigger_;
  bool trigger_unanswered_ = false;             ///< An order that the camera has not answered yet.
  std::optional<CaptureTime> waiting_since_;    ///< An order that was accepted and not yet seen.
  std::optional<CaptureTime> commanded_until_;  ///< For cameras that do not tell.
  int attempts_ = 0;
  std::optional<CaptureTime> hold_started_;
  std::optional<CaptureTime> held_until_;
  bool hold_used_up_ = false;
  std::optional<bool> automatic_;  ///< As ordered last.
  std::optional<CaptureTime> last_restart_;
  std::vector<NucNotice> notices_;
};

}  // namespace isotherm
