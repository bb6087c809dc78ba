#include "ground/renderer/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"
#include "ground/ground_options.pb.h"
#include "ground/renderer/legend.h"
#include "ground/renderer/png.h"

namespace isotherm {
namespace {

constexpr auto kGood = static_cast<std::uint8_t>(ConditionClass::kGood);
constexpr auto kAcceptable = static_cast<std::uint8_t>(ConditionClass::kAcceptable);
constexpr auto kBad = static_cast<std::uint8_t>(ConditionClass::kBad);

/// A view without a surface; tests put pixels in.
ViewMaps EmptyView(int width, int height) {
  ViewMaps view;
  view.Resize(width, height);
  view.celsius.Fill(NAN);
  view.distance_class.Fill(kNeverMeasured);
  view.angle_class.Fill(kNeverMeasured);
  view.cos_view.Fill(NAN);
  view.distance_m.Fill(NAN);
  return view;
}

RendererOptions FixedScale(bool legend) {
  RendererOptions options;
  options.set_scale(FIXED);
  options.set_legend(legend);
  return options;
}

Renderer MakeRenderer(const RendererOptions& options) {
  return Renderer(options, ThermalOptions());
}

TEST(RendererTest, ColourIsThePaletteTimesTheCosine) {
  ViewMaps view = EmptyView(2, 1);
  view.celsius.At(0, 0) = 60.0F;  // Middle of 20..100: (221, 221, 221).
  view.cos_view.At(0, 0) = static_cast<float>(std::cos(std::numbers::pi / 3.0));
  view.celsius.At(1, 0) = 100.0F;
  view.cos_view.At(1, 0) = 1.0F;
  const RgbImage picture = MakeRenderer(FixedScale(false)).Thermal(view);
  EXPECT_EQ(picture.At(0, 0), (Rgb8{111, 111, 111}));  // 221 cos 60 deg = 110.5.
  EXPECT_EQ(picture.At(1, 0), (Rgb8{180, 4, 38}));
}

TEST(RendererTest, WithoutShadingTheAngleDoesNotMatter) {
  ViewMaps view = EmptyView(1, 1);
  view.celsius.At(0, 0) = 20.0F;
  view.cos_view.At(0, 0) = 0.1F;
  RendererOptions options = FixedScale(false);
  options.set_shading(false);
  EXPECT_EQ(MakeRenderer(options).Thermal(view).At(0, 0), (Rgb8{59, 76, 192}));
}

TEST(RendererTest, NeverMeasuredSurfaceLooksLikeNeitherBackgroundNorTemperature) {
  ViewMaps view = EmptyView(20, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 10; x < 20; ++x) view.cos_view.At(x, y) = 0.8F;
  }
  const RgbImage picture = MakeRenderer(FixedScale(false)).Thermal(view);
  std::set<std::tuple<int, int, int>> surface;
  for (int y = 0; y < 20; ++y) {
    EXPECT_EQ(picture.At(0, y), kBackground);
    for (int x = 10; x < 20; ++x) {
      const Rgb8& pixel = picture.At(x, y);
      EXPECT_NE(pixel, kBackground);
      surface.insert({pixel.r, pixel.g, pixel.b});
    }
  }
  EXPECT_EQ(surface.size(), 2U);  // Lines on a ground.
}

TEST(RendererTest, ClassLayersUseTheThesisColours) {
  ViewMaps view = EmptyView(5, 1);
  view.distance_class.At(0, 0) = kGood;
  view.distance_class.At(1, 0) = kAcceptable;
  view.distance_class.At(2, 0) = kBad;
  view.angle_class.At(0, 0) = kBad;
  for (int x = 0; x < 4; ++x) view.cos_view.At(x, 0) = 1.0F;
  const Renderer renderer = MakeRenderer(FixedScale(false));
  const RgbImage distance = renderer.Distance(view);
  EXPECT_EQ(distance.At(0, 0), (Rgb8{0, 255, 0}));
  EXPECT_EQ(distance.At(1, 0), (Rgb8{255, 255, 0}));
  EXPECT_EQ(distance.At(2, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(distance.At(3, 0), (Rgb8{0, 0, 0}));
  EXPECT_EQ(distance.At(4, 0), kBackground);
  EXPECT_EQ(renderer.Angle(view).At(0, 0), (Rgb8{255, 0, 0}));
}

TEST(RendererTest, GeometryIsGreyAndShaded) {
  ViewMaps view = EmptyView(2, 1);
  view.cos_view.At(0, 0) = 0.5F;
  view.cos_view.At(1, 0) = 1.0F;
  const RgbImage picture = MakeRenderer(FixedScale(true)).Geometry(view);
  EXPECT_NEAR(picture.At(1, 0).r, 2 * picture.At(0, 0).r, 1);
  EXPECT_EQ(picture.width(), 2);
}

TEST(RendererTest, LegendShowsTheWholePaletteBesideTheView) {
  ViewMaps view = EmptyView(64, 480);
  view.celsius.At(3, 4) = 60.0F;
  view.cos_view.At(3, 4) = 1.0F;
  const RgbImage picture = MakeRenderer(FixedScale(true)).Thermal(view);
  ASSERT_GT(picture.width(), 64);
  EXPECT_EQ(picture.At(3, 4), (Rgb8{221, 221, 221}));
  bool cold = false, middle = false, hot = false, text = false;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 64; x < picture.width(); ++x) {
      const Rgb8& pixel = picture.At(x, y);
      // The ends of the bar are half a pixel inside the scale.
      cold = cold || (std::abs(pixel.r - 59) <= 1 && std::abs(pixel.b - 192) <= 1);
      middle = middle || (std::abs(pixel.r - 221) <= 1 && std::abs(pixel.b - 221) <= 1);
      hot = hot || (std::abs(pixel.r - 180) <= 1 && std::abs(pixel.b - 38) <= 1);
      text = text || (pixel.r > 225 && pixel.g > 225 && pixel.b > 225);
    }
  }
  EXPECT_TRUE(cold && middle && hot && text);
}

TEST(RendererTest, ScaleIsDerivedFromTheView) {
  ViewMaps view = EmptyView(2, 1);
  view.celsius.At(0, 0) = 20.0F;
  view.celsius.At(1, 0) = 30.0F;
  RendererOptions options;
  options.set_scale(MIN_MAX);
  const auto scale = MakeRenderer(options).ScaleFor(view);
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->min_celsius, 20.0);
  EXPECT_EQ(scale->max_celsius, 30.0);
}

