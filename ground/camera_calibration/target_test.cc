#include "ground/camera_calibration/target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

TEST(TargetTest, SpecificationsGiveTheGridThatOpenCvNumbers) {
  const auto target = ParseTarget("asymmetric-circles 4x9 0.05 hole=0.05 thickness=0.001 bright");
  ASSERT_TRUE(target.has_value()) << target.error().message();
  EXPECT_EQ(target->features(), 36);
  EXPECT_NEAR((target->FeaturePosition(5) - Eigen::Vector2d(0.15, 0.05)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((target->Middle() - Eigen::Vector2d(0.175, 0.2)).norm(), 0.0, 1e-12);
  EXPECT_EQ(target->contrast, CalibrationTarget::Contrast::kBright);
  EXPECT_DOUBLE_EQ(*target->hole_m, 0.05);
}

TEST(TargetTest, ThesisBoardIsTheOneOfTheThesis) {
  const auto target = ParseTarget("thesis-board");
  ASSERT_TRUE(target.has_value());
  EXPECT_EQ(target->columns, 4);
  EXPECT_EQ(target->rows, 9);
  EXPECT_DOUBLE_EQ(target->thickness_m, 0.001);
  EXPECT_EQ(target->spec, "thesis-board");
}

TEST(TargetTest, MirroredNumbersBelongToTheMirrorImage) {
  for (const char* spec :
       {"asymmetric-circles 4x9 0.05", "symmetric-circles 5x4 0.05", "chessboard 7x5 0.03"}) {
    const auto target = ParseTarget(spec);
    ASSERT_TRUE(target.has_value());
    // All distances between features stay what they are, but the sense of rotation changes.
    for (int i = 1; i < target->features(); ++i) {
      const int a = *target->Mirrored(0), b = *target->Mirrored(i);
      EXPECT_NEAR((target->FeaturePosition(i) - target->FeaturePosition(0)).norm(),
                  (target->FeaturePosition(b) - target->FeaturePosition(a)).norm(), 1e-12);
    }
  }
  EXPECT_FALSE(ParseTarget("asymmetric-circles 4x10 0.05")->Mirrored(0).has_value());
}

TEST(TargetTest, WhatIsWrongIsSaidWithAnExample) {
  for (const auto& [spec, said] :
       {std::pair("circles 4x9 0.05", "no pattern 'circles'"),
        std::pair("chessboard 8 0.03", "'8' is no grid"),
        std::pair("chessboard 8x1 0.03", "'8x1' is no grid"),
        std::pair("chessboard 8x6 30mm", "'30mm' is no length"),
        std::pair("chessboard 8x6 0.03 shiny", "'shiny'"),
        std::pair("chessboard 8x6", "three words"),
        std::pair("symmetric-circles 4x5 0.05 hole=0.06", "do not fit")}) {
    const auto target = ParseTarget(spec);
    ASSERT_FALSE(target.has_value()) << spec;
    EXPECT_THAT(target.error().message(), HasSubstr(said));
    EXPECT_THAT(target.error().message(), HasSubstr("asymmetric-circles 4x9 0.05"));
  }
}

TEST(TargetTest, FeaturesOnALineTellNoPose) {
  const CalibrationTarget target = *ParseTarget("symmetric-circles 10x9 0.05");
  const auto every = [](int first, int step, int count) {
    std::vector<int> features;
    for (int i = 0; i < count; ++i) features.push_back(first + step * i);
    return features;
  };
  EXPECT_FALSE(target.TellPose(every(0, 1, 10))) << "a row";
  EXPECT_FALSE(target.TellPose(every(3, 10, 9))) << "a column";
  EXPECT_FALSE(target.TellPose(every(0, 11, 9))) << "the diagonal";
  EXPECT_FALSE(target.TellPose({0, 1, 10, 11}));
  EXPECT_TRUE(target.TellPose(every(0, 1, 20)));
  EXPECT_TRUE(target.TellPose({0, 1, 10, 11, 20, 21, 30, 31}));
}

}  // namespace
}  // namespace isotherm
