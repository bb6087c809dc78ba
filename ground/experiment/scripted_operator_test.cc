#include "ground/experiment/scripted_operator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr double kStep_s = 0.005;

RigidTransform Pose(double x, double y, double z, double turned_deg = 0.0) {
  return MakeTransform({x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(turned_deg * kRadPerDeg,
                                                                       Eigen::Vector3d::UnitY())));
}

/// The fastest that a rig was moved and turned, and the strongest it was accelerated.
struct Extremes {
  double speed_m_s = 0.0, acceleration_m_s2 = 0.0;
  double rotation_rate_deg_s = 0.0, angular_acceleration_deg_s2 = 0.0;
};

/// By differences between three poses one step apart.
class MotionMeter {
 public:
  void Add(const RigidTransform& pose) {
    if (before_) {
      const Eigen::Vector3d v = (pose.translation() - before_->translation()) / kStep_s;
      const Eigen::AngleAxisd rotation(pose.linear() * before_->linear().transpose());
      const Eigen::Vector3d w = rotation.angle() * rotation.axis() / kRadPerDeg / kStep_s;
      const auto raise = [](double& extreme, double value) { extreme = std::max(extreme, value); };
      raise(extremes_.speed_m_s, v.norm());
      raise(extremes_.rotation_rate_deg_s, w.norm());
      if (moved_) {
        raise(extremes_.acceleration_m_s2, (v - v_).norm() / kStep_s);
        raise(extremes_.angular_acceleration_deg_s2, (w - w_).norm() / kStep_s);
      }
      v_ = v;
      w_ = w;
      moved_ = true;
    }
    before_ = pose;
  }
  const Extremes& extremes() const { return extremes_; }

 private:
  std::optional<RigidTransform> before_;
  Eigen::Vector3d v_, w_;
  bool moved_ = false;
  Extremes extremes_;
};

/// Somebody who holds the rig still, so that what is left is what the test looks at.
OperatorTraits SteadyPerson() {
  OperatorTraits traits;
  traits.sway_m = 0.0;
  traits.sway_deg = 0.0;
  return traits;
}

class ScriptedOperatorTest : public ::testing::Test {
 protected:
  static ScriptedOperator Person(const OperatorTraits& traits, const Obedience& obedience = {},
                                 std::vector<Waypoint> path = {}, std::uint64_t seed = 1) {
    return {traits, obedience, RigidTransform::Identity(), std::move(path), seed};
  }
  static Feedback NextView(const RigidTransform& T_depth_next) {
    Feedback feedback;
    feedback.tracking_state = TrackingState::kTracked;
    feedback.T_depth_next = T_depth_next;
    return feedback;
  }
  static Feedback Say(Advice advice) {
    Feedback feedback;
    feedback.tracking_state = TrackingState::kTracked;
    feedback.advice = {advice};
    return feedback;
  }
  /// Goes on without hearing anything.
  static Extremes Let(ScriptedOperator& person, double duration_s) {
    MotionMeter meter;
    const auto steps = static_cast<int>(std::ceil(duration_s / kStep_s));
    for (int i = 0; i < steps; ++i) {
      person.Advance(kStep_s);
      meter.Add(person.T_world_depth());
    }
    return meter.extremes();
  }
};

TEST_F(ScriptedOperatorTest, GoesToTheNextViewAndRestsThere) {
  ScriptedOperator person = Person(SteadyPerson());
  const RigidTransform view = Pose(0.5, -0.2, 0.1, 30.0);
  person.Hear(NextView(view), person.T_world_depth());
  Let(person, 6.0);
  EXPECT_LT(TranslationDistance(person.T_world_depth(), view), 0.001);
  EXPECT_LT(RotationAngle(person.T_world_depth(), view), 0.1 * kRadPerDeg);
  EXPECT_LT(Let(person, 1.0).speed_m_s, 0.001);
}

TEST_F(ScriptedOperatorTest, TheNextViewIsMeantFromWhereTheMessageIsAbout) {
  ScriptedOperator person = Person(SteadyPerson());
  const RigidTransform seen_from = Pose(0.1, 0.0, 0.0, 90.0);
  person.Hear(NextView(Pose(0.0, 0.0, 0.2)), seen_from);
  Let(person, 10.0);
  EXPECT_LT((person.T_world_depth().translation() - Eigen::Vector3d(0.3, 0.0, 0.0)).norm(), 0.001);
}

