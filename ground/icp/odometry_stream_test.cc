#include "ground/icp/odometry_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/base/units.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using Refused = EnumArray<OdometryFault, std::uint64_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-9;

class OdometryStreamTest : public ::testing::Test {
 protected:
  static constexpr milliseconds kPeriod{10};

  OdometryStreamTest() {
    options_.mutable_expert()->set_max_ahead_s(0.0);
    Restart();
  }

  static CaptureTime At(double sample) {
    return CaptureTime(std::chrono::hours(1) +
                       Nanoseconds(static_cast<std::int64_t>(sample * 1e6 * kPeriod.count())));
  }
  /// Along x at 0.5 m/s while turning about z at 30 degrees/s.
  static ExternalOdometry Sample(double index) {
    ExternalOdometry pose;
    pose.source = "vio";
    pose.time = At(index);
    pose.translation_m = {0.005 * index, 1.0, -2.0};
    pose.rotation = Eigen::AngleAxisd(0.3 * kRadPerDeg * index, Eigen::Vector3d::UnitZ());
    return pose;
  }
  void Feed(int first, int last) {
    for (int i = first; i <= last; ++i) stream_->Add(Sample(i));
  }
  void ExpectAt(double index, const RigidTransform& expected) {
    const auto estimate = stream_->At(At(index));
    ASSERT_TRUE(estimate.has_value()) << index;
    EXPECT_LT(TranslationDistance(estimate->T_reference_depth, expected), kRounding) << index;
    EXPECT_LT(RotationAngle(estimate->T_reference_depth, expected), 1e-7) << index;
  }
  static RigidTransform Pose(double index) {
    return MakeTransform(Sample(index).translation_m, Sample(index).rotation);
  }
  void Restart() { stream_.emplace(options_); }

  ExternalOdometryOptions options_;
  std::optional<OdometryStream> stream_;
};

TEST_F(OdometryStreamTest, BetweenSamplesThePoseIsLinearAndSlerp) {
  Feed(0, 10);
  ExpectAt(4.0, Pose(4.0));
  ExpectAt(4.3, Pose(4.3));
  ExpectAt(0.0, Pose(0.0));
  EXPECT_FALSE(stream_->At(At(-0.1)).has_value());
  EXPECT_FALSE(stream_->At(At(10.1)).has_value()) << "nothing is carried on with max_ahead_s 0";
}

TEST_F(OdometryStreamTest, AFrameSomewhatNewerGetsThePoseCarriedOn) {
  options_.mutable_expert()->set_max_ahead_s(0.03);
  Restart();
  Feed(0, 10);
  ExpectAt(12.5, Pose(12.5));
  EXPECT_FALSE(stream_->At(At(13.1)).has_value());
  EXPECT_GT(stream_->At(At(12.5))->position_noise_m, stream_->At(At(9.5))->position_noise_m);
}

TEST_F(OdometryStreamTest, AGapIsNotInterpolatedAcrossAndNeitherCarriedOnFrom) {
  options_.mutable_expert()->set_max_gap_s(0.05);
  options_.mutable_expert()->set_max_ahead_s(0.05);
  Restart();
  Feed(0, 10);
  Feed(20, 20);
  EXPECT_FALSE(stream_->At(At(15)).has_value());
  EXPECT_FALSE(stream_->At(At(21)).has_value()) << "one pose behind the gap has no velocity";
  Feed(21, 30);
  ExpectAt(8.5, Pose(8.5));
  ExpectAt(25.5, Pose(25.5));
  EXPECT_EQ(stream_->counts().gaps, 1U);
  EXPECT_EQ(stream_->counts().accepted, 22U);
}

TEST_F(OdometryStreamTest, TheBodyMayBeMountedAnywhereOnTheRig) {
  const RigidTransform T_depth_body = MakeTransform(
      {0.1, 0.0, -0.05},
      Eigen::Quaterniond(Eigen::AngleAxisd(90 * kRadPerDeg, Eigen::Vector3d::UnitZ())));
  *options_.mutable_t_depth_body() = ToOptions(T_depth_body);
  Restart();
  Feed(0, 3);
  ExpectAt(2.0, Pose(2.0) * T_depth_body.inverse());
}

TEST_F(OdometryStreamTest, WhatCannotBeIsRefusedAndCountedByReason) {
  Feed(0, 5);
  ExternalOdometry bad = Sample(6);
  bad.translation_m.y() = kNan;
  stream_->Add(bad);
  bad = Sample(6);
  bad.rotation.x() = kNan;
  stream_->Add(bad);
  bad = Sample(6);
  bad.rotation.coeffs() *= 1.1;
  stream_->Add(bad);
  bad = Sample(6);
  bad.rotation.coeffs().setZero();
  stream_->Add(bad);
  bad = Sample(6);
  bad.position_sigma_m = -0.01;
  stream_->Add(bad);
  bad = Sample(6);
  bad.source = "mocap";
  stream_->Add(bad);
  stream_->Add(Sample(3));
  stream_->Add(Sample(5));
  bad = Sample(6);
  bad.translation_m.x() += 0.2;
  stream_->Add(bad);
  Feed(6, 10);
  EXPECT_EQ(stream_->counts().refused, (Refused{{OdometryFault::kNotFinite, 2},
                                                {OdometryFault::kQuaternion, 2},
                                                {OdometryFault::kSigma, 1},
                                                {OdometryFault::kOtherSource, 1},
                                                {OdometryFault::kTime, 2},
                                                {OdometryFault::kJump, 1}}));
  EXPECT_EQ(stream_->counts().accepted, 11U);
  EXPECT_EQ(stream_->counts().in, 20U);
  EXPECT_EQ(stream_->counts().restarts, 0U);
  ExpectAt(6.5, Pose(6.5));
}