TEST(RendererTest, ViewWithoutSurfaceOrTemperatureIsDrawn) {
  for (const auto& [width, height] : {std::pair(0, 0), std::pair(1, 1), std::pair(160, 120)}) {
    const ViewMaps view = EmptyView(width, height);
    const Renderer renderer = MakeRenderer(RendererOptions());
    EXPECT_GT(renderer.Thermal(view).width(), width);
    EXPECT_GT(renderer.Distance(view).width(), width);
  }
}

TEST(SampleViewTest, ReadsTemperatureClassesAngleAndDistanceFromTheModel) {
  VoxelGrid grid;
  grid.voxel_size_m = 0.004;
  grid.blocks = {4, 4, 4};  // 0.128 m.
  TsdfVolume tsdf(grid, 0.016, 64);
  const Eigen::Vector3d point(0.064, 0.064, 0.064);
  testing::FillPlane(tsdf, point, -Eigen::Vector3d::UnitZ());
  ThermalVolume thermal(64);
  testing::FillThermal(tsdf, thermal, [](const Eigen::Vector3d& p) {
    if (p.y() > 0.064) return ThermalVoxel{};
    return ThermalVoxel::Make(p.x() < 0.064 ? 30.0F : 90.0F, ConditionClass::kGood,
                              ConditionClass::kAcceptable);
  });
  // Three points seen from a viewer 0.5 m in front of the first.
  const Eigen::Vector3d viewer(0.02, 0.02, point.z() - 0.5);
  SurfaceMaps maps;
  maps.Resize(4, 1);
  for (Image<float>* plane : {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz}) {
    plane->Fill(NAN);
  }
  const Eigen::Vector2d positions[] = {{0.02, 0.02}, {0.1, 0.02}, {0.02, 0.1}};
  for (int x = 0; x < 3; ++x) {
    maps.vx.At(x, 0) = static_cast<float>(positions[x].x());
    maps.vy.At(x, 0) = static_cast<float>(positions[x].y());
    maps.vz.At(x, 0) = static_cast<float>(point.z());
    maps.nx.At(x, 0) = maps.ny.At(x, 0) = 0.0F;
    maps.nz.At(x, 0) = -1.0F;
  }
  ThreadPool threads(2);
  ViewMaps view;
  SampleView(maps, viewer, tsdf, thermal, threads, view);
  constexpr float kHalfStep =
      0.0126F;  // Half a temperature step of the voxel, K, and float rounding.
  EXPECT_NEAR(view.celsius.At(0, 0), 30.0F, kHalfStep);
  EXPECT_NEAR(view.celsius.At(1, 0), 90.0F, kHalfStep);
  EXPECT_EQ(view.distance_class.At(0, 0), kGood);
  EXPECT_EQ(view.angle_class.At(0, 0), kAcceptable);
  EXPECT_NEAR(view.cos_view.At(0, 0), 1.0, 1e-6);
  EXPECT_NEAR(view.distance_m.At(0, 0), 0.5, 1e-6);
  const double distance_m = std::hypot(0.5, 0.08);
  EXPECT_NEAR(view.distance_m.At(1, 0), distance_m, 1e-6);
  EXPECT_NEAR(view.cos_view.At(1, 0), 0.5 / distance_m, 1e-6);
  EXPECT_TRUE(std::isnan(view.celsius.At(2, 0)));
  EXPECT_TRUE(view.HasSurface(2, 0));
  EXPECT_EQ(view.angle_class.At(2, 0), kNeverMeasured);
  EXPECT_FALSE(view.HasSurface(3, 0));
}

TEST(RenderThermalFrameTest, ShowsRawCentikelvinInThePalette) {
  Image<std::uint16_t> frame(3, 1);
  frame.At(0, 0) = 29315;  // 20.00 degC.
  frame.At(1, 0) = 33315;  // 60.00 degC.
  frame.At(2, 0) = 0;      // No value.
  const RgbImage picture = RenderThermalFrame(frame, FixedScale(false));
  EXPECT_EQ(picture.At(0, 0), (Rgb8{59, 76, 192}));
  EXPECT_EQ(picture.At(1, 0), (Rgb8{221, 221, 221}));
  EXPECT_EQ(picture.At(2, 0), NeverMeasuredColour(2, 0, 1.0));
}

TEST(EncodePngTest, WritesThePngSignatureAndRefusesAnEmptyPicture) {
  const auto png = EncodePng(RgbImage(4, 3, {10, 20, 30}));
  ASSERT_TRUE(png);
  const std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  ASSERT_GT(png->size(), 8U);
  EXPECT_TRUE(std::equal(std::begin(signature), std::end(signature), png->begin()));
  EXPECT_EQ(EncodePng(RgbImage()).error().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace isotherm
