#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/messages/messages.h"

namespace isotherm {

/// Says how a person moves the rig. Defaults: a person who walks carefully, at most as fast as the
/// thesis's operator (0.3 m/s, 17 degrees/s).
struct OperatorTraits {
  double speed_m_s = 0.3;
  double rotation_rate_deg_s = 17.0;
  double acceleration_m_s2 = 0.6;
  double angular_acceleration_deg_s2 = 60.0;
  double reaction_s = 0.4;  ///< From a message to its effect on the hand.
  double sway_m = 0.003;    ///< Largest sway along each axis.
  double sway_deg = 0.5;    ///< Largest sway about each axis.
};

/// The traits of one of several persons: reactions of 0.3 to 0.5 s, sway of 2 to 4 mm.
OperatorTraits TraitsOfPerson(std::uint64_t seed);

/// A rig in the hand that goes to a goal with bounded speed and acceleration and comes to rest
/// there. Thread-compatible.
class HandMotion {
 public:
  HandMotion(const OperatorTraits& traits, const RigidTransform& T_world_depth)
      : traits_(traits), T_world_depth_(T_world_depth) {}

  /// Goes on for `step_s` towards `T_world_goal`, at most this fast; what is faster now is slowed
  /// down as quickly as the hand can.
  void Advance(double step_s, const RigidTransform& T_world_goal, double speed_m_s,
               double rotation_rate_rad_s);
  const RigidTransform& T_world_depth() const { return T_world_depth_; }

 private:
  const OperatorTraits traits_;
  RigidTransform T_world_depth_;
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rate_rad_s_ = Eigen::Vector3d::Zero();  ///< Along the axes of `world`.
};

/// A pose on a fixed path, and how fast to go there.
struct Waypoint {
  RigidTransform T_world_depth;
  double speed_m_s;
  double rotation_rate_deg_s;
};

/// Says which instructions an operator heeds.
struct Obedience {
  bool next_view = true;  ///< Off: the fixed path is followed.
  bool slower = true;     ///< Off: always as fast as the path or the person is.
};

/// A person with a rig in the hand, as a script: follows the next view, goes back when lost, slows
/// down when told to, holds still while the camera corrects itself, comes closer or steps back
/// where no view is proposed, and does all this late and swaying. What the person heeds less of
/// follows a fixed path, and leaves a waypoint out on the way to which the rig was lost twice. The
/// same for the same seed. Thread-compatible.
class ScriptedOperator {
 public:
  ScriptedOperator(const OperatorTraits& traits, const Obedience& obedience,
                   const RigidTransform& T_world_depth, std::vector<Waypoint> path,
                   std::uint64_t seed);

  /// Takes a message about a view that was taken from `T_world_depth`, now; it has its effect after
  /// the reaction time.
  void Hear(const Feedback& feedback, const RigidTransform& T_world_depth);
  /// Goes on for `step_s`: short beside the reaction time.
  void Advance(double step_s);

  /// The true pose of the depth camera.
  RigidTransform T_world_depth() const;
  double time_s() const { return time_s_; }
  /// The fixed path was gone to its end, but for what was left out. A path without waypoints never
  /// is.
  bool path_complete() const { return !path_.empty() && next_waypoint_ == path_.size(); }

 private:
  /// Holds what a message asks of the operator and when the operator begins to follow it.
  struct Instruction {
    double due_s;
    RigidTransform
        T_world_goal;  ///< Where the message sends the rig; meaningful only with has_goal.
    bool has_goal;     ///< The message sends the rig somewhere.
    bool is_urgent;    ///< The rig is lost: also who follows a fixed path goes to the goal.
    bool hold_still;
    bool slower;
  };

  Instruction Understand(const Feedback& feedback, const RigidTransform& T_world_depth) const;
  /// Does what was heard long enough ago.
  void React();
  /// The rig was lost, on the way to a waypoint maybe.
  void NoteLoss();
  void FollowPath(double step_s);
  void Go(double step_s, const RigidTransform& T_world_goal, double speed_m_s,
          double rotation_rate_deg_s);

  const OperatorTraits traits_;
  const Obedience obedience_;
  const std::vector<Waypoint> path_;
  const std::uint64_t seed_;
  HandMotion hand_;
  double time_s_ = 0.0;
  std::deque<Instruction> heard_;
  Instruction current_;
  std::size_t next_waypoint_ = 0;
  int losses_ = 0;      ///< Losses on the way to the next waypoint.
  double haste_ = 1.0;  ///< Fraction of the full speed that the person goes at now.
};

}  // namespace isotherm
