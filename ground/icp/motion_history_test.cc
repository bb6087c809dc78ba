#include "ground/icp/motion_history.h"

#include <gtest/gtest.h>

#include <chrono>

#include "common/base/units.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr double kRounding = 1e-9;

class MotionHistoryTest : public ::testing::Test {
 protected:
  static constexpr milliseconds kFrame{33};
  static CaptureTime At(int frame) { return CaptureTime(std::chrono::hours(1) + frame * kFrame); }
  static RigidTransform Rotated(double angle_rad, const Eigen::Vector3d& p_map) {
    const Eigen::Vector3d axis = Eigen::Vector3d(0.4, 1.0, -0.3).normalized();
    return MakeTransform(p_map, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)));
  }
  static RigidTransform Sliding(double frame) {
    return Rotated(0.7,
                   Eigen::Vector3d(1.0, -2.0, 0.5) + frame * Eigen::Vector3d(0.01, 0.002, -0.005));
  }
  static RigidTransform Rotating(double frame) {
    return Rotated(0.7 + frame * 2.0 * kRadPerDeg, {1.0, -2.0, 0.5});
  }
  static void ExpectNear(const std::optional<RigidTransform>& pose,
                         const RigidTransform& expected) {
    ASSERT_TRUE(pose.has_value());
    EXPECT_LT(TranslationDistance(*pose, expected), kRounding);
    EXPECT_LT(RotationAngle(*pose, expected), 1e-7);
  }

  MotionHistory history_;
};

TEST_F(MotionHistoryTest, ConstantVelocityGoesOn) {
  for (const auto& motion : {Sliding, Rotating}) {
    history_.Clear();
    for (int frame = 0; frame < 20; ++frame) history_.Add({At(frame), motion(frame)});
    for (const int ahead : {0, 1, 2}) {
      SCOPED_TRACE(ahead);
      ExpectNear(history_.Predict(At(19 + ahead)), motion(19 + ahead));
      ExpectNear(history_.PredictSmoothly(At(19 + ahead)), motion(19 + ahead));
    }
    ExpectNear(history_.Predict(At(19) + kFrame / 3), motion(19.0 + 11.0 / 33.0));
  }
}

TEST_F(MotionHistoryTest, AScrewGoesOnByTheSameMotionInTheRigsCoordinates) {
  const RigidTransform motion = Rotated(3.0 * kRadPerDeg, {0.01, 0.0, 0.02});
  const RigidTransform first = Rotated(1.2, {0.3, 0.1, -0.4});
  history_.Add({At(0), first});
  history_.Add({At(1), first * motion});
  ExpectNear(history_.Predict(At(2)), first * motion * motion);
}

TEST_F(MotionHistoryTest, SmoothPredictionHasLessOfTheNoise) {
  constexpr double kNoise_m = 0.001;
  for (int frame = 0; frame < 20; ++frame) {
    RigidTransform pose = Sliding(frame);
    pose.translation().x() += frame == 18 ? kNoise_m : 0.0;
    history_.Add({At(frame), pose});
  }
  EXPECT_NEAR(TranslationDistance(*history_.Predict(At(20)), Sliding(20)), kNoise_m, kRounding);
  EXPECT_LT(TranslationDistance(*history_.PredictSmoothly(At(20)), Sliding(20)), 0.2 * kNoise_m);
}

TEST_F(MotionHistoryTest, NothingIsPredictedWithFewerThanTwoPoses) {
  EXPECT_FALSE(history_.last().has_value());
  EXPECT_FALSE(history_.Predict(At(0)).has_value());
  history_.Add({At(0), Sliding(0)});
  EXPECT_FALSE(history_.before_last().has_value());
  EXPECT_FALSE(history_.Predict(At(1)).has_value());
  EXPECT_FALSE(history_.PredictSmoothly(At(1)).has_value());
  history_.Add({At(1), Sliding(1)});
  EXPECT_EQ(history_.before_last()->time, At(0));
  EXPECT_EQ(history_.last()->time, At(1));
  EXPECT_FALSE(history_.third_last().has_value());
  EXPECT_TRUE(history_.Predict(At(2)).has_value());
}

TEST_F(MotionHistoryTest, NothingIsPredictedBeyondTwoFramesOrBackwards) {
  for (int frame = 0; frame < 5; ++frame) history_.Add({At(frame), Sliding(frame)});
  EXPECT_EQ(history_.third_last()->time, At(2));
  EXPECT_TRUE(history_.Predict(At(6)).has_value());
  EXPECT_FALSE(history_.Predict(At(6) + Nanoseconds(1000)).has_value());
  EXPECT_FALSE(history_.PredictSmoothly(At(6) + Nanoseconds(1000)).has_value());
  EXPECT_FALSE(history_.Predict(At(4) - Nanoseconds(1000)).has_value());
}

TEST_F(MotionHistoryTest, NothingIsPredictedFromPosesOfOneTime) {
  history_.Add({At(0), Sliding(0)});
  history_.Add({At(0), Sliding(1)});
  EXPECT_FALSE(history_.Predict(At(0)).has_value());
  EXPECT_FALSE(history_.PredictSmoothly(At(0)).has_value());
}

TEST_F(MotionHistoryTest, ClearForgetsTheMotion) {
  for (int frame = 0; frame < 5; ++frame) history_.Add({At(frame), Sliding(frame)});
  history_.Clear();
  EXPECT_FALSE(history_.last().has_value());
  history_.Add({At(5), Rotating(5)});
  EXPECT_FALSE(history_.Predict(At(6)).has_value());
}

}  // namespace
}  // namespace isotherm