TEST_F(OdometryStreamTest, EachReasonIsSaidOnce) {
  ExternalOdometry bad = Sample(0);
  bad.rotation.w() = kNan;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 100; ++i) stream_->Add(bad);
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
  EXPECT_THAT(log, HasSubstr("reason=not_finite"));
}

/// Odometry that relocalises: its reference frame is another one from then on.
TEST_F(OdometryStreamTest, AfterAJumpThatStaysTheSourceStartsAgain) {
  const auto moved = [](double i) {
    ExternalOdometry pose = Sample(i);
    pose.translation_m.z() += 3.0;
    return pose;
  };
  Feed(0, 10);
  for (int i = 11; i <= 15; ++i) stream_->Add(moved(i));
  EXPECT_EQ(stream_->counts().refused, (Refused{{OdometryFault::kJump, 1}}));
  EXPECT_EQ(stream_->counts().restarts, 1U);
  EXPECT_FALSE(stream_->At(At(10.5)).has_value()) << "nothing is known across the jump";
  EXPECT_FALSE(stream_->At(At(9.5)).has_value());
  ExpectAt(13.5, MakeTransform(moved(13.5).translation_m, moved(13.5).rotation));
}

/// A sender whose clock was set back.
TEST_F(OdometryStreamTest, AfterTimeWentBackTheSourceStartsAgain) {
  Feed(100, 110);
  Feed(50, 55);
  EXPECT_EQ(stream_->counts().refused, (Refused{{OdometryFault::kTime, 1}}));
  EXPECT_EQ(stream_->counts().restarts, 1U);
  ExpectAt(53.5, Pose(53.5));
  EXPECT_FALSE(stream_->At(At(105.0)).has_value());
}

TEST_F(OdometryStreamTest, SigmasOfTheSourceGoBeforeThoseOfTheOptions) {
  Feed(0, 5);
  EXPECT_EQ(stream_->At(At(3.0))->position_noise_m, options_.expert().position_sigma_m());
  ExternalOdometry pose = Sample(6);
  pose.position_sigma_m = 0.02;
  pose.rotation_sigma_rad = 0.03;
  stream_->Add(pose);
  EXPECT_EQ(stream_->At(At(6.0))->position_noise_m, 0.02);
  EXPECT_EQ(stream_->At(At(6.0))->rotation_noise_rad, 0.03);
}

/// 0.5 m/s with a stamp that is off by 4 ms is 2 mm.
TEST_F(OdometryStreamTest, AnUncertainStampIsAnUncertainPose) {
  for (int i = 0; i < 5; ++i) {
    ExternalOdometry pose = Sample(i);
    pose.position_sigma_m = 0.0;
    pose.time_sigma = milliseconds(4);
    stream_->Add(pose);
  }
  EXPECT_NEAR(stream_->At(At(2.5))->position_noise_m, 0.002, kRounding);
}

TEST_F(OdometryStreamTest, AnAttitudeFilterNeedsNoPosition) {
  for (int i = 0; i < 5; ++i) {
    ExternalOdometry pose = Sample(i);
    pose.translation_m.setConstant(kNan);
    pose.position_sigma_m = ExternalOdometry::kNotMeasured;
    stream_->Add(pose);
  }
  EXPECT_EQ(stream_->counts().accepted, 5U);
  const auto estimate = stream_->At(At(2.5));
  ASSERT_TRUE(estimate.has_value());
  EXPECT_FALSE(estimate->has_position);
  EXPECT_LT(RotationAngle(estimate->T_reference_depth, Pose(2.5)), 1e-7);
}

TEST_F(OdometryStreamTest, MemoryIsBounded) {
  Feed(0, 5000);
  EXPECT_FALSE(stream_->At(At(100)).has_value());
  EXPECT_TRUE(stream_->At(At(4900)).has_value());
}

TEST(ExternalOdometryOptionsTest, WrongValuesNameTheirField) {
  EXPECT_TRUE(Validate(ExternalOdometryOptions()).ok());
  const auto message = [](auto change) {
    ExternalOdometryOptions options;
    change(options);
    const Status status = Validate(options);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    return status.message();
  };
  EXPECT_THAT(message([](auto& o) { o.mutable_t_depth_body()->set_x_m(1); }),
              HasSubstr("T_depth_body"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_max_gap_s(0.0); }),
              HasSubstr("max_gap_s"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_max_speed_m_s(kNan); }),
              HasSubstr("max_speed_m_s"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_max_rotation_deg_s(-1.0); }),
              HasSubstr("max_rotation_deg_s"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_max_ahead_s(-0.1); }),
              HasSubstr("max_ahead_s"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_drift_ratio(1.5); }),
              HasSubstr("drift_ratio"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_max_disagreement_m(0.0); }),
              HasSubstr("max_disagreement_m"));
}

}  // namespace
}  // namespace isotherm
