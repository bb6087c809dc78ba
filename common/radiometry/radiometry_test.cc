#include "common/radiometry/radiometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "common/base/units.h"
#include "common/radiometry/testing/fresnel.h"

namespace isotherm {
namespace {

constexpr double kInterpolation_k = 1e-3;  // What the class promises.

/// Planck's spectral radiance (thesis eq. 2.4, medium: air), W/(m^2 sr m).
double SpectralRadiance(double wavelength_m, double kelvin) {
  constexpr double kH = 6.62607015e-34, kC = 299792458.0, kK = 1.380649e-23;
  return 2.0 * kH * kC * kC / std::pow(wavelength_m, 5) /
         std::expm1(kH * kC / (wavelength_m * kK * kelvin));
}

double IntegrateBySimpson(double celsius, const SpectralBand& band, int intervals) {
  const double step = (band.max_um - band.min_um) * 1e-6 / intervals;
  double sum = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double weight = (i == 0 || i == intervals) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * SpectralRadiance(band.min_um * 1e-6 + i * step, celsius + 273.15);
  }
  return sum * step / 3.0;
}

TEST(PlanckBandRadianceTest, IsTheIntegralOfPlancksLaw) {
  for (const double celsius : {-100.0, -20.0, 23.0, 100.0, 280.0, 900.0, 1500.0}) {
    const double expected = IntegrateBySimpson(celsius, {}, 2000);
    EXPECT_NEAR(PlanckBandRadiance(celsius, {}) / expected, 1.0, 1e-9) << celsius;
  }
}

TEST(PlanckBandRadianceTest, OfAllWavelengthsIsStefanBoltzmann) {
  constexpr double kSigma = 5.670374419e-8;  // W/(m^2 K^4)
  for (const double celsius : {-100.0, 23.0, 1500.0}) {
    const double expected = kSigma * std::pow(celsius + 273.15, 4) / std::numbers::pi;
    EXPECT_NEAR(PlanckBandRadiance(celsius, {0.1, 100000.0}) / expected, 1.0, 1e-7) << celsius;
  }
}

TEST(PlanckBandRadianceTest, KnownFractionsOfTheTotal) {
  // Black-body function of heat transfer tables: a quarter of all radiation lies below the peak at
  // 2898 um K, and 0.480877 below 4000 um K.
  constexpr double kSigma = 5.670374419e-8;
  const double kelvin = 1000.0;
  const double total = kSigma * std::pow(kelvin, 4) / std::numbers::pi;
  EXPECT_NEAR(PlanckBandRadiance(kelvin - 273.15, {0.01, 2.898}) / total, 0.25011, 2e-5);
  EXPECT_NEAR(PlanckBandRadiance(kelvin - 273.15, {0.01, 4.0}) / total, 0.480877, 2e-5);
}

TEST(PlanckBandRadianceTest, SlopeIsTheDerivative) {
  for (const double celsius : {-90.0, 23.0, 280.0, 1400.0}) {
    const double numeric =
        (PlanckBandRadiance(celsius + 0.01, {}) - PlanckBandRadiance(celsius - 0.01, {})) / 0.02;
    EXPECT_NEAR(PlanckBandRadianceSlope(celsius, {}) / numeric, 1.0, 1e-6);
  }
}

TEST(BandRadianceTest, InterpolatesWithinAMillikelvin) {
  const BandRadiance band;
  const unsigned seed = 7;
  std::cout << "seed " << seed << '\n';
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> celsius_in_range(kMinRadiometric_celsius,
                                                          kMaxRadiometric_celsius);
  double worst_forward = 0.0, worst_round_trip = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double celsius = celsius_in_range(random);
    const double radiance = band.RadianceFromCelsius(celsius);
    const double forward_kelvin =
        (radiance - PlanckBandRadiance(celsius, {})) / PlanckBandRadianceSlope(celsius, {});
    worst_forward = std::max(worst_forward, std::abs(forward_kelvin));
    worst_round_trip =
        std::max(worst_round_trip, std::abs(band.CelsiusFromRadiance(radiance) - celsius));
  }
  std::cout << "worst forward error_kelvin=" << worst_forward
            << " round trip error_kelvin=" << worst_round_trip << '\n';
  EXPECT_LT(worst_forward, kInterpolation_k);
  EXPECT_LT(worst_round_trip, kInterpolation_k);
}

TEST(BandRadianceTest, OutsideTheRangeIsNan) {
  const BandRadiance band;
  EXPECT_FALSE(std::isnan(band.CelsiusFromRadiance(band.RadianceFromCelsius(-100.0))));
  EXPECT_FALSE(std::isnan(band.CelsiusFromRadiance(band.RadianceFromCelsius(1500.0))));
  EXPECT_TRUE(std::isnan(band.RadianceFromCelsius(-100.1)));
  EXPECT_TRUE(std::isnan(band.RadianceFromCelsius(1500.1)));
  EXPECT_TRUE(std::isnan(band.RadianceFromCelsius(std::nan(""))));
  EXPECT_TRUE(std::isnan(band.CelsiusFromRadiance(0.0)));
  EXPECT_TRUE(std::isnan(band.CelsiusFromRadiance(-1.0)));
}

