#include "ground/icp/odometry_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace isotherm {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kRounding = 1e-9;
constexpr double kDepth = 0.5;
constexpr double kInertialGrowth = 0.123;

RigidTransform Rotated(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& p) {
  return MakeTransform(p, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized())));
}

/// A rig that swings, and a source at 100 Hz that sees it in a reference frame of its own.
class OdometryPriorTest : public ::testing::Test {
 protected:
  OdometryPriorTest() { Restart(); }
  void Restart() { prior_.emplace(options_); }

  static CaptureTime At(double seconds) { return CaptureTime(FromSeconds(5000.0 + seconds)); }
  static RigidTransform True(double t) {
    return Rotated(0.3 * std::sin(2.0 * t), {0.2, 1.0, 0.1},
                   {0.1 * std::sin(3.0 * t), 0.2 * t, 0.05 * std::cos(2.0 * t)});
  }
  /// Gives the prior what the source says; `seen` maps time to T_map_depth as the source sees it.
  template <typename Seen>
  void Feed(double from_s, double to_s, Seen seen) {
    for (int i = static_cast<int>(std::lround(100.0 * from_s)); i < 100.0 * to_s - 0.5; ++i) {
      const RigidTransform pose =
          Rotated(2.0, {1.0, -0.3, 0.5}, {10.0, -20.0, 3.0}) * seen(0.01 * i);
      ExternalOdometry sample;
      sample.source = "vio";
      sample.time = At(0.01 * i);
      sample.translation_m = pose.translation();
      sample.rotation = Eigen::Quaterniond(pose.linear());
      sample.position_sigma_m = position_sigma_m_;
      sample.rotation_sigma_rad = 1e-4;
      prior_->Add(sample);
    }
  }
  /// A frame that was tracked at `pose`; the unobservable axes are x, y, z in this order.
  static TrackingResult Tracked(const RigidTransform& pose, int unobservable_axes = 0) {
    TrackingResult result;
    result.T_map_depth = pose;
    result.motion.measured = true;
    result.motion.unobservable_axes = unobservable_axes;
    result.motion.mean_depth_m = kDepth;
    result.motion.scale.tail<3>().setConstant(1.0 / kDepth);
    return result;
  }
  std::optional<OdometryPrior::Prediction> Predict(const RigidTransform& last, double last_s,
                                                   double time_s) {
    return prior_->Predict({At(last_s), last}, At(time_s),
                           MakeTransform({7, 8, 9}, Eigen::Quaterniond::Identity()),
                           {.translation_growth_m = kInertialGrowth});
  }
  /// One frame as the tracker has it: predicts, and notes the pose that was measured. True if the
  /// prediction was used.
  bool Frame(int i, const RigidTransform& measured, int unobservable_axes = 0) {
    const TrackingResult result = Tracked(measured, unobservable_axes);
    const auto prediction = Predict(last_, kFrame_s * (i - 1), kFrame_s * i);
    const bool used = prediction && !prior_->Contradicts(result, At(kFrame_s * i), known_);
    prior_->Note(result, At(kFrame_s * i), known_, used);
    last_ = measured;
    return used;
  }

  ExternalOdometryOptions options_;
  double position_sigma_m_ = 2e-4;
  std::optional<OdometryPrior> prior_;
  RigidTransform last_ = True(0.0);
  Matrix6 known_ = Matrix6::Zero();
};

TEST_F(OdometryPriorTest, TheMotionCountsWhateverTheReferenceFrame) {
  Feed(0.0, 1.0, True);
  // The model is in yet another frame, in which the rig was tracked.
  const RigidTransform elsewhere = Rotated(0.4, {1, 1, 1}, {0.5, 0.6, 0.7});
  const auto prediction = Predict(elsewhere * True(0.31), 0.31, 0.34);
  ASSERT_TRUE(prediction.has_value());
  EXPECT_LT(TranslationDistance(prediction->T_map_depth, elsewhere * True(0.34)), kRounding);
  EXPECT_LT(RotationAngle(prediction->T_map_depth, elsewhere * True(0.34)), 1e-7);
  const double way = (True(0.31).inverse() * True(0.34)).translation().norm();
  EXPECT_NEAR(prediction->error.translation_growth_m, options_.expert().drift_ratio() * way, 1e-7);
  EXPECT_NEAR(prediction->error.translation_noise_m, std::numbers::sqrt2 * position_sigma_m_, 1e-6);
  EXPECT_FALSE(prediction->error.continues);
}

