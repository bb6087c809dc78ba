#include "ground/renderer/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "common/concurrency/thread_pool.h"
#include "common/testing/volume_shapes.h"
#include "ground/options/ground_options.pb.h"
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
  view.motion_class.Fill(kNeverMeasured);
  view.disagreement_class.Fill(kNeverMeasured);
  view.cos_view.Fill(NAN);
  view.distance_m.Fill(NAN);
  return view;
}

RendererOptions FixedScale(bool legend) {
  RendererOptions options;
  options.set_scale(FIXED);
  options.mutable_expert()->set_legend(legend);
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
  const RgbImage rendering = MakeRenderer(FixedScale(false)).Thermal(view);
  EXPECT_EQ(rendering.At(0, 0), (Rgb8{111, 111, 111}));  // 221 cos 60 deg = 110.5.
  EXPECT_EQ(rendering.At(1, 0), (Rgb8{180, 4, 38}));
}

TEST(RendererTest, WithoutShadingTheAngleDoesNotMatter) {
  ViewMaps view = EmptyView(1, 1);
  view.celsius.At(0, 0) = 20.0F;
  view.cos_view.At(0, 0) = 0.1F;
  RendererOptions options = FixedScale(false);
  options.mutable_expert()->set_shading(false);
  EXPECT_EQ(MakeRenderer(options).Thermal(view).At(0, 0), (Rgb8{59, 76, 192}));
}