TEST(FresnelTest, AgreesWithTheComplexAmplitudes) {
  for (const double n : {0.2, 1.0, 1.5, 2.4, 14.0}) {
    for (const double kappa : {0.0, 0.1, 1.7, 60.0}) {
      for (double degrees = 0.0; degrees < 90.0; degrees += 0.7) {
        if (n < 1.0 && kappa == 0.0) continue;  // Total reflection: no real surface.
        EXPECT_NEAR(FresnelReflectivity(degrees * kRadPerDeg, n, kappa),
                    testing::ComplexFresnel(degrees * kRadPerDeg, {n, kappa}), 1e-10)
            << n << " " << kappa << " " << degrees;
      }
    }
  }
}

TEST(FresnelTest, AlongTheNormalAndAtTheEdge) {
  EXPECT_NEAR(FresnelReflectivity(0.0, 1.5, 0.0), 0.04, 1e-12);
  EXPECT_NEAR(FresnelReflectivity(89.9999 * kRadPerDeg, 1.5, 0.0), 1.0, 1e-4);
  EXPECT_EQ(FresnelReflectivity(90.0 * kRadPerDeg, 1.5, 0.0), 1.0);
  EXPECT_NEAR(FresnelReflectivity(0.0, 1.0, 0.0), 0.0, 1e-12);
}

TEST(FresnelTest, NothingIsReflectedInThePlaneAtBrewstersAngle) {
  const double brewster = std::atan(1.5);
  const double s_only =
      std::norm((std::cos(brewster) - std::sqrt(2.25 - std::pow(std::sin(brewster), 2))) /
                (std::cos(brewster) + std::sqrt(2.25 - std::pow(std::sin(brewster), 2))));
  EXPECT_NEAR(FresnelReflectivity(brewster, 1.5, 0.0), s_only / 2.0, 1e-12);
}

TEST(FresnelTest, EnergyIsConserved) {
  // What enters at theta_1 leaves at theta_2: reflectivity is the same from both sides (Stokes),
  // and always 0..1.
  for (double degrees = 0.0; degrees < 90.0; degrees += 1.0) {
    const double rho = FresnelReflectivity(degrees * kRadPerDeg, 1.5, 0.3);
    EXPECT_GE(rho, 0.0);
    EXPECT_LE(rho, 1.0);
    const double inside = std::asin(std::sin(degrees * kRadPerDeg) / 1.5);
    EXPECT_NEAR(FresnelReflectivity(degrees * kRadPerDeg, 1.5, 0.0),
                FresnelReflectivity(inside, 1.0 / 1.5, 0.0), 1e-9);
  }
}

TEST(DirectionalEmissivityTest, FallsFromItsValueAlongTheNormal) {
  EXPECT_NEAR(DirectionalEmissivity(0.0, 0.96, 1.5, 0.0), 0.96, 1e-12);
  EXPECT_NEAR(DirectionalEmissivity(60.0 * kRadPerDeg, 0.96, 1.5, 0.0),
              1.0 - FresnelReflectivity(60.0 * kRadPerDeg, 1.5, 0.0), 1e-12);
  EXPECT_NEAR(DirectionalEmissivity(60.0 * kRadPerDeg, 0.48, 1.5, 0.0),
              0.5 * DirectionalEmissivity(60.0 * kRadPerDeg, 0.96, 1.5, 0.0), 1e-12);
  EXPECT_EQ(DirectionalEmissivity(90.0 * kRadPerDeg, 0.96, 1.5, 0.0), 0.0);
  // Metals first rise towards grazing angles (thesis figure 2.5).
  EXPECT_GT(DirectionalEmissivity(80.0 * kRadPerDeg, 0.03, 12.0, 60.0), 0.03);
}

TEST(ApparentCelsiusTest, BlackBodiesAndEqualSurroundingsShowTheTruth) {
  const BandRadiance band;
  EXPECT_NEAR(ApparentCelsius(band, 280.0, 1.0, 23.0), 280.0, kInterpolation_k);
  EXPECT_NEAR(ApparentCelsius(band, 23.0, 0.3, 23.0), 23.0, kInterpolation_k);
  EXPECT_NEAR(ApparentCelsius(band, 280.0, 0.0, 23.0), 23.0, kInterpolation_k);
}

TEST(ApparentCelsiusTest, HotPaintedSteelLooksColder) {
  const BandRadiance band;
  EXPECT_NEAR(ApparentCelsius(band, 280.0, 0.96, 23.0), 273.0, 0.5);
}

TEST(TrueCelsiusTest, InvertsApparentCelsius) {
  const BandRadiance band;
  for (const double celsius : {-50.0, 23.0, 100.0, 280.0, 1200.0}) {
    for (const double emissivity : {0.3, 0.7, 0.96, 1.0}) {
      const double apparent = ApparentCelsius(band, celsius, emissivity, 23.0);
      const Result<double> restored = TrueCelsius(band, apparent, emissivity, 23.0);
      ASSERT_TRUE(restored.has_value());
      EXPECT_NEAR(*restored, celsius, kInterpolation_k) << celsius << " " << emissivity;
    }
  }
}

TEST(TrueCelsiusTest, RefusesWhatCannotBe) {
  const BandRadiance band;
  EXPECT_EQ(TrueCelsius(band, 30.0, 0.0, 23.0).error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(TrueCelsius(band, 30.0, 1.1, 23.0).error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(TrueCelsius(band, 2000.0, 0.9, 23.0).error().code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(TrueCelsius(band, -80.0, 0.2, 300.0).error().code(), StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace isotherm
