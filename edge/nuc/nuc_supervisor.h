#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "edge/nuc/frame_clock.h"
#include "edge/nuc/nuc_hold.h"
#include "edge/nuc/nuc_need.h"
#include "edge/nuc/nuc_notices.h"
#include "edge/nuc/nuc_observation.h"
#include "edge/nuc/nuc_orders.h"
#include "edge/nuc/nuc_state.h"
#include "edge/nuc/shutter_watch.h"
#include "edge/nuc/warm_up_wait.h"

namespace isotherm {

class NucOptions;

Status Validate(const NucOptions& options);

/// Holds what is known about the thermal camera's correction at one frame, and what follows.
struct NucStatus {
  NucState state = NucState::kUnknown;
  NucSource source = NucSource::kUnknown;
  std::optional<double> seconds_since_nuc;  ///< Since the shutter opened; nullopt = none seen yet.
  bool valid = false;                       ///< Temperatures may reach the model.
  std::optional<NucOrder> order;  ///< To be passed on; the camera's answer goes to OnAnswer.
};

/// Follows the non-uniformity correction (NUC) of the thermal camera, decides for every frame
/// whether its temperatures are valid, and when the camera is to correct itself
/// (thesis 3.2.3, 8.2). It puts small machines together, each of which follows one thing:
///
///   ShutterWatch  open, closed, stuck, settling; storms of corrections
///   NucOrders     what was ordered: not answered yet, accepted, followed or not
///   NucNeed       why a correction is needed
///   NucHold       the operator puts corrections off
///   WarmUpWait    whether a camera that is not warm is waited for
///
/// The state follows from what they say (the table in nuc_state.cc):
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
  /// Says whether there is a camera that can be ordered.
  enum class Role : std::uint8_t {
    kFollow,     ///< A recording is played: nothing can be ordered, nothing is missed.
    kSupervise,  ///< There is a camera.
  };

  NucSupervisor(const NucOptions& options, Role role);
  /// The machines refer to the notices.
  NucSupervisor(const NucSupervisor&) = delete;
  NucSupervisor& operator=(const NucSupervisor&) = delete;

  /// Advances to a frame. At most one order comes of it.
  NucStatus Update(const NucObservation& seen);
  /// Takes what the camera says to an order, at once or some frames later. kFailedPrecondition: it
  /// takes no such order and is not asked again; anything else but ok counts as an attempt.
  void OnAnswer(NucOrder order, const Status& answer);

  /// A NUC as soon as it is allowed. Empty if the camera's answer to the order of the next frame,
  /// or to the one that it has not answered yet, is the answer to this; or a sentence that says
  /// when; an error if it will not be done.
  Result<std::string> Request();
  /// No orders for this long, camera's own included as far as it can be told; 0 ends a hold.
  /// Bounded by max_hold_s; says for how long, or fails if the time is used up.
  Result<std::string> Hold(double seconds);
  /// Fails if there is no camera.
  Status SetPolicy(NucPolicy policy);

  NucPolicy policy() const { return policy_; }
  /// The closings of the last minute, for the status.
  const ShutterLog& shutter() const { return shutter_.log(); }
  bool is_storm() const { return shutter_.is_storm(); }
  bool is_warming_up() const { return warm_up_.is_cold(); }
  /// Says in one sentence why the state is what it is; empty if there is nothing to say.
  const std::string& reason() const { return reason_; }
  /// Since the last call.
  std::vector<NucNotice> TakeNotices() { return notices_.Take(); }

 private:
  void Advance(const NucObservation& seen);
  void FollowShutter(const NucObservation& seen);
  void GiveUp();
  void OnTriggerAnswered(const Status& answer);
  /// Says why a NUC is wanted now; empty = it is not.
  std::string DueReason(const NucObservation& seen) const;
  std::optional<NucOrder> NextOrder();
  /// kUnavailable: there is nothing to command yet, or at all.
  Status CheckCommandable() const;
  Nanoseconds Age() const;
  NucFacts Facts(const NucObservation& seen) const;
  std::optional<double> SecondsSinceNuc(const NucObservation& seen) const;
  std::string Explain(NucState state) const;

  const Role role_;
  NucPolicy policy_;
  FrameClock clock_;
  NucNotices notices_;
  ShutterWatch shutter_;
  NucOrders orders_;
  NucNeed need_;
  NucHold hold_;
  WarmUpWait warm_up_;
  std::string due_;  ///< Why a NUC is wanted; empty = it is not.
  std::string reason_;
};

}  // namespace isotherm
