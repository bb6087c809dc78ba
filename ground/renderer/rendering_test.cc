// Renderings of ray-cast models against what geometry says that they must show.

#include <gtest/gtest.h>

#include <cmath>

#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"
#include "ground/renderer/legend.h"
#include "ground/renderer/renderer.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr double kCold_celsius = 30.0;
constexpr double kHot_celsius = 90.0;

class RenderingTest : public ::testing::Test {
 protected:
  RenderingTest() : tsdf_(Grid(), 0.016, 512), thermal_(512), pool_(2) {
    camera_.width = 160;
    camera_.height = 120;
    camera_.fx = camera_.fy = 200.0;
    camera_.cx = 79.5;
    camera_.cy = 59.5;
    options_.mutable_expert()->set_legend(false);
    options_.set_scale(FIXED);
    options_.set_scale_min_celsius(kCold_celsius);
    options_.set_scale_max_celsius(kHot_celsius);
  }

  static VoxelGrid Grid() {
    VoxelGrid grid;
    grid.voxel_size_m = 0.004;
    grid.blocks = {8, 8, 8};  // 0.256 m.
    return grid;
  }

  RgbImage Rendering(const RigidTransform& T_world_camera) {
    SurfaceMaps maps;
    Raycaster().Cast(tsdf_, camera_, T_world_camera, 1.0F, pool_, maps);
    ViewMaps view;
    SampleView(maps, T_world_camera.translation(), tsdf_, thermal_, pool_, view);
    const Renderer renderer(options_, ThermalOptions());
    return renderer.Thermal(view);
  }

  /// The line of sight of the pixel's centre, in `world`, not of unit length.
  Eigen::Vector3d Ray(const RigidTransform& T_world_camera, int x, int y) const {
    return T_world_camera.linear() *
           Eigen::Vector3d((x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy, 1.0);
  }

  TsdfVolume tsdf_;
  ThermalVolume thermal_;
  ThreadPool pool_;
  CameraModel camera_;
  RendererOptions options_;
};

TEST_F(RenderingTest, DiscOfKnownTemperatureIsWhereItBelongs) {
  const Eigen::Vector3d centre(0.15, 0.11, 0.12);
  constexpr double kRadius_m = 0.03;
  testing::FillPlane(tsdf_, centre, -Eigen::Vector3d::UnitZ());
  testing::FillThermal(tsdf_, thermal_, [&](const Eigen::Vector3d& p) {
    const bool in_disc = (p - centre).head<2>().norm() < kRadius_m;
    return ThermalVoxel::Make(static_cast<float>(in_disc ? kHot_celsius : kCold_celsius),
                              ConditionClass::kGood, ConditionClass::kGood);
  });
  options_.mutable_expert()->set_shading(false);
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.6, 0.8, 0.0)));
  const RigidTransform T_world_camera = MakeTransform(
      Eigen::Vector3d(0.128, 0.128, 0.12) - rotation * Eigen::Vector3d(0, 0, 0.3), rotation);
  constexpr double kBorder_m = 0.004;  // A voxel: temperatures are the nearest voxel's.
  for (const Palette palette : {COOLWARM, GREY, IRON, RAINBOW, INFERNO}) {
    options_.set_palette(palette);
    const RgbImage rendering = Rendering(T_world_camera);
    int in_disc = 0, beside = 0;
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        if (rendering.At(x, y) == kBackground) continue;
        const Eigen::Vector3d ray = Ray(T_world_camera, x, y);
        const Eigen::Vector3d from = T_world_camera.translation();
        const Eigen::Vector3d p = from + (centre.z() - from.z()) / ray.z() * ray;
        const double distance_m = (p - centre).norm();
        if (std::abs(distance_m - kRadius_m) < kBorder_m) continue;
        const bool hot = distance_m < kRadius_m;
        ++(hot ? in_disc : beside);
        ASSERT_EQ(rendering.At(x, y), PaletteColour(palette, hot ? 1.0 : 0.0))
            << PaletteName(palette) << " " << x << " " << y;
      }
    }
    EXPECT_GT(in_disc, 500);
    EXPECT_GT(beside, 5000);
  }
}

TEST_F(RenderingTest, BrightnessIsTheCosineOfTheAngleToTheViewer) {
  const Eigen::Vector3d centre(0.128, 0.128, 0.128);
  constexpr double kRadius_m = 0.1;
  testing::FillSphere(tsdf_, centre, kRadius_m);
  testing::FillThermal(tsdf_, thermal_, [](const Eigen::Vector3d&) {
    return ThermalVoxel::Make(static_cast<float>(kHot_celsius), ConditionClass::kGood,
                              ConditionClass::kGood);
  });
  const RigidTransform T_world_camera =
      MakeTransform({0.12, 0.13, -0.2}, Eigen::Quaterniond::Identity());
  options_.set_palette(INFERNO);
  const RgbImage rendering = Rendering(T_world_camera);
  const Rgb8 colour = PaletteColour(INFERNO, 1.0);
  constexpr double kBrightness = 0.02;  // Normals of an interpolated, quantised distance field.
  int compared = 0;
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector3d ray = Ray(T_world_camera, x, y).normalized();
      const Eigen::Vector3d to_centre = centre - T_world_camera.translation();
      const double along = to_centre.dot(ray);
      const double half_squared = kRadius_m * kRadius_m - (to_centre.squaredNorm() - along * along);
      if (half_squared <= 0.0) continue;
      const double cosine = std::sqrt(half_squared) / kRadius_m;
      if (cosine < 0.2) continue;  // Too near to the outline to meet it for sure.
      EXPECT_NEAR(rendering.At(x, y).g / 255.0, cosine * colour.g / 255.0, kBrightness)
          << x << " " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 3000);
}

}  // namespace
}  // namespace isotherm
