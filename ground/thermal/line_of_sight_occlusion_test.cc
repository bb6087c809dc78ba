#include "ground/thermal/line_of_sight_occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace isotherm {
namespace {

constexpr double kWall_m = 0.60, kScreen_m = 0.45;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A wall, and before its left half a thin screen, as the depth camera sees them; the thermal
/// camera sits 6 cm to the left.
class LineOfSightOcclusionTest : public ::testing::Test {
 protected:
  LineOfSightOcclusionTest() {
    depth_camera_ = CameraModel{320, 240, 290.0, 290.0, 159.5, 119.5};
    thermal_camera_ = CameraModel{160, 120, 150.0, 150.0, 79.5, 59.5};
    SetModel([](double x) { return x < 0.0 ? kScreen_m : kWall_m; });
  }
  /// `z_of(x)`: depth that the depth camera sees along its normalised x.
  template <typename Depth>
  void SetModel(const Depth& z_of) {
    model_.Resize(320, 240);
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const double x = (u - depth_camera_.cx) / depth_camera_.fx;
        const auto z = static_cast<float>(z_of(x));
        const Eigen::Vector3d p_depth(x * z, (v - depth_camera_.cy) / depth_camera_.fy * z, z);
        const Eigen::Vector3f p = (T_map_depth_ * p_depth).cast<float>();
        model_.vx.At(u, v) = p.x();
        model_.vy.At(u, v) = p.y();
        model_.vz.At(u, v) = p.z();
      }
    }
  }
  /// How much is left out of a thermal image that shows surface at `depth_m` everywhere.
  std::int64_t LeaveOut(double depth_m) {
    ThermalPixel pixel{};
    pixel.depth_m = static_cast<float>(depth_m);
    pixel.flags = ThermalPixel::kSeen | ThermalPixel::kAssignable;
    image_.assign(160 * 120, pixel);
    LineOfSightOcclusion lines(options_, sensor_, thermal_camera_);
    lines.Update(model_, depth_camera_, T_map_depth_);
    lines.Aim(T_depth_thermal_);
    std::int64_t count = 0;
    for (int y = 0; y < 120; y += 8)
      count +=
          lines.LeaveOut(y, std::span(image_).subspan(160 * static_cast<std::size_t>(y), 160 * 8));
    return count;
  }
  bool IsLeftOut(int u, int v) const {
    const ThermalPixel& pixel = image_[static_cast<std::size_t>(160 * v + u)];
    EXPECT_NE(pixel.flags & ThermalPixel::kSeen, 0);
    return (pixel.flags & ThermalPixel::kAssignable) == 0;
  }

  static constexpr double kBeside_m = 0.06;
  const ThermalOcclusionOptions options_;
  DepthSensorModel sensor_;
  CameraModel depth_camera_, thermal_camera_;
  RigidTransform T_depth_thermal_ =
      MakeTransform({-kBeside_m, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  RigidTransform T_map_depth_ = MakeTransform(
      {0.3, -0.2, 0.1},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized())));
  SurfaceMaps model_;
  std::vector<ThermalPixel> image_;
};

/// A line of sight to the wall is proven unless one of its points more than the tolerance behind
/// the screen lies at x < 0, where the screen hides it from the depth camera.
TEST_F(LineOfSightOcclusionTest, WhatPassesBehindSomethingIsLeftOut) {
  EXPECT_GT(LeaveOut(kWall_m), 1000);
  int proven = 0, hidden = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const double slope = (u - thermal_camera_.cx) / thermal_camera_.fx;
      const auto x_at = [&](double z) { return slope * z - kBeside_m; };
      const double behind = kScreen_m + options_.parallax_tolerance_m();
      const double leftmost =
          std::min(x_at(behind), x_at(kWall_m - options_.parallax_tolerance_m()));
      // Four pixels share a line, and points on it are 3 cm apart.
      constexpr double kUncertain_m = 0.015;
      if (std::abs(leftmost) < kUncertain_m) continue;
      ASSERT_EQ(IsLeftOut(u, v), leftmost < 0.0) << u << " " << v;
      ++(leftmost < 0.0 ? hidden : proven);
    }
  }
  EXPECT_GT(proven, 3000);
  EXPECT_GT(hidden, 3000);
}

/// As after a sweep: the thermal camera was where the depth camera is now.
TEST_F(LineOfSightOcclusionTest, TheCameraIsWhereItWasWhenTheFrameWasCaptured) {
  T_depth_thermal_ = RigidTransform::Identity();
  EXPECT_GT(LeaveOut(kWall_m), 0) << "behind the screen itself";
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      if (std::abs(u - thermal_camera_.cx) < 6.0) continue;  // A tile and a half.
      ASSERT_EQ(IsLeftOut(u, v), u < thermal_camera_.cx) << u << " " << v;
    }
  }
}

TEST_F(LineOfSightOcclusionTest, WhatIsSeenFirstIsNeverLeftOut) {
  EXPECT_EQ(LeaveOut(kScreen_m), 0);
  SetModel([](double) { return kWall_m; });
  EXPECT_EQ(LeaveOut(kWall_m), 0);
}

TEST_F(LineOfSightOcclusionTest, WhatReachesTheImagesBorderGoesOnBeyondIt) {
  // Only the leftmost twenty columns show the screen.
  SetModel([](double x) { return x < -0.48 ? kScreen_m : kWall_m; });
  EXPECT_GT(LeaveOut(kWall_m), 0);
  // At the screen's depth this line of sight is 0.59 to the left, and the image ends at 0.55.
  EXPECT_TRUE(IsLeftOut(12, 60));
  EXPECT_FALSE(IsLeftOut(80, 60));
}

TEST_F(LineOfSightOcclusionTest, WhereTheDepthCameraSeesNothingNothingIsInTheWay) {
  SetModel([](double) { return kNan; });
  EXPECT_EQ(LeaveOut(kWall_m), 0);
}

TEST_F(LineOfSightOcclusionTest, ANearRangeOfZeroTurnsItOff) {
  sensor_.near_range_m = 0.0;
  EXPECT_EQ(LeaveOut(kWall_m), 0);
}

}  // namespace
}  // namespace isotherm
