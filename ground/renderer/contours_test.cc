#include "ground/renderer/contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"
#include "ground/renderer/renderer.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

constexpr double kWidth_px = 1.5;
// Steps of a voxel's temperature (0.025 K) over the gradients below (0.3 K per pixel and more), and
// the width of a ray's end.
constexpr double kPlace_px = 0.1;

/// A plane at z = 0.12 m with a temperature that rises along it, seen by a small camera.
class ContoursTest : public ::testing::Test {
 protected:
  ContoursTest() : tsdf_(Grid(), 0.016, 512), thermal_(512), pool_(2) {
    testing::FillPlane(tsdf_, {0, 0, kPlane_m}, -Eigen::Vector3d::UnitZ());
    camera_.width = 160;
    camera_.height = 120;
    camera_.fx = camera_.fy = 250.0;
    camera_.cx = 79.5;
    camera_.cy = 59.5;
  }

  static constexpr double kPlane_m = 0.12;
  static VoxelGrid Grid() {
    VoxelGrid grid;
    grid.voxel_size_m = 0.004;
    grid.blocks = {8, 8, 8};  // 0.256 m.
    return grid;
  }

  /// 60 °C in the plane's middle.
  void FillGradient(const Eigen::Vector2d& kelvin_per_m) {
    testing::FillThermal(tsdf_, thermal_, [&](const Eigen::Vector3d& p) {
      const double celsius = 60.0 + kelvin_per_m.dot(p.head<2>() - Eigen::Vector2d(0.128, 0.128));
      return ThermalVoxel::Make(static_cast<float>(celsius), ConditionClass::kGood,
                                ConditionClass::kGood);
    });
  }

  SurfaceMaps Cast(const RigidTransform& T_world_camera) {
    SurfaceMaps maps;
    Raycaster().Cast(tsdf_, camera_, T_world_camera, 1.0F, pool_, maps);
    return maps;
  }

  ContourField Sample(const SurfaceMaps& maps, double smoothing_px) {
    return SampleContours(maps, tsdf_, thermal_, smoothing_px, pool_);
  }

  TsdfVolume tsdf_;
  ThermalVolume thermal_;
  ThreadPool pool_;
  CameraModel camera_;
};

RigidTransform Frontal() {
  return MakeTransform({0.128, 0.128, -0.18}, Eigen::Quaterniond::Identity());
}

/// Turned about y by 40 degrees, looking at the plane's middle.
RigidTransform Oblique() {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(40.0 * kRadPerDeg, Eigen::Vector3d::UnitY()));
  return MakeTransform(Eigen::Vector3d(0.128, 0.128, 0.12) - rotation * Eigen::Vector3d(0, 0, 0.3),
                       rotation);
}

/// Centre of the cover in a row, pixels; NaN without one.
double CentreInRow(const Image<float>& cover, int y) {
  double sum = 0.0, weighted = 0.0;
  for (int x = 0; x < cover.width(); ++x) {
    sum += static_cast<double>(cover.At(x, y));
    weighted += x * static_cast<double>(cover.At(x, y));
  }
  return sum > 0.0 ? weighted / sum : NAN;
}

TEST_F(ContoursTest, LineIsWhereTheGradientSaysToATenthOfAPixel) {
  FillGradient({500.0, 120.0});
  for (const RigidTransform& T_world_camera : {Frontal(), Oblique()}) {
    const ContourField field = Sample(Cast(T_world_camera), 1.5);
    for (const double celsius : {50.0, 60.0, 66.6}) {
      const Image<float> cover = IsothermCover(field, celsius, kWidth_px);
      int rows = 0;
      for (int y = 20; y < 100; ++y) {
        const double centre = CentreInRow(cover, y);
        ASSERT_FALSE(std::isnan(centre)) << celsius << " " << y;
        // The place on the plane that this rendering point shows has the line's temperature.
        const Eigen::Vector3d ray =
            T_world_camera.linear() *
            Eigen::Vector3d((centre - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy, 1.0);
        const Eigen::Vector3d from = T_world_camera.translation();
        const auto celsius_at = [&](const Eigen::Vector3d& direction) {
          const Eigen::Vector3d p = from + (kPlane_m - from.z()) / direction.z() * direction;
          return 60.0 + 500.0 * (p.x() - 0.128) + 120.0 * (p.y() - 0.128);
        };
        const double per_px =
            celsius_at(ray + T_world_camera.linear() * Eigen::Vector3d(1.0 / camera_.fx, 0, 0)) -
            celsius_at(ray);
        EXPECT_LT(std::abs((celsius_at(ray) - celsius) / per_px), kPlace_px) << celsius << " " << y;
        ++rows;
      }
      EXPECT_EQ(rows, 80);
    }
  }
}

TEST_F(ContoursTest, LineHasItsWidthAndSoftEdges) {
  FillGradient({500.0, 0.0});
  const ContourField field = Sample(Cast(Frontal()), 1.5);
  for (const double width_px : {1.0, 1.5, 4.0}) {
    const Image<float> cover = IsothermCover(field, 61.3, width_px);
    constexpr double kWidthError_px = 0.1;  // Steps of temperature make the line waver.
    for (int y = 30; y < 90; ++y) {
      double sum = 0.0;
      for (int x = 0; x < cover.width(); ++x) sum += static_cast<double>(cover.At(x, y));
      EXPECT_NEAR(sum, width_px, kWidthError_px) << y;
    }
  }
}

TEST_F(ContoursTest, SmoothingLeavesAGradientAsItIsUpToTheEdges) {
  FillGradient({500.0, -300.0});
  const SurfaceMaps maps = Cast(Frontal());
  const ContourField rough = Sample(maps, 0.0);
  const ContourField smooth = Sample(maps, 3.0);
  constexpr float kSteps = 0.06F;  // K: steps of the voxels' temperature, averaged out or not.
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (std::isnan(rough.celsius.At(x, y))) continue;
      ASSERT_NEAR(smooth.celsius.At(x, y), rough.celsius.At(x, y), kSteps) << x << " " << y;
    }
  }
}

