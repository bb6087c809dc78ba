#include "ground/interpretation/interpretation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "ground/options/ground_options.pb.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kTable_k = 2e-3;  // Twice BandRadiance's interpolation error.

Eigen::AlignedBox3d Box(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m) {
  return {min_m, max_m};
}

class InterpretationTest : public ::testing::Test {
 protected:
  InterpretationTest() {
    options_.set_emissivity(0.85);
    options_.set_reflected_celsius(23.0);
  }

  void AddRegion(const char* name, const Eigen::AlignedBox3d& box, double emissivity,
                 double reflected_celsius) {
    InterpretedRegion& region = *options_.add_region();
    region.set_name(name);
    *region.mutable_box() = ToOptions(box);
    region.set_emissivity(emissivity);
    region.set_reflected_celsius(reflected_celsius);
  }
  Interpretation Make() const {
    Result<Interpretation> interpretation = Interpretation::Create(options_);
    EXPECT_TRUE(interpretation) << interpretation.error().message();
    return std::move(*interpretation);
  }
  std::string Refusal() const {
    const Result<Interpretation> interpretation = Interpretation::Create(options_);
    return interpretation ? "" : interpretation.error().message();
  }
  static Surface SurfaceOf(std::initializer_list<std::pair<float, float>> x_and_celsius) {
    Surface surface;
    for (const auto& [x, celsius] : x_and_celsius) {
      CloudPoint& point = surface.points.emplace_back();
      point.position_m.x() = x;
      point.celsius = celsius;
    }
    return surface;
  }

  InterpretationOptions options_;
};

TEST_F(InterpretationTest, GivesBackTheTemperatureThatLooksLikeThat) {
  const Interpretation interpretation = Make();
  const BandRadiance band;
  for (const double object : {-30.0, 24.0, 100.0, 900.0}) {
    const double apparent = ApparentCelsius(band, object, 0.85, 23.0);
    EXPECT_NEAR(interpretation.ObjectCelsius(0, static_cast<float>(apparent)), object, kTable_k);
  }
  EXPECT_TRUE(std::isnan(interpretation.ObjectCelsius(0, NAN)));
}

TEST_F(InterpretationTest, OtherBandsGiveOtherTemperatures) {
  const float long_wave = Make().ObjectCelsius(0, 200.0F);
  options_.mutable_expert()->set_band_min_um(3.0);
  options_.mutable_expert()->set_band_max_um(5.0);
  const BandRadiance mid_wave({3.0, 5.0});
  const float celsius = Make().ObjectCelsius(0, 200.0F);
  EXPECT_NEAR(ApparentCelsius(mid_wave, celsius, 0.85, 23.0), 200.0, kTable_k);
  EXPECT_GT(std::abs(celsius - long_wave), 1.0);
}

TEST_F(InterpretationTest, LaterRegionsHoldWhereTheyOverlap) {
  AddRegion("left", Box({0, -1, -1}, {2, 1, 1}), 0.5, 30.0);
  AddRegion("right", Box({1, -1, -1}, {3, 1, 1}), 0.3, 40.0);
  AddRegion("apart", Box({4, 4, 4}, {5, 5, 5}), 0.3, 40.0);
  const Interpretation interpretation = Make();
  EXPECT_EQ(interpretation.PartAt({-0.5F, 0, 0}), 0U);
  EXPECT_EQ(interpretation.PartAt({0.5F, 0, 0}), 1U);
  EXPECT_EQ(interpretation.PartAt({1.5F, 0, 0}), 2U);
  EXPECT_EQ(interpretation.PartAt({2.5F, 0, 0}), 2U);
  EXPECT_EQ(interpretation.PartAt({2.5F, 1.5F, 0}), 0U);
  EXPECT_THAT(interpretation.Overlaps(),
              ElementsAre(HasSubstr("'left' and 'right' overlap: 'right', the later one, holds")));
}

TEST_F(InterpretationTest, RegionsTakeWhatTheyDoNotSetFromTheWholeModel) {
  InterpretedRegion& region = *options_.add_region();
  *region.mutable_box() = ToOptions(Box({0, 0, 0}, {1, 1, 1}));
  region.set_emissivity(0.4);
  const Interpretation interpretation = Make();
  EXPECT_EQ(interpretation.parts()[1].reflected_celsius, 23.0);
  EXPECT_EQ(interpretation.parts()[1].name, "region 1");
}

