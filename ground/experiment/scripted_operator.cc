#include "ground/experiment/scripted_operator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/noise.h"
#include "common/base/units.h"

namespace isotherm {
namespace {

/// Says what a stream of random numbers is for.
enum NoisePurpose : std::uint64_t { kTraits, kSway };

/// Who is told to go slower halves the speed in this time, down to this fraction, and takes it up
/// again in this time when nobody says so any more.
constexpr double kHalvingTime_s = 0.3;
constexpr double kMinHaste = 0.1;
constexpr double kRecoveryTime_s = 1.5;

/// A waypoint is reached within these.
constexpr double kAtWaypoint_m = 0.01;
constexpr double kAtWaypoint_rad = 2.0 * kRadPerDeg;

/// Whoever was lost so often on the way to a waypoint goes on to the one after it: once may be
/// chance; to try for ever is what nobody does.
constexpr int kLossesPerWaypoint = 2;

/// How far a person goes at a time who is told "closer" or "farther".
constexpr double kHandbreadth_m = 0.05;

bool Has(const Feedback& feedback, Advice advice) {
  return std::ranges::find(feedback.advice, advice) != feedback.advice.end();
}

/// The velocity after `step_s` of something that should come to rest `way` further: as fast as it
/// can still be stopped from, at most `limit`.
Eigen::Vector3d Steer(const Eigen::Vector3d& velocity, const Eigen::Vector3d& way, double limit,
                      double acceleration, double step_s) {
  const double distance = way.norm();
  Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
  if (distance > 0.0) {
    // A person brakes a little earlier than the muscles would have to.
    constexpr double kReserve = 0.7;
    const double stoppable = std::sqrt(2.0 * kReserve * acceleration * distance);
    wanted = way / distance * std::min({limit, stoppable, distance / step_s});
  }
  const Eigen::Vector3d change = wanted - velocity;
  const double largest = acceleration * step_s;
  return change.norm() <= largest ? wanted : velocity + change.normalized() * largest;
}

/// Sway about zero within -1..1, smooth: three slow sines with phases of their own.
double Sway(double time_s, std::uint64_t stream) {
  // Without a common period, so that the sway does not repeat within a scan. Not taken from people.
  constexpr double kPeriods_s[] = {1.7, 2.9, 4.3};
  double sum = 0.0;
  for (std::uint64_t i = 0; i < std::size(kPeriods_s); ++i) {
    const double phase = 2.0 * std::numbers::pi * UniformNoise(stream, i);
    sum += std::sin(2.0 * std::numbers::pi * time_s / kPeriods_s[i] + phase);
  }
  return sum / static_cast<double>(std::size(kPeriods_s));
}

}  // namespace

OperatorTraits TraitsOfPerson(std::uint64_t seed) {
  const std::uint64_t stream = NoiseStream(seed, kTraits, 0);
  OperatorTraits traits;
  traits.reaction_s = 0.3 + 0.2 * UniformNoise(stream, 0);
  traits.sway_m = 0.002 + 0.002 * UniformNoise(stream, 1);
  return traits;
}

void HandMotion::Advance(double step_s, const RigidTransform& T_world_goal, double speed_m_s,
                         double rotation_rate_rad_s) {
  velocity_m_s_ = Steer(velocity_m_s_, T_world_goal.translation() - T_world_depth_.translation(),
                        speed_m_s, traits_.acceleration_m_s2, step_s);
  const Eigen::AngleAxisd to_goal(T_world_goal.linear() * T_world_depth_.linear().transpose());
  rotation_rate_rad_s_ =
      Steer(rotation_rate_rad_s_, to_goal.angle() * to_goal.axis(), rotation_rate_rad_s,
            traits_.angular_acceleration_deg_s2 * kRadPerDeg, step_s);
  T_world_depth_.translation() += step_s * velocity_m_s_;
  const double angle = step_s * rotation_rate_rad_s_.norm();
  if (!(angle > 0.0)) return;
  const Eigen::AngleAxisd rotation(angle, rotation_rate_rad_s_.normalized());
  T_world_depth_.linear() =
      Eigen::Quaterniond(rotation * T_world_depth_.linear()).normalized().toRotationMatrix();
}

ScriptedOperator::ScriptedOperator(const OperatorTraits& traits, const Obedience& obedience,
                                   const RigidTransform& T_world_depth, std::vector<Waypoint> path,
                                   std::uint64_t seed)
    : traits_(traits),
      obedience_(obedience),
      path_(std::move(path)),
      seed_(seed),
      hand_(traits, T_world_depth),
      current_{.due_s = 0.0,
               .T_world_goal = T_world_depth,
               .has_goal = false,
               .is_urgent = false,
               .hold_still = false,
               .slower = false} {}

ScriptedOperator::Instruction ScriptedOperator::Understand(
    const Feedback& feedback, const RigidTransform& T_world_depth) const {
  Instruction instruction{.due_s = time_s_ + traits_.reaction_s,
                          .T_world_goal = T_world_depth,
                          .has_goal = false,
                          .is_urgent = false,
                          .hold_still = Has(feedback, Advice::kHoldForNuc) || feedback.done,
                          .slower = Has(feedback, Advice::kSlower)};
  // The same where the view slides.
  if (feedback.tracking_state == TrackingState::kLost ||
      (Has(feedback, Advice::kGoBackToRelocalise) && !feedback.T_depth_next)) {
    instruction.is_urgent = true;
    instruction.has_goal = feedback.T_world_depth_next.has_value();
    if (instruction.has_goal) instruction.T_world_goal = *feedback.T_world_depth_next;
    return instruction;
  }
  instruction.has_goal = true;
  if (feedback.T_depth_next) {
    // As seen from the camera: what the tracker believes in `world` does not matter.
    instruction.T_world_goal = T_world_depth * *feedback.T_depth_next;
  } else if (Has(feedback, Advice::kMoveCloser)) {
    instruction.T_world_goal.translation() += kHandbreadth_m * T_world_depth.linear().col(2);
  } else if (Has(feedback, Advice::kMoveFarther)) {
    instruction.T_world_goal.translation() -= kHandbreadth_m * T_world_depth.linear().col(2);
  } else {
    instruction.has_goal = false;
  }
  return instruction;
}

void ScriptedOperator::Hear(const Feedback& feedback, const RigidTransform& T_world_depth) {
  heard_.push_back(Understand(feedback, T_world_depth));
}

void ScriptedOperator::React() {
  while (!heard_.empty() && heard_.front().due_s <= time_s_) {
    const RigidTransform T_world_goal = current_.T_world_goal;
    if (heard_.front().is_urgent && !current_.is_urgent) NoteLoss();
    current_ = heard_.front();
    heard_.pop_front();
    // Who is told nothing new goes on to where they were sent before.
    if (!current_.has_goal) current_.T_world_goal = T_world_goal;
  }
}

void ScriptedOperator::NoteLoss() {
  if (next_waypoint_ == path_.size() || ++losses_ < kLossesPerWaypoint) return;
  ++next_waypoint_;
  losses_ = 0;
}

void ScriptedOperator::Go(double step_s, const RigidTransform& T_world_goal, double speed_m_s,
                          double rotation_rate_deg_s) {
  hand_.Advance(step_s, T_world_goal, haste_ * std::min(speed_m_s, traits_.speed_m_s),
                haste_ * std::min(rotation_rate_deg_s, traits_.rotation_rate_deg_s) * kRadPerDeg);
}

void ScriptedOperator::FollowPath(double step_s) {
  const Waypoint& waypoint = path_[std::min(next_waypoint_, path_.size() - 1)];
  Go(step_s, waypoint.T_world_depth, waypoint.speed_m_s, waypoint.rotation_rate_deg_s);
  if (next_waypoint_ < path_.size() &&
      TranslationDistance(hand_.T_world_depth(), waypoint.T_world_depth) < kAtWaypoint_m &&
      RotationAngle(hand_.T_world_depth(), waypoint.T_world_depth) < kAtWaypoint_rad) {
    ++next_waypoint_;
    losses_ = 0;
  }
}

void ScriptedOperator::Advance(double step_s) {
  time_s_ += step_s;
  React();
  const bool slows_down = obedience_.slower && current_.slower;
  haste_ = slows_down ? std::max(kMinHaste, haste_ * std::exp2(-step_s / kHalvingTime_s))
                      : std::min(1.0, haste_ + step_s / kRecoveryTime_s);
  if (current_.hold_still) {
    Go(step_s, hand_.T_world_depth(), 0.0, 0.0);
  } else if (obedience_.next_view || current_.is_urgent || path_.empty()) {
    Go(step_s, current_.T_world_goal, traits_.speed_m_s, traits_.rotation_rate_deg_s);
  } else {
    FollowPath(step_s);
  }
}

RigidTransform ScriptedOperator::T_world_depth() const {
  Eigen::Matrix<double, 6, 1> sway;
  for (int i = 0; i < 6; ++i) {
    const double largest = i < 3 ? traits_.sway_m : traits_.sway_deg * kRadPerDeg;
    sway[i] = largest * Sway(time_s_, NoiseStream(seed_, kSway, static_cast<std::uint64_t>(i)));
  }
  return hand_.T_world_depth() * TransformFromTwist(sway);
}

}  // namespace isotherm
