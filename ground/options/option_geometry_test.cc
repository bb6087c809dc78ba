#include "ground/options/option_geometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

PoseOptions APose() {
  PoseOptions pose;
  pose.set_x_m(0.1);
  pose.set_y_m(-0.2);
  pose.set_z_m(0.3);
  pose.set_qx(0.0);
  pose.set_qy(0.6);
  pose.set_qz(0.0);
  pose.set_qw(0.8);
  return pose;
}

BoxOptions ABox() {
  return ToOptions(Eigen::AlignedBox3d(Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(3, 4, 5)));
}

TEST(OptionGeometryTest, APoseMapsAPointAsItsNumbersSay) {
  const Result<RigidTransform> pose = ToTransform(APose());
  ASSERT_TRUE(pose) << pose.error().message();
  // Turned about y by 2 atan2(0.6, 0.8): x becomes (0.28, 0, -0.96).
  EXPECT_TRUE((*pose * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0.38, -0.2, -0.66)));
}

TEST(OptionGeometryTest, APoseComesBackAsItWas) {
  const RigidTransform pose = ToTransform(APose()).value();
  EXPECT_TRUE(ToTransform(ToOptions(pose))->isApprox(pose, 1e-12));
}

TEST(OptionGeometryTest, WhatIsNoPoseIsRefused) {
  PoseOptions missing = APose();
  missing.clear_qw();
  EXPECT_THAT(ToTransform(missing).error().message(), HasSubstr("qw"));
  PoseOptions stretched = APose();
  stretched.set_qw(0.9);
  EXPECT_THAT(ToTransform(stretched).error().message(), HasSubstr("instead of 1"));
  PoseOptions endless = APose();
  endless.set_y_m(std::numeric_limits<double>::infinity());
  EXPECT_THAT(ToTransform(endless).error().message(), HasSubstr("finite"));
}

TEST(OptionGeometryTest, ABoxHasItsCorners) {
  const Result<Eigen::AlignedBox3d> box = ToBox(ABox());
  ASSERT_TRUE(box) << box.error().message();
  EXPECT_EQ(box->min(), Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(box->max(), Eigen::Vector3d(3, 4, 5));
}

TEST(OptionGeometryTest, WhatIsNoBoxIsRefused) {
  EXPECT_FALSE(ToBox(BoxOptions()));
  BoxOptions missing = ABox();
  missing.mutable_max()->clear_z_m();
  EXPECT_FALSE(ToBox(missing));
  BoxOptions flat = ABox();
  flat.mutable_max()->set_y_m(1);
  EXPECT_FALSE(ToBox(flat));
  BoxOptions endless = ABox();
  endless.mutable_max()->set_x_m(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(ToBox(endless));
}

}  // namespace
}  // namespace isotherm
