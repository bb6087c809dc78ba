#include "ground/cli/limits_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/base/units.h"
#include "common/options/override.h"
#include "common/options/text_proto.h"
#include "common/radiometry/materials.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

LimitOptions SomeLimits() {
  LimitOptions limits;
  limits.angle = AngleLimits{15.41 * kRadPerDeg, 41.29 * kRadPerDeg, 55.0 * kRadPerDeg};
  limits.distance_min_m = 0.4452;
  limits.distance_good_m = 0.5339;
  limits.distance_max_m = 0.57;
  return limits;
}

TEST(LimitsReportTest, SnippetIsAConfigurationThatValidates) {
  const std::string text = DescribeOptions(SomeLimits());
  GroundOptions options;
  const Status parsed = ParseTextProto(text.substr(text.find("thermal {")), "limits", options);
  ASSERT_TRUE(parsed.ok()) << parsed.message();
  EXPECT_TRUE(Validate(options.thermal()).ok());
  // Cut to the safe side.
  EXPECT_EQ(options.thermal().angle().min_deg(), 15.5);
  EXPECT_EQ(options.thermal().angle().good_deg(), 41.2);
  EXPECT_EQ(options.thermal().angle().max_deg(), 55.0);
  EXPECT_EQ(options.thermal().distance().min_m(), 0.446);
  EXPECT_EQ(options.thermal().distance().good_m(), 0.533);
  EXPECT_EQ(options.thermal().distance().max_m(), 0.57);
}

TEST(LimitsReportTest, AMaterialSetsWhatIsReportedOfIt) {
  constexpr ErrorTolerance kGood{kGoodFraction * kDefaultTolerance.value, false};
  for (const OpticalMaterial& material : OpticalMaterials()) {
    const EmissionCurve curve(material.index, SpectralBand{}, EmissionConditions{});
    LimitOptions limits;
    limits.angle = curve.Limits(kGood, kDefaultTolerance).value();
    const std::string text = DescribeOptions(limits);
    GroundOptions reported, set;
    ASSERT_TRUE(ParseTextProto(text.substr(text.find("thermal {")), "limits", reported).ok());
    set.mutable_thermal()->set_material(std::string(material.name));
    const ThermalAngleOptions angle = WithAnglesOfMaterial(set.thermal()).angle();
    EXPECT_EQ(reported.thermal().angle().SerializeAsString(), angle.SerializeAsString())
        << material.name << "\n"
        << text;
  }
}

TEST(LimitsReportTest, OverridesSayTheSame) {
  std::string text = DescribeOptions(SomeLimits());
  GroundOptions options;
  const std::string_view kSet = "--set ";
  std::size_t place = 0;
  int count = 0;
  while ((place = text.find(kSet, place)) != std::string::npos) {
    place += kSet.size();
    ASSERT_TRUE(
        ApplyOverride(text.substr(place, text.find_first_of(" \n", place) - place), options).ok());
    ++count;
  }
  EXPECT_EQ(count, 6);
  EXPECT_EQ(options.thermal().distance().good_m(), 0.533);
}

TEST(LimitsReportTest, WhatIsUnknownIsLeftOut) {
  LimitOptions limits;
  EXPECT_EQ(DescribeOptions(limits), "");
  limits.distance_max_m = 2.0;
  const std::string text = DescribeOptions(limits);
  EXPECT_NE(text.find("distance { max_m: 2.000 }"), std::string::npos);
  EXPECT_EQ(text.find("angle"), std::string::npos);
  EXPECT_EQ(text.find("min_m"), std::string::npos);
}

TEST(LimitsReportTest, EveryMaterialIsDocumented) {
  std::ifstream file(ISOTHERM_SOURCE_DIR "/docs/materials.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  const std::string list = ListMaterials({});
  for (const OpticalMaterial& material : OpticalMaterials()) {
    EXPECT_NE(document.find("`" + std::string(material.name) + "`"), std::string::npos)
        << material.name;
    EXPECT_NE(list.find(material.name), std::string::npos) << material.name;
    const AngleLimitsInDegrees limits = AngleLimitsOf(material);
    const std::string row = fmt::format("| `{}` | {:g} | {:g} | {:g} |", material.name,
                                        limits.min_deg, limits.good_deg, limits.max_deg);
    EXPECT_NE(document.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace isotherm