TEST_F(InterpretationTest, PointsKeepWhatWasMeasured) {
  AddRegion("pipe", Box({0, -1, -1}, {1, 1, 1}), 0.5, 25.0);
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{-0.5F, 80.0F}, {0.5F, 80.0F}, {0.6F, NAN}});
  const std::vector<PartReport> reports = interpretation.Apply(surface);
  const BandRadiance band;
  EXPECT_EQ(surface.points[1].apparent_celsius, 80.0F);
  EXPECT_NEAR(surface.points[0].celsius, TrueCelsius(band, 80.0, 0.85, 23.0).value(), kTable_k);
  EXPECT_NEAR(surface.points[1].celsius, TrueCelsius(band, 80.0, 0.5, 25.0).value(), kTable_k);
  EXPECT_TRUE(std::isnan(surface.points[2].celsius));
  EXPECT_EQ(reports[0].points, 1U);
  EXPECT_EQ(reports[1].points, 2U);
  EXPECT_EQ(reports[1].measured, 1U);
  EXPECT_EQ(reports[1].unsolved(), 0U);
  EXPECT_TRUE(interpretation.Errors(reports).empty());
}

TEST_F(InterpretationTest, WhatReflectsMoreThanWasMeasuredIsAnErrorOfItsRegionOnly) {
  AddRegion("mirror", Box({0, -1, -1}, {1, 1, 1}), 0.1, 200.0);
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{-0.5F, 50.0F}, {0.2F, 50.0F}, {0.3F, 60.0F}, {0.4F, 300.0F}});
  const std::vector<PartReport> reports = interpretation.Apply(surface);
  EXPECT_FALSE(std::isnan(surface.points[0].celsius));
  EXPECT_TRUE(std::isnan(surface.points[1].celsius));
  EXPECT_TRUE(std::isnan(surface.points[2].celsius));
  EXPECT_FALSE(std::isnan(surface.points[3].celsius));
  EXPECT_EQ(surface.points[1].apparent_celsius, 50.0F);
  EXPECT_EQ(reports[1].reflects_too_much, 2U);
  EXPECT_THAT(interpretation.Errors(reports),
              ElementsAre(AllOf(HasSubstr("mirror: 2 of 3 measured points (50.0 to 60.0 °C"),
                                HasSubstr("emissivity 0.1 and 200 °C reflected"),
                                HasSubstr("more would be reflected than was measured"))));
}

TEST_F(InterpretationTest, TemperaturesBeyondTheRangeAreSaidToBe) {
  AddRegion("tiny", Box({0, -1, -1}, {1, 1, 1}), 0.05, 20.0);
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{0.5F, 900.0F}});
  const std::vector<PartReport> reports = interpretation.Apply(surface);
  EXPECT_EQ(reports[1].too_hot, 1U);
  EXPECT_THAT(interpretation.Errors(reports), ElementsAre(HasSubstr("hotter than 1500 °C")));
}

TEST_F(InterpretationTest, ARegionWithWrongValuesIsLeftOutAndTheRestGoesOn) {
  AddRegion("wrong", Box({0, -1, -1}, {1, 1, 1}), 1.2, 25.0);
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{-0.5F, 50.0F}, {0.5F, 50.0F}});
  const std::vector<PartReport> reports = interpretation.Apply(surface);
  EXPECT_FALSE(std::isnan(surface.points[0].celsius));
  EXPECT_TRUE(std::isnan(surface.points[1].celsius));
  EXPECT_THAT(interpretation.Errors(reports),
              ElementsAre(AllOf(HasSubstr("interpretation.region 'wrong': emissivity must be"),
                                HasSubstr("got 1.2"), HasSubstr("its 1 measured points"))));
  EXPECT_EQ(Validate(options_).code(), StatusCode::kInvalidArgument);
}

TEST_F(InterpretationTest, WrongValuesForTheWholeModelAreRefusedByName) {
  for (const double wrong : {0.0, -0.1, 1.001, std::nan("")}) {
    options_.set_emissivity(wrong);
    EXPECT_THAT(Refusal(), HasSubstr("interpretation.emissivity must be above 0 and at most 1"));
  }
  options_.set_emissivity(1.0);
  EXPECT_EQ(Refusal(), "");
  options_.set_reflected_celsius(-101.0);
  EXPECT_THAT(Refusal(), HasSubstr("interpretation.reflected_celsius"));
  options_.set_reflected_celsius(23.0);
  options_.mutable_expert()->set_band_max_um(7.0);
  EXPECT_THAT(Refusal(), HasSubstr("interpretation.expert.band_min_um"));
}

