#include "common/geometry/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

namespace isotherm {
namespace {

constexpr double kRounding = 1e-12;

/// Sigmas 1, 2, 3 mm and 4, 5, 6 mrad along axes that are turned away from x, y, z.
PoseCovariance Rotated() {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance.topLeftCorner<3, 3>() =
      R * Eigen::Vector3d(1e-6, 4e-6, 9e-6).asDiagonal() * R.transpose();
  covariance.bottomRightCorner<3, 3>() =
      R * Eigen::Vector3d(16e-6, 25e-6, 36e-6).asDiagonal() * R.transpose();
  return covariance;
}

TEST(PoseCovarianceTest, LargestSigmaIsAlongTheLeastCertainDirectionWhereverItPoints) {
  const PoseSigma sigma = LargestSigma(Rotated());
  EXPECT_NEAR(sigma.translation_m, 0.003, kRounding);
  EXPECT_NEAR(sigma.rotation_rad, 0.006, kRounding);
}

TEST(PoseCovarianceTest, OfNothingUncertainIsZero) {
  EXPECT_EQ(LargestSigma(PoseCovariance::Zero()).translation_m, 0.0);
  EXPECT_TRUE(IsCovariance(PoseCovariance::Zero()));
}

TEST(PoseCovarianceTest, WhatCannotBeACovarianceIsNone) {
  EXPECT_TRUE(IsCovariance(Rotated()));
  PoseCovariance bad = Rotated();
  bad(2, 2) = -1e-6;
  EXPECT_FALSE(IsCovariance(bad)) << "a negative variance";
  bad = Rotated();
  bad(0, 5) = bad(5, 0) = 2.0 * std::sqrt(bad(0, 0) * bad(5, 5));
  EXPECT_FALSE(IsCovariance(bad)) << "a correlation of 2";
  bad = Rotated();
  bad(0, 1) += 1e-9;
  EXPECT_FALSE(IsCovariance(bad)) << "not symmetric";
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    bad = Rotated();
    bad(3, 3) = value;
    EXPECT_FALSE(IsCovariance(bad)) << value;
  }
}

}  // namespace
}  // namespace isotherm