TEST_F(ContoursTest, NoLineWhereNothingWasMeasuredOrTheTemperatureIsNotReached) {
  const SurfaceMaps maps = Cast(Frontal());
  const auto all = [](const Image<float>& cover) {
    return std::ranges::all_of(cover.pixels(), [](float c) { return c == 0.0F; });
  };
  EXPECT_TRUE(all(IsothermCover(Sample(maps, 1.5), 60.0, kWidth_px)));
  FillGradient({500.0, 0.0});
  EXPECT_TRUE(all(IsothermCover(Sample(maps, 1.5), 300.0, kWidth_px)));
  EXPECT_FALSE(all(IsothermCover(Sample(maps, 1.5), 60.0, kWidth_px)));
}

TEST_F(ContoursTest, NoLineAlongTheEdgeOfAnObjectInFront) {
  // A hot plate 6 cm in front of the cold plane, over its left half.
  VoxelGrid grid = Grid();
  TsdfVolume tsdf(grid, 0.016, 512);
  testing::FillVolume(tsdf, [](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q =
        (p - Eigen::Vector3d(0.05, 0.128, 0.1)).cwiseAbs() - Eigen::Vector3d(0.07, 0.2, 0.03);
    const double plate = q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    return std::min(plate, 0.2 - p.z());
  });
  ThermalVolume thermal(512);
  testing::FillThermal(tsdf, thermal, [](const Eigen::Vector3d& p) {
    return ThermalVoxel::Make(p.z() < 0.15 ? 90.0F : 30.0F, ConditionClass::kGood,
                              ConditionClass::kGood);
  });
  SurfaceMaps maps;
  const RigidTransform T_world_camera =
      MakeTransform({0.1, 0.128, -0.3}, Eigen::Quaterniond::Identity());
  Raycaster().Cast(tsdf, camera_, T_world_camera, 1.0F, pool_, maps);
  const ContourField field = SampleContours(maps, tsdf, thermal, 1.5, pool_);
  // Both are in the rendering.
  EXPECT_NEAR(field.celsius.At(30, 60), 90.0F, 0.1F);
  EXPECT_NEAR(field.celsius.At(150, 60), 30.0F, 0.1F);
  const Image<float> cover = IsothermCover(field, 60.0, kWidth_px);
  EXPECT_TRUE(std::ranges::all_of(cover.pixels(), [](float c) { return c == 0.0F; }));
}

TEST_F(ContoursTest, ImageHasTheLineInItsColour) {
  FillGradient({500.0, 0.0});
  RendererOptions options;
  options.mutable_expert()->set_legend(false);
  options.mutable_expert()->set_shading(false);
  options.set_scale(FIXED);
  ASSERT_TRUE(ParseIsotherms("60#00ff00", options).ok());
  options.mutable_expert()->set_isotherm_width_px(3.0);
  const Renderer renderer(options, ThermalOptions());
  ASSERT_TRUE(renderer.draws_lines());
  const SurfaceMaps maps = Cast(Frontal());
  ViewMaps view;
  SampleView(maps, Frontal().translation(), tsdf_, thermal_, pool_, view);
  const ContourField field = Sample(maps, 1.5);
  const RgbImage rendering = renderer.Thermal(view, renderer.ScaleFor(view), &field);
  const RgbImage without = renderer.Thermal(view, renderer.ScaleFor(view));
  // 60 °C lies between the columns 79 and 80.
  EXPECT_EQ(rendering.At(79, 60), (Rgb8{0, 255, 0}));
  EXPECT_EQ(rendering.At(80, 60), (Rgb8{0, 255, 0}));
  EXPECT_EQ(rendering.At(70, 60), without.At(70, 60));
  // The casing on both sides is darker than the palette.
  EXPECT_LT(rendering.At(77, 60).r, without.At(77, 60).r);
  EXPECT_LT(rendering.At(82, 60).r, without.At(82, 60).r);
}

}  // namespace
}  // namespace isotherm
