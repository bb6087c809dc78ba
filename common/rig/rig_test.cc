#include "common/rig/rig.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

CameraModel SomeCamera() {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = 371.4;
  camera.fy = 372.1;
  camera.cx = 205.5;
  camera.cy = 150.5;
  return camera;
}

TEST(RigTest, F57NeedsACameraAndADepthScale) {
  Rig rig;
  EXPECT_FALSE(Validate(rig).ok());
  rig.thermal = SomeCamera();
  EXPECT_TRUE(Validate(rig).ok());
  rig.depth_scale = 0.0;
  EXPECT_FALSE(Validate(rig).ok());
}

TEST(RigTest, F56MissingCalibrationRefusesThermalFusionOnly) {
  Rig rig;
  rig.depth = SomeCamera();
  EXPECT_TRUE(Validate(rig).ok());
  EXPECT_EQ(CheckThermalFusion(rig).code(), StatusCode::kFailedPrecondition);
  rig.thermal = SomeCamera();
  EXPECT_EQ(CheckThermalFusion(rig).code(), StatusCode::kFailedPrecondition);
  rig.T_thermal_depth = RigidTransform::Identity();
  EXPECT_TRUE(CheckThermalFusion(rig).ok());
}

}  // namespace
}  // namespace isotherm