TEST_F(InterpretationTest, BoxesThatAreNoneAreRefusedByName) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& wrong :
       {Box({0, 0, 0}, {-1, 1, 1}), Box({0, 0, 0}, {0, 1, 1}), Box({std::nan(""), 0, 0}, {1, 1, 1}),
        Box({0, 0, 0}, {kInfinity, 1, 1})}) {
    options_.clear_region();
    AddRegion("pipe", wrong, 0.5, 25.0);
    EXPECT_THAT(Refusal(), HasSubstr("interpretation.region 'pipe': box must")) << wrong.max();
  }
  options_.mutable_region(0)->clear_box();
  EXPECT_THAT(Refusal(), HasSubstr("interpretation.region 'pipe': box must"));
}

TEST_F(InterpretationTest, EmissivityOneChangesNothing) {
  EXPECT_FALSE(Make().changes_nothing());
  options_.set_emissivity(1.0);
  EXPECT_TRUE(Make().changes_nothing());
  EXPECT_EQ(Make().ObjectCelsius(0, 1530.0F), 1530.0F);  // Beyond the tables.
  AddRegion("pipe", Box({0, 0, 0}, {1, 1, 1}), 0.5, 25.0);
  EXPECT_FALSE(Make().changes_nothing());
}

TEST_F(InterpretationTest, RenderingsShowTheSameAsThePoints) {
  AddRegion("pipe", Box({0, -1, -1}, {1, 1, 1}), 0.5, 25.0);
  const Interpretation interpretation = Make();
  SurfaceMaps maps;
  maps.Resize(2, 1);
  constexpr float kSigma_k = 0.25F;
  ViewMaps view;
  view.Resize(2, 1);
  view.sigma_k = Image<float>(2, 1, kSigma_k);
  view.measured_angle_deg = Image<float>(2, 1, 20.0F);
  for (const int x : {0, 1}) {
    maps.vx.At(x, 0) = x == 0 ? -0.5F : 0.5F;
    maps.vy.At(x, 0) = maps.vz.At(x, 0) = 0.0F;
    view.celsius.At(x, 0) = 80.0F;
  }
  interpretation.Apply(maps, view);
  for (const int x : {0, 1}) {
    const auto part = static_cast<std::size_t>(x);
    EXPECT_EQ(view.celsius.At(x, 0), interpretation.ObjectCelsius(part, 80.0F, 20.0F));
    EXPECT_EQ(view.sigma_k.At(x, 0), interpretation.ObjectSigma(part, 80.0F, kSigma_k, 20.0F));
  }
}

TEST_F(InterpretationTest, StatsSayWhatWasAppliedAndToHowMuch) {
  AddRegion("pipe", Box({0, -1, -1}, {1, 1, 1}), 0.5, 25.0);
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{-0.5F, 80.0F}, {0.5F, 80.0F}});
  const std::string json = JsonText(interpretation.Describe(interpretation.Apply(surface)));
  for (const char* text :
       {"\"whole model\"", "\"pipe\"", "\"emissivity\": 0.85", "\"emissivity\": 0.5",
        "\"measured_points\": 1", "\"without_solution\": 0", "\"box_m\""}) {
    EXPECT_THAT(json, HasSubstr(text));
  }
}

/// Emissivity of a smooth dielectric over that along its normal (Fresnel, unpolarised).
double DielectricRatio(double angle_rad, double n) {
  const auto reflectivity = [n](double angle) {
    const double inside = std::asin(std::sin(angle) / n);
    const double s =
        (std::cos(angle) - n * std::cos(inside)) / (std::cos(angle) + n * std::cos(inside));
    const double p =
        (std::cos(inside) - n * std::cos(angle)) / (std::cos(inside) + n * std::cos(angle));
    return 0.5 * (s * s + p * p);
  };
  return (1.0 - reflectivity(angle_rad)) / (1.0 - reflectivity(0.0));
}