TEST(RendererTest, NeverMeasuredSurfaceLooksLikeNeitherBackgroundNorTemperature) {
  ViewMaps view = EmptyView(20, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 10; x < 20; ++x) view.cos_view.At(x, y) = 0.8F;
  }
  const RgbImage rendering = MakeRenderer(FixedScale(false)).Thermal(view);
  std::set<std::tuple<int, int, int>> surface;
  for (int y = 0; y < 20; ++y) {
    EXPECT_EQ(rendering.At(0, y), kBackground);
    for (int x = 10; x < 20; ++x) {
      const Rgb8& pixel = rendering.At(x, y);
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

TEST(RendererTest, MotionAndDisagreementTellUncheckedFromNeverMeasured) {
  ViewMaps view = EmptyView(5, 1);
  const std::uint8_t classes[] = {kGood, kAcceptable, kBad, kNeverMeasured, kNeverMeasured};
  for (int x = 0; x < 5; ++x) {
    view.cos_view.At(x, 0) = 1.0F;
    view.celsius.At(x, 0) = x == 4 ? NAN : 40.0F;
    view.motion_class.At(x, 0) = classes[x];
    view.disagreement_class.At(x, 0) = classes[4 - x];
  }
  const Renderer renderer = MakeRenderer(FixedScale(false));
  const RgbImage motion = renderer.Motion(view);
  EXPECT_EQ(motion.At(0, 0), (Rgb8{0, 255, 0}));
  EXPECT_EQ(motion.At(1, 0), (Rgb8{255, 255, 0}));
  EXPECT_EQ(motion.At(2, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(motion.At(3, 0), (Rgb8{96, 84, 128}));
  EXPECT_EQ(motion.At(4, 0), (Rgb8{0, 0, 0}));
  const RgbImage disagreement = renderer.Disagreement(view);
  EXPECT_EQ(disagreement.At(0, 0), (Rgb8{96, 84, 128}));
  EXPECT_EQ(disagreement.At(2, 0), (Rgb8{255, 0, 0}));
  EXPECT_EQ(disagreement.At(3, 0), (Rgb8{255, 255, 0}));
}

TEST(RendererTest, SmearMakesAMeasurementWorse) {
  ViewMaps view = EmptyView(1, 1);
  view.cos_view.At(0, 0) = 1.0F;
  view.distance_class.At(0, 0) = view.angle_class.At(0, 0) = kGood;
  EXPECT_EQ(QualityAt(view, 0, 0), MeasurementQuality::kGood);
  view.motion_class.At(0, 0) = kAcceptable;
  EXPECT_EQ(QualityAt(view, 0, 0), MeasurementQuality::kAcceptable);
  view.motion_class.At(0, 0) = kBad;
  EXPECT_EQ(QualityAt(view, 0, 0), MeasurementQuality::kBad);
}

TEST(RendererTest, CoverageShowsWhatIsMissing) {
  ViewMaps view = EmptyView(6, 1);
  const std::uint8_t classes[][2] = {{kGood, kGood},
                                     {kGood, kAcceptable},
                                     {kGood, kBad},
                                     {kAcceptable, kAcceptable},
                                     {kNeverMeasured, kNeverMeasured}};
  for (int x = 0; x < 5; ++x) {
    view.distance_class.At(x, 0) = classes[x][0];
    view.angle_class.At(x, 0) = classes[x][1];
    view.cos_view.At(x, 0) = 1.0F;
  }
  EXPECT_EQ(QualityAt(view, 0, 0), MeasurementQuality::kGood);
  EXPECT_EQ(QualityAt(view, 1, 0), MeasurementQuality::kAcceptable);
  EXPECT_EQ(QualityAt(view, 2, 0), MeasurementQuality::kBad);
  EXPECT_EQ(QualityAt(view, 3, 0), MeasurementQuality::kAcceptable);
  EXPECT_EQ(QualityAt(view, 4, 0), MeasurementQuality::kNever);
  const RgbImage rendering = MakeRenderer(FixedScale(false)).Coverage(view);
  EXPECT_EQ(rendering.At(2, 0), (Rgb8{255, 150, 0}));
  EXPECT_EQ(rendering.At(4, 0), (Rgb8{255, 0, 200}));
  EXPECT_EQ(rendering.At(1, 0), rendering.At(3, 0));
  EXPECT_EQ(rendering.At(5, 0), kBackground);
  for (const int x : {0, 1}) {  // Recedes: no hue to speak of.
    EXPECT_LE(rendering.At(x, 0).b - rendering.At(x, 0).r, 30);
  }
}

TEST(RendererTest, AgeGoesFromLightToDark) {
  ViewMaps view = EmptyView(5, 1);
  view.nuc_age_s = Image<float>(5, 1, NAN);
  const float ages_s[] = {0.0F, 60.0F, 120.0F, NAN, NAN};
  for (int x = 0; x < 5; ++x) {
    view.cos_view.At(x, 0) = 1.0F;
    view.celsius.At(x, 0) = x == 4 ? NAN : 40.0F;
    view.nuc_age_s.At(x, 0) = ages_s[x];
  }
  const RgbImage rendering = MakeRenderer(FixedScale(false)).NucAge(view);
  EXPECT_EQ(rendering.At(0, 0), InfernoColour(1.0));
  EXPECT_EQ(rendering.At(1, 0), InfernoColour(0.5));
  EXPECT_EQ(rendering.At(2, 0), InfernoColour(0.0));
  EXPECT_EQ(rendering.At(3, 0), (Rgb8{96, 84, 128}));
  EXPECT_EQ(rendering.At(4, 0), NeverMeasuredColour(4, 0, 1.0));
  EXPECT_GT(MakeRenderer(FixedScale(true)).NucAge(view).width(), 5);
}

TEST(RendererTest, UncertaintyGoesFromLightToDarkUpToWhatNearlyAllHave) {
  ViewMaps view = EmptyView(23, 1);
  view.sigma_k = Image<float>(23, 1, NAN);
  for (int x = 0; x < 23; ++x) {
    view.cos_view.At(x, 0) = 1.0F;
    view.celsius.At(x, 0) = x == 22 ? NAN : 40.0F;
    if (x < 20) view.sigma_k.At(x, 0) = 0.2F;
  }
  view.sigma_k.At(0, 0) = 0.1F;
  view.sigma_k.At(20, 0) = 5.0F;  // One of 21: beyond the scale.
  const RgbImage rendering = MakeRenderer(FixedScale(false)).Uncertainty(view);
  EXPECT_EQ(rendering.At(0, 0), InfernoColour(0.5));
  EXPECT_EQ(rendering.At(1, 0), InfernoColour(0.0));
  EXPECT_EQ(rendering.At(20, 0), InfernoColour(0.0));
  EXPECT_EQ(rendering.At(21, 0), (Rgb8{96, 84, 128}));
  EXPECT_EQ(rendering.At(22, 0), NeverMeasuredColour(22, 0, 1.0));
  EXPECT_GT(MakeRenderer(FixedScale(true)).Uncertainty(view).width(), 23);
}

TEST(RendererTest, EveryLayerCanBeDrawnByItsName) {
  ViewMaps view = EmptyView(8, 8);
  view.nuc_age_s = view.sigma_k = Image<float>(8, 8, NAN);
  view.cos_view.At(4, 4) = 1.0F;
  const Renderer renderer = MakeRenderer(FixedScale(false));
  std::set<std::string_view> names;
  for (const RenderLayer layer : AllLayers()) {
    names.insert(LayerName(layer));
    EXPECT_EQ(LayerFromName(LayerName(layer)), layer);
    const RgbImage rendering = renderer.Draw(layer, view, std::nullopt);
    EXPECT_NE(rendering.At(4, 4), kBackground) << LayerName(layer);
  }
  EXPECT_EQ(names.size(), AllLayers().size());
  EXPECT_FALSE(LayerFromName("heat"));
}

TEST(RendererTest, BandsPaintOrTakeColourFromTheRest) {
  ViewMaps view = EmptyView(4, 1);
  const float celsius[] = {30.0F, 60.0F, 80.0F, 99.0F};
  for (int x = 0; x < 4; ++x) {
    view.celsius.At(x, 0) = celsius[x];
    view.cos_view.At(x, 0) = 1.0F;
  }
  RendererOptions options = FixedScale(false);
  const RgbImage plain = MakeRenderer(options).Thermal(view);
  ASSERT_TRUE(ParseBands("75..85#12ab34", options).ok());
  const RgbImage painted = MakeRenderer(options).Thermal(view);
  EXPECT_EQ(painted.At(2, 0), (Rgb8{0x12, 0xab, 0x34}));
  for (const int x : {0, 1, 3}) EXPECT_EQ(painted.At(x, 0), plain.At(x, 0));
  ASSERT_TRUE(ParseBands("75..85#12ab34, 90..", options).ok());
  const RgbImage highlighted = MakeRenderer(options).Thermal(view);
  EXPECT_EQ(highlighted.At(2, 0), (Rgb8{0x12, 0xab, 0x34}));
  EXPECT_EQ(highlighted.At(3, 0), plain.At(3, 0));
  const Rgb8 grey = highlighted.At(0, 0);
  EXPECT_TRUE(grey.r == grey.g && grey.g == grey.b);
  EXPECT_NE(plain.At(0, 0).r, plain.At(0, 0).b);
}

/// Counts the pixels to the right of column `left` that differ in two renderings.
std::size_t DifferingPixels(const RgbImage& a, const RgbImage& b, int left) {
  std::size_t count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = left; x < a.width(); ++x) count += a.At(x, y) == b.At(x, y) ? 0 : 1;
  }
  return count;
}

TEST(RendererTest, UnitChangesTheLegendOnly) {
  ViewMaps view = EmptyView(64, 480);
  view.celsius.At(3, 4) = 60.0F;
  view.cos_view.At(3, 4) = 1.0F;
  RendererOptions options = FixedScale(true);
  const RgbImage celsius = MakeRenderer(options).Thermal(view);
  for (const TemperatureUnit unit : {FAHRENHEIT, KELVIN}) {
    options.set_unit(unit);
    const RgbImage other = MakeRenderer(options).Thermal(view);
    ASSERT_EQ(other.width(), celsius.width());
    EXPECT_EQ(other.At(3, 4), celsius.At(3, 4));
    EXPECT_GT(DifferingPixels(celsius, other, 64), 50U);
  }
}

TEST(RendererTest, ShadedGreyWarnsInTheLegend) {
  const ViewMaps view = EmptyView(64, 480);
  RendererOptions options = FixedScale(true);
  options.set_palette(GREY);
  const RgbImage shaded = MakeRenderer(options).Thermal(view);
  options.mutable_expert()->set_shading(false);
  const RgbImage flat = MakeRenderer(options).Thermal(view);
  EXPECT_GT(DifferingPixels(shaded, flat, 64), 50U);
}

TEST(RendererTest, GeometryIsGreyAndShaded) {
  ViewMaps view = EmptyView(2, 1);
  view.cos_view.At(0, 0) = 0.5F;
  view.cos_view.At(1, 0) = 1.0F;
  const RgbImage rendering = MakeRenderer(FixedScale(true)).Geometry(view);
  EXPECT_NEAR(rendering.At(1, 0).r, 2 * rendering.At(0, 0).r, 1);
  EXPECT_EQ(rendering.width(), 2);
}

TEST(RendererTest, LegendShowsTheWholePaletteBesideTheView) {
  ViewMaps view = EmptyView(64, 480);
  view.celsius.At(3, 4) = 60.0F;
  view.cos_view.At(3, 4) = 1.0F;
  const RgbImage rendering = MakeRenderer(FixedScale(true)).Thermal(view);
  ASSERT_GT(rendering.width(), 64);
  EXPECT_EQ(rendering.At(3, 4), (Rgb8{221, 221, 221}));
  bool cold = false, middle = false, hot = false, text = false;
  for (int y = 0; y < rendering.height(); ++y) {
    for (int x = 64; x < rendering.width(); ++x) {
      const Rgb8& pixel = rendering.At(x, y);
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
                              ConditionClass::kAcceptable, ConditionClass::kGood,
                              ConditionClass::kBad);
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
  EXPECT_EQ(view.motion_class.At(0, 0), kGood);
  EXPECT_EQ(view.disagreement_class.At(0, 0), kBad);
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

TEST(EncodePngTest, WritesThePngSignatureAndRefusesAnEmptyRendering) {
  const auto png = EncodePng(RgbImage(4, 3, {10, 20, 30}));
  ASSERT_TRUE(png);
  const std::uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  ASSERT_GT(png->size(), 8U);
  EXPECT_TRUE(std::equal(std::begin(signature), std::end(signature), png->begin()));
  EXPECT_EQ(EncodePng(RgbImage()).error().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace isotherm
