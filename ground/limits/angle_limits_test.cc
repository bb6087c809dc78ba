#include "ground/limits/angle_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/radiometry/materials.h"
#include "common/radiometry/testing/fresnel.h"

namespace isotherm {
namespace {

constexpr double kSearchStep = 0.11 * kRadPerDeg;  // The search steps by 0.1 degrees.
constexpr IndexSample kPaint[] = {{10.0, 1.5, 0.0}};
constexpr IndexSample kMetal[] = {{10.0, 8.3, 63.0}};

EmissionCurve Curve(std::span<const IndexSample> material,
                    const EmissionConditions& conditions = {}) {
  return {material, SpectralBand{}, conditions};
}

/// Angle from which the emissivity differs by more than `tolerance` from that along the normal.
double AngleByBisection(std::complex<double> index, double tolerance) {
  const double normal = 1.0 - testing::ComplexFresnel(0.0, index);
  double low = 0.0, high = 0.0;
  const auto off = [&](double angle) {
    return std::abs((1.0 - testing::ComplexFresnel(angle, index)) / normal - 1.0) > tolerance;
  };
  while (!off(high)) high += 0.001;
  for (int i = 0; i < 60; ++i) (off((low + high) / 2.0) ? high : low) = (low + high) / 2.0;
  return low;
}

TEST(EmissionCurveTest, LimitsAreWhereTheEmissivityLeavesTheTolerance) {
  for (const auto& [material, index] :
       {std::pair(kPaint, std::complex(1.5, 0.0)), std::pair(kMetal, std::complex(8.3, 63.0))}) {
    EmissionConditions conditions;
    conditions.operator_celsius = conditions.reflected_celsius;
    const auto limits =
        Curve(std::span(material, 1), conditions).Limits({0.005, false}, {0.02, false});
    ASSERT_TRUE(limits) << limits.error().message();
    EXPECT_NEAR(limits->good_rad, AngleByBisection(index, 0.005), kSearchStep);
    EXPECT_NEAR(limits->max_rad, AngleByBisection(index, 0.02), kSearchStep);
    EXPECT_EQ(limits->min_rad, 0.0);
  }
}

TEST(EmissionCurveTest, DielectricsAreGoodUpToWhereTheThesisPutsIt) {
  // 6.3.3: "somewhere between 40 and 60 degrees, depending on how much error can be tolerated".
  const auto limits = Curve(kPaint).Limits({0.01, false}, {0.05, false});
  ASSERT_TRUE(limits);
  EXPECT_GT(limits->good_rad, 40.0 * kRadPerDeg);
  EXPECT_NEAR(limits->max_rad, 60.0 * kRadPerDeg, 1.0 * kRadPerDeg);
}

TEST(AngleLimitsOfTest, APaintedSurfaceIsGoodToAHalfPercentAndAcceptableToTwo) {
  const AngleLimitsInDegrees limits = AngleLimitsOf(*FindOpticalMaterial("paint"));
  EXPECT_NEAR(limits.good_deg, AngleByBisection({1.5, 0.0}, 0.005) / kRadPerDeg, 0.11);
  EXPECT_NEAR(limits.max_deg, AngleByBisection({1.5, 0.0}, 0.02) / kRadPerDeg, 0.11);
  EXPECT_EQ(limits.min_deg, 0.0) << "35 degrees C mirrored at 4 % cost less than a half percent";
}

TEST(AngleLimitsOfTest, EachMaterialLeavesAnglesAndOfShinyOnesNotThoseThatMirrorTheOperator) {
  for (const OpticalMaterial& material : OpticalMaterials()) {
    const AngleLimitsInDegrees limits = AngleLimitsOf(material);
    EXPECT_LT(limits.min_deg, limits.good_deg) << material.name;
    EXPECT_LT(limits.good_deg, limits.max_deg) << material.name;
    const double emissivity =
        BandEmissivity(material.index, SpectralBand{}, EmissionConditions{}.object_celsius).At(0.0);
    if (emissivity < 0.94) {
      EXPECT_NEAR(limits.min_deg, 15.5, 1e-9) << material.name;
    }
  }
}

TEST(AngleLimitsOfTest, TenthsLieOnTheSafeSide) {
  const AngleLimitsInDegrees cut =
      InTenthsOfDegrees({15.41 * kRadPerDeg, 41.29 * kRadPerDeg, 55.0 * kRadPerDeg});
  EXPECT_DOUBLE_EQ(cut.min_deg, 15.5);
  EXPECT_DOUBLE_EQ(cut.good_deg, 41.2);
  EXPECT_DOUBLE_EQ(cut.max_deg, 55.0);
  EXPECT_EQ(InTenthsOfDegrees({0.0, 0.1, 0.2}).min_deg, 0.0);
}

TEST(EmissionCurveTest, KelvinAreWhatInterpretationWithTheNormalEmissivityGivesWrong) {
  constexpr double kTables = 2e-3;  // Twice BandRadiance's interpolation error, kelvin.
  const BandRadiance band;
  for (const double object : {-20.0, 100.0, 800.0}) {
    EmissionConditions conditions;
    conditions.object_celsius = object;
    const EmissionCurve curve = Curve(kPaint, conditions);
    for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
      const EmissionError error = curve.At(degrees * kRadPerDeg);
      const double seen = ApparentCelsius(band, object, error.emissivity, 23.0);
      EXPECT_NEAR(error.kelvin, TrueCelsius(band, seen, 0.96, 23.0).value() - object, kTables)
          << object << " " << degrees;
    }
    EXPECT_NEAR(curve.At(0.0).kelvin, 0.0, kTables);
    EXPECT_NEAR(curve.WithOperatorMirrored().kelvin,
                TrueCelsius(band,
                            band.CelsiusFromRadiance(0.96 * band.RadianceFromCelsius(object) +
                                                     0.04 * band.RadianceFromCelsius(35.0)),
                            0.96, 23.0)
                        .value() -
                    object,
                kTables);
  }
}

TEST(EmissionCurveTest, ToleranceInKelvinAllowsMoreOnCoolerObjects) {
  EmissionConditions warm, hot;
  warm.object_celsius = 40.0;
  hot.object_celsius = 400.0;
  const double of_warm = Curve(kPaint, warm).Limits({1.0, true}, {2.0, true})->max_rad;
  const double of_hot = Curve(kPaint, hot).Limits({1.0, true}, {2.0, true})->max_rad;
  EXPECT_GT(of_warm, of_hot + 5.0 * kRadPerDeg);
  EXPECT_NEAR(std::abs(Curve(kPaint, hot).At(of_hot + 2.0 * kSearchStep).kelvin), 2.0, 0.1);
}

TEST(EmissionCurveTest, AnObjectAsWarmAsItsSurroundingsHasNoErrorInKelvin) {
  EmissionConditions conditions;
  conditions.object_celsius = conditions.operator_celsius = conditions.reflected_celsius;
  const auto limits = Curve(kPaint, conditions).Limits({0.1, true}, {0.2, true});
  ASSERT_TRUE(limits);
  EXPECT_GT(limits->max_rad, 89.0 * kRadPerDeg);
  EXPECT_LT(Curve(kPaint, conditions).At(60.0 * kRadPerDeg).relative, -0.04);
}

TEST(EmissionCurveTest, WhoIsMirroredMattersOnReflectiveMaterialsOnly) {
  constexpr IndexSample kHalfMirror[] = {{10.0, 3.6, 1.5}};  // Magnetite, emissivity 0.63.
  EmissionConditions conditions;
  conditions.object_celsius = 60.0;
  EXPECT_EQ(Curve(kPaint, conditions).Limits({1.0, true}, {2.0, true})->min_rad, 0.0);
  const auto limits = Curve(kHalfMirror, conditions).Limits({1.0, true}, {2.0, true});
  ASSERT_TRUE(limits) << limits.error().message();
  EXPECT_NEAR(limits->min_rad / kRadPerDeg, 15.5, 0.1);  // The thesis advises 15 degrees (6.3.3).
}

TEST(EmissionCurveTest, ContradictionsAreSaid) {
  const auto reversed = Curve(kPaint).Limits({0.05, false}, {0.01, false});
  EXPECT_EQ(reversed.error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(Curve(kPaint).Limits({0.0, false}, {0.01, false}).error().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(Curve(kPaint).Limits({0.01, false}, {NAN, false}).error().code(),
            StatusCode::kInvalidArgument);
  EmissionConditions near_metal;
  near_metal.distance_m = 0.2;
  const auto nothing_left = Curve(kMetal, near_metal).Limits({0.001, false}, {0.002, false});
  EXPECT_EQ(nothing_left.error().code(), StatusCode::kFailedPrecondition);
  EXPECT_NE(nothing_left.error().message().find("contradict"), std::string::npos);
}

TEST(OperatorMirrorAngleTest, MirroredRayMeetsTheEdgeOfTheOperator) {
  // A mirror in the origin tilted by the angle sends the line of sight along (sin 2a, cos 2a); the
  // operator stands at the camera's distance.
  for (const double distance_m : {0.3, 0.5, 2.0}) {
    const double angle = OperatorMirrorAngle(0.3, distance_m);
    EXPECT_NEAR(distance_m * std::sin(2.0 * angle) / std::cos(2.0 * angle), 0.3, 1e-12);
  }
}

TEST(OpticalMaterialsTest, AreOrderedOpaqueAndNamedOnce) {
  for (const OpticalMaterial& material : OpticalMaterials()) {
    EXPECT_EQ(FindOpticalMaterial(material.name), &material);
    for (std::size_t i = 0; i < material.index.size(); ++i) {
      EXPECT_GT(material.index[i].n, 0.0) << material.name;
      EXPECT_GE(material.index[i].kappa, 0.0) << material.name;
      if (i > 0) {
        EXPECT_GT(material.index[i].wavelength_um, material.index[i - 1].wavelength_um)
            << material.name;
      }
    }
  }
  EXPECT_EQ(FindOpticalMaterial("unobtainium"), nullptr);
}

struct PublishedEmissivity {
  const char* material;
  double low, high;  ///< Along the normal, in the long-wave band.
};

TEST(OpticalMaterialsTest, EmissivitiesAreThoseOfEmissivityTables) {
  // Ranges of thermographers' tables for smooth surfaces, 8-14 um (docs/materials.md).
  const PublishedEmissivity kTable[] = {
      {"aluminium", 0.01, 0.06},      {"copper", 0.006, 0.03},
      {"gold", 0.005, 0.03},          {"iron", 0.02, 0.09},
      {"stainless", 0.07, 0.16},      {"glass", 0.80, 0.97},
      {"water", 0.96, 0.99},          {"acrylic", 0.92, 0.97},
      {"paint", 0.92, 0.97},          {"aluminium-oxidised", 0.80, 0.97},
      {"steel-oxidised", 0.60, 0.80}, {"rust", 0.80, 0.96}};
  for (const PublishedEmissivity& published : kTable) {
    const BandEmissivity emissivity(FindOpticalMaterial(published.material)->index, {}, 70.0);
    EXPECT_GE(emissivity.At(0.0), published.low) << published.material;
    EXPECT_LE(emissivity.At(0.0), published.high) << published.material;
  }
}

}  // namespace
}  // namespace isotherm