TEST_F(ScriptedOperatorTest, NeitherSpeedNorAccelerationExceedThePersons) {
  const OperatorTraits traits = SteadyPerson();
  ScriptedOperator person = Person(traits);
  MotionMeter meter;
  // Sent about faster than anybody can go, and back.
  for (int i = 0; i < 4000; ++i) {
    if (i % 20 == 0) {
      person.Hear(NextView(Pose(i % 300 < 150 ? 1.0 : -1.0, 0.4, 0.0, i % 500 < 250 ? 80 : -80)),
                  person.T_world_depth());
    }
    person.Advance(kStep_s);
    meter.Add(person.T_world_depth());
  }
  constexpr double kRounding = 1.001;
  EXPECT_LT(meter.extremes().speed_m_s, kRounding * traits.speed_m_s);
  EXPECT_GT(meter.extremes().speed_m_s, 0.9 * traits.speed_m_s) << "or nothing was tried";
  EXPECT_LT(meter.extremes().rotation_rate_deg_s, kRounding * traits.rotation_rate_deg_s);
  EXPECT_GT(meter.extremes().rotation_rate_deg_s, 0.9 * traits.rotation_rate_deg_s);
  EXPECT_LT(meter.extremes().acceleration_m_s2, kRounding * traits.acceleration_m_s2);
  EXPECT_LT(meter.extremes().angular_acceleration_deg_s2,
            kRounding * traits.angular_acceleration_deg_s2);
}

TEST_F(ScriptedOperatorTest, WhatIsHeardHasItsEffectAfterTheReactionTime) {
  OperatorTraits traits = SteadyPerson();
  traits.reaction_s = 0.45;
  ScriptedOperator person = Person(traits);
  person.Hear(NextView(Pose(1.0, 0.0, 0.0)), person.T_world_depth());
  EXPECT_EQ(Let(person, 0.43).speed_m_s, 0.0);
  EXPECT_GT(Let(person, 0.1).speed_m_s, 0.0);
}

TEST_F(ScriptedOperatorTest, GoesSlowerWhenToldToAndFasterAgainWhenNot) {
  ScriptedOperator person = Person(SteadyPerson());
  Feedback slower = NextView(Pose(9.0, 0.0, 0.0));
  person.Hear(slower, person.T_world_depth());
  EXPECT_NEAR(Let(person, 2.0).speed_m_s, 0.3, 0.001);
  slower.advice = {Advice::kSlower};
  person.Hear(slower, person.T_world_depth());
  Let(person, 2.0);
  EXPECT_LT(Let(person, 0.5).speed_m_s, 0.05);
  person.Hear(NextView(Pose(9.0, 0.0, 0.0)), person.T_world_depth());
  EXPECT_NEAR(Let(person, 3.0).speed_m_s, 0.3, 0.001);
}

TEST_F(ScriptedOperatorTest, WhoDoesNotHeedSlowerStaysFast) {
  ScriptedOperator person = Person(SteadyPerson(), {.next_view = true, .slower = false});
  Feedback slower = NextView(Pose(9.0, 0.0, 0.0));
  slower.advice = {Advice::kSlower};
  person.Hear(slower, person.T_world_depth());
  Let(person, 2.0);
  EXPECT_NEAR(Let(person, 0.5).speed_m_s, 0.3, 0.001);
}

TEST_F(ScriptedOperatorTest, HoldsStillWhileTheCameraCorrectsItself) {
  ScriptedOperator person = Person(SteadyPerson());
  person.Hear(NextView(Pose(9.0, 0.0, 0.0)), person.T_world_depth());
  Let(person, 2.0);
  person.Hear(Say(Advice::kHoldForNuc), person.T_world_depth());
  Let(person, 1.5);
  EXPECT_EQ(Let(person, 0.5).speed_m_s, 0.0);
}

TEST_F(ScriptedOperatorTest, GoesWhereTrackingLastWorkedEvenFromAPath) {
  ScriptedOperator person = Person(SteadyPerson(), {.next_view = false, .slower = false},
                                   {{Pose(5.0, 0.0, 0.0), 0.3, 17.0}});
  Let(person, 2.0);
  Feedback lost;
  lost.tracking_state = TrackingState::kLost;
  lost.T_world_depth_next = Pose(0.0, 0.1, 0.0);
  person.Hear(lost, person.T_world_depth());
  Let(person, 5.0);
  EXPECT_LT(TranslationDistance(person.T_world_depth(), Pose(0.0, 0.1, 0.0)), 0.001);
}

