#include "common/radiometry/band_emissivity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/radiometry/testing/fresnel.h"

namespace isotherm {
namespace {

constexpr SpectralBand kBand{7.5, 13.0};

TEST(BandEmissivityTest, OneIndexIsOneMinusItsReflectivity) {
  for (const IndexSample index :
       {IndexSample{10.0, 1.5, 0.0}, {10.0, 2.0, 1.3}, {3.0, 12.0, 60.0}}) {
    const BandEmissivity emissivity(std::span(&index, 1), kBand, 50.0);
    const double n = index.n, k = index.kappa;
    EXPECT_NEAR(emissivity.At(0.0),
                1.0 - ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k), 1e-12);
    for (double degrees = 0.0; degrees < 90.0; degrees += 3.0) {
      EXPECT_NEAR(emissivity.At(degrees * kRadPerDeg),
                  1.0 - testing::ComplexFresnel(degrees * kRadPerDeg, {n, k}), 1e-10);
    }
    EXPECT_EQ(emissivity.At(90.0 * kRadPerDeg), 0.0);
  }
}

/// Planck's law times emissivity, integrated over the wavelength by the midpoint rule; the index is
/// that of the nearest sample.
double IntegrateEmissivity(std::span<const IndexSample> samples, double celsius, double angle) {
  constexpr int kIntervals = 20000;
  double emitted = 0.0, black = 0.0;
  for (int i = 0; i < kIntervals; ++i) {
    const double um = kBand.min_um + (i + 0.5) * (kBand.max_um - kBand.min_um) / kIntervals;
    const IndexSample* nearest = samples.data();
    for (const IndexSample& sample : samples) {
      if (std::abs(sample.wavelength_um - um) < std::abs(nearest->wavelength_um - um))
        nearest = &sample;
    }
    const double radiance = std::pow(um, -5) / std::expm1(14387.77 / (um * (celsius + 273.15)));
    emitted += radiance * (1.0 - testing::ComplexFresnel(angle, {nearest->n, nearest->kappa}));
    black += radiance;
  }
  return emitted / black;
}

TEST(BandEmissivityTest, IsTheMeanOverTheBandWeightedWithPlancksLaw) {
  constexpr double kIntegration = 2e-5;  // Midpoint rule at the steps between samples.
  const IndexSample samples[] = {
      {6.0, 1.2, 0.0}, {8.0, 0.5, 0.4}, {9.0, 0.7, 2.2}, {11.0, 1.9, 0.2}, {20.0, 3.0, 3.0}};
  for (const double celsius : {-40.0, 23.0, 900.0}) {
    const BandEmissivity emissivity(samples, kBand, celsius);
    for (const double degrees : {0.0, 45.0, 75.0}) {
      EXPECT_NEAR(emissivity.At(degrees * kRadPerDeg),
                  IntegrateEmissivity(samples, celsius, degrees * kRadPerDeg), kIntegration)
          << celsius << " " << degrees;
    }
  }
}

TEST(BandEmissivityTest, HotBodiesWeighShortWavelengthsMore) {
  const IndexSample samples[] = {{8.0, 1.0, 0.0}, {12.0, 3.0, 0.0}};  // Black below 10 um.
  EXPECT_GT(BandEmissivity(samples, kBand, 1000.0).At(0.0),
            BandEmissivity(samples, kBand, 0.0).At(0.0));
}

}  // namespace
}  // namespace isotherm