TEST_F(OdometryPriorTest, NothingIsPredictedWithoutASourceOrWhereItHasAGap) {
  EXPECT_FALSE(Predict(True(0.1), 0.1, 0.13).has_value());
  EXPECT_EQ(prior_->counts().missing, 0U) << "no source, nothing missing";
  Feed(0.0, 0.5, True);
  Feed(1.0, 1.5, True);
  EXPECT_TRUE(Predict(True(0.3), 0.3, 0.33).has_value());
  EXPECT_FALSE(Predict(True(0.45), 0.45, 0.75).has_value());
  EXPECT_FALSE(Predict(True(0.75), 0.75, 1.05).has_value());
  EXPECT_EQ(prior_->counts().missing, 2U);
  EXPECT_TRUE(Predict(True(0.45), 0.45, 1.05).has_value()) << "both ends are known";
}

TEST_F(OdometryPriorTest, SwitchedOffItIsOnlyCounted) {
  options_.mutable_expert()->set_enabled(false);
  Restart();
  Feed(0.0, 0.5, True);
  EXPECT_FALSE(Predict(True(0.3), 0.3, 0.33).has_value());
  EXPECT_EQ(prior_->stream().counts().accepted, 50U);
  EXPECT_EQ(prior_->counts().missing, 0U);
}

/// Poses that come late are carried on; what that costs is gone with the next frame and does not
/// add up. Here the whole path is held by the source.
TEST_F(OdometryPriorTest, ErrorsOfLatePosesDoNotAddUp) {
  constexpr double kLate = 0.025;
  // True swings with less than 1 m/s². The newest sample is up to two periods older than the
  // lateness, and the velocity is measured over one period more than is carried on.
  constexpr double kAhead = kLate + 0.02;
  constexpr double kMax = 0.5 * 1.0 * kAhead * (kAhead + kAhead + 0.01);
  double fed = 0.0;
  Feed(0.0, 0.1, True);
  fed = 0.1;
  RigidTransform pose = True(0.1);
  double time = 0.1;
  int predicted = 0;
  for (int i = 1; i <= 90; ++i) {
    const double next = 0.1 + kFrame_s * i;
    const double until = std::floor(100.0 * (next - kLate)) / 100.0;
    Feed(fed, until, True);
    fed = std::max(fed, until);
    const auto prediction = Predict(pose, time, next);
    if (!prediction) continue;
    ++predicted;
    pose = prediction->T_map_depth;
    time = next;
    prior_->Note(Tracked(pose, 6), At(next), known_, true);
    EXPECT_LT(TranslationDistance(pose, True(next)), kMax) << i;
  }
  EXPECT_EQ(predicted, 90);
}

TEST_F(OdometryPriorTest, AnAttitudeFilterTurnsAndInertiaMoves) {
  position_sigma_m_ = ExternalOdometry::kNotMeasured;
  Feed(0.0, 0.5, True);
  const auto prediction = Predict(True(0.2), 0.2, 0.23);
  ASSERT_TRUE(prediction.has_value());
  EXPECT_EQ(prediction->T_map_depth.translation(), Eigen::Vector3d(7, 8, 9));
  EXPECT_LT(RotationAngle(prediction->T_map_depth, True(0.23)), 1e-7);
  EXPECT_EQ(prediction->error.translation_growth_m, kInertialGrowth);
  EXPECT_EQ(prediction->error.translation_noise_m, 0.0);
  EXPECT_LT(prediction->error.rotation_growth_rad, 0.001);
}