TEST_F(ScriptedOperatorTest, LeavesAWaypointOutOnTheWayToWhichTheRigWasLostTwice) {
  const RigidTransform beyond = Pose(0.0, 0.0, 0.3);
  ScriptedOperator person = Person(SteadyPerson(), {.next_view = false, .slower = false},
                                   {{Pose(5.0, 0.0, 0.0), 0.3, 17.0}, {beyond, 0.3, 17.0}});
  Feedback lost;
  lost.tracking_state = TrackingState::kLost;
  lost.T_world_depth_next = Pose(0.0, 0.0, 0.0);
  const auto lose_for = [&](int tenths_s) {
    for (int i = 0; i < tenths_s; ++i) {
      person.Hear(lost, person.T_world_depth());
      Let(person, 0.1);
    }
  };
  const auto find_for = [&](double duration_s) {
    Feedback found;
    found.tracking_state = TrackingState::kTracked;
    person.Hear(found, person.T_world_depth());
    Let(person, duration_s);
  };
  find_for(1.0);
  lose_for(60);
  find_for(4.0);
  EXPECT_GT(person.T_world_depth().translation().x(), 0.5) << "once, and goes on to it";
  EXPECT_FALSE(person.path_complete());
  lose_for(80);
  find_for(4.0);
  EXPECT_LT(TranslationDistance(person.T_world_depth(), beyond), 0.01);
  EXPECT_TRUE(person.path_complete());
}

TEST_F(ScriptedOperatorTest, ComesCloserAndStepsBackWhereNoViewIsProposed) {
  ScriptedOperator person = Person(SteadyPerson());
  person.Hear(Say(Advice::kMoveCloser), person.T_world_depth());
  Let(person, 3.0);
  EXPECT_NEAR(person.T_world_depth().translation().z(), 0.05, 0.001);
  person.Hear(Say(Advice::kMoveFarther), person.T_world_depth());
  Let(person, 3.0);
  EXPECT_NEAR(person.T_world_depth().translation().z(), 0.0, 0.001);
}

TEST_F(ScriptedOperatorTest, APathIsGoneAlongAtItsOwnSpeedToItsEnd) {
  ScriptedOperator person =
      Person(SteadyPerson(), {.next_view = false, .slower = false},
             {{Pose(0.2, 0.0, 0.0), 0.1, 17.0}, {Pose(0.2, 0.2, 0.0), 0.05, 17.0}});
  person.Hear(NextView(Pose(-1.0, 0.0, 0.0)), person.T_world_depth());
  EXPECT_NEAR(Let(person, 1.8).speed_m_s, 0.1, 0.001);
  EXPECT_FALSE(person.path_complete());
  Let(person, 8.0);
  EXPECT_TRUE(person.path_complete());
  EXPECT_LT(TranslationDistance(person.T_world_depth(), Pose(0.2, 0.2, 0.0)), 0.02);
}

TEST_F(ScriptedOperatorTest, SwayIsSmallSmoothAndAPersonsOwn) {
  const OperatorTraits traits;
  ScriptedOperator person = Person(traits), same = Person(traits),
                   other = Person(traits, {}, {}, 2);
  double largest_m = 0.0, largest_rad = 0.0, apart_m = 0.0;
  MotionMeter meter;
  for (int i = 0; i < 4000; ++i) {
    for (ScriptedOperator* each : {&person, &same, &other}) each->Advance(kStep_s);
    const RigidTransform& pose = person.T_world_depth();
    EXPECT_TRUE(pose.isApprox(same.T_world_depth(), 0.0));
    largest_m = std::max(largest_m, pose.translation().cwiseAbs().maxCoeff());
    largest_rad = std::max(largest_rad, RotationAngle(pose, RigidTransform::Identity()));
    apart_m = std::max(apart_m, TranslationDistance(pose, other.T_world_depth()));
    meter.Add(pose);
  }
  EXPECT_LE(largest_m, traits.sway_m);
  EXPECT_GT(largest_m, 0.4 * traits.sway_m);
  EXPECT_LE(largest_rad, std::sqrt(3.0) * traits.sway_deg * kRadPerDeg);
  EXPECT_GT(apart_m, 0.5 * traits.sway_m);
  // Three slow sines: nobody trembles.
  EXPECT_LT(meter.extremes().speed_m_s, 0.02);
  EXPECT_LT(meter.extremes().acceleration_m_s2, 0.1);
}

TEST_F(ScriptedOperatorTest, PersonsReactInThreeToFiveTenthsOfASecond) {
  double min_s = 1.0, max_s = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const OperatorTraits traits = TraitsOfPerson(seed);
    min_s = std::min(min_s, traits.reaction_s);
    max_s = std::max(max_s, traits.reaction_s);
    EXPECT_EQ(traits.reaction_s, TraitsOfPerson(seed).reaction_s);
    EXPECT_LE(traits.speed_m_s, 0.3);
    EXPECT_LE(traits.rotation_rate_deg_s, 17.0);
  }
  EXPECT_GE(min_s, 0.3);
  EXPECT_LT(min_s, 0.32);
  EXPECT_GT(max_s, 0.48);
  EXPECT_LE(max_s, 0.5);
}

}  // namespace
}  // namespace isotherm
