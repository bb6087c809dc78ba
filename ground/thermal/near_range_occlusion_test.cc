#include "ground/thermal/near_range_occlusion.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace isotherm {
namespace {

/// A wall that fills both views, 0.6 m away; the thermal camera sits beside the depth camera.
class NearRangeOcclusionTest : public ::testing::Test {
 protected:
  NearRangeOcclusionTest() {
    depth_camera_ = CameraModel{320, 240, 290.0, 290.0, 159.5, 119.5};
    thermal_camera_ = CameraModel{160, 120, 150.0, 150.0, 79.5, 59.5};
    depth_m_ = Image<float>(320, 240, 0.6F);
    model_.Resize(320, 240);
    model_.vx.Fill(0.0F);
  }
  /// Pixels that are left out of the whole thermal image.
  std::int64_t LeftOut() {
    NearRangeOcclusion occlusion(ThermalOcclusionOptions(), sensor_, thermal_camera_);
    occlusion.Update(depth_m_, model_, depth_camera_);
    occlusion.Aim(T_thermal_depth_.inverse());
    std::int64_t count = 0;
    image_.assign(static_cast<std::size_t>(160 * 120), ThermalPixel{});
    for (int y = 0; y < 120; ++y) {
      const std::span<ThermalPixel> row(image_.data() + 160 * y, 160);
      for (ThermalPixel& pixel : row) pixel.flags = ThermalPixel::kAssignable;
      count += occlusion.LeaveOut(y, row);
    }
    return count;
  }
  bool IsLeftOut(int x, int y) const {
    return (image_[static_cast<std::size_t>(160 * y + x)].flags & ThermalPixel::kAssignable) == 0;
  }
  void MakeHole(int x0, int y0, int side) {
    for (int y = y0; y < y0 + side; ++y) {
      for (int x = x0; x < x0 + side; ++x) depth_m_.At(x, y) = 0.0F;
    }
  }

  DepthSensorModel sensor_;
  CameraModel depth_camera_, thermal_camera_;
  RigidTransform T_thermal_depth_ =
      MakeTransform({-0.05, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  Image<float> depth_m_;
  SurfaceMaps model_;
  std::vector<ThermalPixel> image_;
};

TEST_F(NearRangeOcclusionTest, ALensCapBeforePartOfTheDepthCameraLeavesOutWhatItMayHide) {
  // A hand 0.15 to 0.3 m away, in the middle of the depth camera's view.
  MakeHole(120, 80, 80);
  EXPECT_GT(LeftOut(), 500);
  // Something 0.2 m before the depth camera is seen 0.05 m / 0.2 m further left by the thermal one.
  EXPECT_TRUE(IsLeftOut(80 - 37, 60));
  EXPECT_FALSE(IsLeftOut(150, 60)) << "no line of sight there crosses the hole's near space";
  EXPECT_FALSE(IsLeftOut(60, 5)) << "beside the hole's rows";
}

TEST_F(NearRangeOcclusionTest, SmallHolesAndEdgesCostNothing) {
  for (int i = 0; i < 12; ++i) MakeHole(20 + 24 * i, 100, 10);
  for (int y = 0; y < 240; ++y) {
    for (int x = 200; x < 206; ++x) depth_m_.At(x, y) = 0.0F;  // The shadow at an edge.
  }
  EXPECT_EQ(LeftOut(), 0);
}

TEST_F(NearRangeOcclusionTest, WhatIsNearBeforeAPlaceNeverScannedIsNoticedBetweenSurfaces) {
  // A pipe close to the camera, from the upper border to the lower.
  for (int y = 0; y < 240; ++y) {
    for (int x = 140; x < 190; ++x) {
      depth_m_.At(x, y) = 0.0F;
      model_.vx.At(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  EXPECT_GT(LeftOut(), 500);
  EXPECT_TRUE(IsLeftOut(80 - 37, 60));
  EXPECT_FALSE(IsLeftOut(150, 60));
}

TEST_F(NearRangeOcclusionTest, AShadowBesideSomethingNearCostsNothing) {
  // A post 0.4 m away; the projector 7.5 cm beside cannot light 18 pixels of the wall next to it.
  for (int y = 0; y < 240; ++y) {
    for (int x = 100; x < 160; ++x) depth_m_.At(x, y) = 0.4F;
    for (int x = 160; x < 178; ++x) depth_m_.At(x, y) = 0.0F;
  }
  EXPECT_EQ(LeftOut(), 0);
  for (int y = 0; y < 240; ++y) {
    for (int x = 178; x < 280; ++x) depth_m_.At(x, y) = 0.0F;  // No shadow is so wide.
  }
  EXPECT_GT(LeftOut(), 500);
}

TEST_F(NearRangeOcclusionTest, OpenSpaceBesideTheSurfaceCostsNothing) {
  for (int y = 0; y < 240; ++y) {
    for (int x = 160; x < 320; ++x) {
      depth_m_.At(x, y) = 0.0F;
      model_.vx.At(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  EXPECT_EQ(LeftOut(), 0);
}

TEST_F(NearRangeOcclusionTest, WhereNoSurfaceIsKnownThereIsNothingToMiss) {
  depth_m_.Fill(0.0F);
  model_.vx.Fill(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(LeftOut(), 0);
}

TEST_F(NearRangeOcclusionTest, ANearRangeOfZeroTurnsItOff) {
  depth_m_.Fill(0.0F);
  EXPECT_GT(LeftOut(), 10'000);
  sensor_.near_range_m = 0.0;
  EXPECT_EQ(LeftOut(), 0);
}

}  // namespace
}  // namespace isotherm