/// A source that goes 6 cm too far along x within a frame.
TEST_F(OdometryPriorTest, AContradictionInAnObservedDirectionIsNotBelieved) {
  const auto jumping = [](double t) {
    return Rotated(0.0, {1, 0, 0}, {t < 0.5 ? 0.0 : 0.06, 0, 0}) * True(t);
  };
  options_.mutable_expert()->set_max_speed_m_s(20.0);  // Not a jump by itself.
  Restart();
  Feed(0.0, 2.0, jumping);
  for (int i = 1; i < 15; ++i) EXPECT_TRUE(Frame(i, True(kFrame_s * i))) << i;
  EXPECT_FALSE(Frame(15, True(kFrame_s * 15)));
  EXPECT_EQ(prior_->counts().contradicted, 1U);
  int until_trusted = 16;
  while (until_trusted < 50 && !Frame(until_trusted, True(kFrame_s * until_trusted)))
    ++until_trusted;
  EXPECT_NEAR(until_trusted - 15, 16, 1) << "half a second of agreement";
  EXPECT_EQ(prior_->counts().contradicted, 1U) << "only the frame that jumped";
}

TEST_F(OdometryPriorTest, InAnUnobservableDirectionNothingContradicts) {
  options_.mutable_expert()->set_max_speed_m_s(20.0);
  Restart();
  Feed(0.0, 2.0, [](double t) {
    return Rotated(0.0, {1, 0, 0}, {t < 0.5 ? 0.0 : 0.06, 0, 0}) * True(t);
  });
  for (int i = 1; i < 50; ++i)
    EXPECT_TRUE(Frame(i, True(kFrame_s * i), /*unobservable_axes=*/1)) << i;
  EXPECT_EQ(prior_->counts().contradicted, 0U);
}

/// 0.1 m/s too fast: 3 mm per frame would pass.
TEST_F(OdometryPriorTest, ASlowContradictionAddsUpUntilItIsSeen) {
  Feed(0.0, 2.0, [](double t) { return Rotated(0.0, {1, 0, 0}, {0.0, 0.0, 0.1 * t}) * True(t); });
  int first = 1;
  while (first < 50 && Frame(first, True(kFrame_s * first))) ++first;
  EXPECT_LE(first, 5);
}

/// A direction that was held with an error is corrected once it is measured again: the source is
/// not to blame.
TEST_F(OdometryPriorTest, ACorrectionAfterUnobservableDirectionsIsNoContradiction) {
  const double drift = 0.02;
  Feed(0.0, 2.0, True);
  const auto drifted = [drift](int i) {
    return Rotated(0.0, {1, 0, 0}, {drift, 0, 0}) * True(kFrame_s * i);
  };
  last_ = drifted(0);
  for (int i = 1; i < 20; ++i) EXPECT_TRUE(Frame(i, drifted(i), 1));
  known_(0, 0) = drift * drift;  // As PoseUncertainty has it by then.
  EXPECT_TRUE(Frame(20, True(kFrame_s * 20)));
  known_.setZero();
  for (int i = 21; i < 40; ++i) EXPECT_TRUE(Frame(i, True(kFrame_s * i))) << i;
  EXPECT_EQ(prior_->counts().contradicted, 0U);
}

/// Going on in another sub-map's coordinates is no motion.
TEST_F(OdometryPriorTest, OtherCoordinatesOfTheModelContradictNothing) {
  Feed(0.0, 2.0, True);
  const RigidTransform T_new_old = Rotated(1.2, {0, 1, 1}, {0.3, -0.4, 0.5});
  for (int i = 1; i < 10; ++i) EXPECT_TRUE(Frame(i, True(kFrame_s * i))) << i;
  prior_->Transform(T_new_old);
  last_ = T_new_old * last_;
  for (int i = 10; i < 20; ++i) EXPECT_TRUE(Frame(i, T_new_old * True(kFrame_s * i))) << i;
  EXPECT_EQ(prior_->counts().contradicted, 0U);
}

TEST_F(OdometryPriorTest, OneErrorAddsUpAndTheOtherGoesOnWhileTheSourceDoes) {
  Feed(0.0, 2.0, True);
  Frame(1, True(kFrame_s));
  EXPECT_TRUE(Predict(last_, kFrame_s, 2 * kFrame_s)->error.continues);
  prior_->Reset();
  EXPECT_FALSE(Predict(last_, kFrame_s, 2 * kFrame_s)->error.continues);
}

}  // namespace
}  // namespace isotherm