TEST_F(InterpretationTest, AMaterialsEmissivityIsThatAtTheAngleOfTheMeasurement) {
  constexpr double kObject_celsius = 200.0, kPaintIndex = 1.5;
  options_.set_material("paint");
  const Interpretation interpretation = Make();
  const BandRadiance band;
  for (const double angle_deg : {0.0, 30.5, 45.0, 60.0, 70.0}) {
    const double emissivity = 0.85 * DielectricRatio(angle_deg * kRadPerDeg, kPaintIndex);
    const auto apparent =
        static_cast<float>(ApparentCelsius(band, kObject_celsius, emissivity, 23.0));
    constexpr double kTolerance_k = 0.05;  // The table has whole degrees.
    EXPECT_NEAR(interpretation.ObjectCelsius(0, apparent, static_cast<float>(angle_deg)),
                kObject_celsius, kTolerance_k)
        << angle_deg;
    // Without the angle it would be wrong where the angle matters.
    if (angle_deg > 50.0) {
      EXPECT_LT(interpretation.ObjectCelsius(0, apparent), kObject_celsius - 2.0);
    }
  }
}

TEST_F(InterpretationTest, PointsWithoutAnAngleAreCountedAndSaid) {
  options_.set_material("paint");
  const Interpretation interpretation = Make();
  Surface surface = SurfaceOf({{0.0F, 80.0F}, {0.1F, 90.0F}});
  const std::vector<PartReport> reports = interpretation.Apply(surface);
  EXPECT_EQ(reports[0].without_angle, 2U);
  EXPECT_THAT(interpretation.Errors(reports), ElementsAre(HasSubstr("thermal.expert.records")));
}

/// Drawn at random, what is uncertain spreads the temperature as stated.
TEST_F(InterpretationTest, UncertaintiesOfEmissivityAndReflectionAreInThatOfTheTemperature) {
  constexpr double kApparent_celsius = 90.0, kApparentSigma_k = 0.3, kEmissivitySigma = 0.01,
                   kReflectedSigma_k = 4.0;
  constexpr int kDraws = 20'000;
  options_.set_emissivity_sigma(kEmissivitySigma);
  options_.set_reflected_sigma_k(kReflectedSigma_k);
  const float sigma_k = Make().ObjectSigma(0, static_cast<float>(kApparent_celsius),
                                           static_cast<float>(kApparentSigma_k));
  const BandRadiance band;
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const auto drawn = [i](std::uint64_t what) {
      return static_cast<double>(NormalNoise(NoiseStream(1, what, 0), i));
    };
    const double celsius =
        TrueCelsius(band, kApparent_celsius + kApparentSigma_k * drawn(1),
                    0.85 + kEmissivitySigma * drawn(2), 23.0 + kReflectedSigma_k * drawn(3))
            .value();
    sum += celsius;
    squares += celsius * celsius;
  }
  const double spread_k = std::sqrt(squares / kDraws - std::pow(sum / kDraws, 2));
  EXPECT_NEAR(sigma_k, spread_k, 0.03 * spread_k);
  EXPECT_GT(sigma_k, 1.5 * kApparentSigma_k) << "the terms matter here";
  EXPECT_TRUE(std::isnan(Make().ObjectSigma(0, static_cast<float>(kApparent_celsius), NAN)));
}

TEST_F(InterpretationTest, WithoutEmissivityTheUncertaintyStaysThatOfTheMeasurement) {
  options_.set_emissivity(1.0);
  EXPECT_NEAR(Make().ObjectSigma(0, 90.0F, 0.3F), 0.3, 1e-3);
  EXPECT_TRUE(Make().changes_nothing());
}

TEST_F(InterpretationTest, MaterialsAndUncertaintiesThatCannotBeAreRefused) {
  options_.set_material("unobtainium");
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("'unobtainium'"), HasSubstr("isotherm limits --list")));
  options_.set_material("paint");
  options_.clear_emissivity();
  EXPECT_THAT(Refusal(), HasSubstr("along the normal"));
  options_.set_emissivity(0.9);
  EXPECT_EQ(Refusal(), "");
  options_.set_emissivity_sigma(-0.1);
  EXPECT_THAT(Refusal(), HasSubstr("emissivity_sigma"));
  options_.set_emissivity_sigma(0.1);
  options_.set_reflected_sigma_k(NAN);
  EXPECT_THAT(Refusal(), HasSubstr("reflected_sigma_k"));
}

}  // namespace
}  // namespace isotherm
