#include "common/geometry/pose_text.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(ParsePoseTest, ReadsSevenNumbersAndRefusesTheRest) {
  const auto pose = ParsePose(" 0.1 -0.2 3e-1 0 0 0 1 ");
  ASSERT_TRUE(pose.has_value());
  EXPECT_TRUE(pose->translation().isApprox(Eigen::Vector3d(0.1, -0.2, 0.3)));
  for (const char* bad : {"", "1 2 3", "1 2 3 0 0 0 1 9", "1 2 3 0 0 0 0", "a b c d e f g",
                          "1 2 nan 0 0 0 1", "0 0 0 0 0 0 2"}) {
    EXPECT_EQ(ParsePose(bad).error().code(), StatusCode::kInvalidArgument) << bad;
  }
}

}  // namespace
}  // namespace isotherm
