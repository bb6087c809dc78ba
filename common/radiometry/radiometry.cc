#include "common/radiometry/radiometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/check.h"
#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// CODATA 2018 (exact in the SI since 2019).
constexpr double kPlanck = 6.62607015e-34;
constexpr double kLightSpeed = 299792458.0;
constexpr double kBoltzmann = 1.380649e-23;

// 1 K and 1/2048 of the logarithmic range keep the interpolation error below 0.01 mK.
constexpr int kForwardIntervals =
    static_cast<int>(kMaxRadiometric_celsius - kMinRadiometric_celsius);
constexpr int kInverseIntervals = 2048;

/// Integral of x^3 / (e^x - 1) from x to infinity (series in e^-nx).
double PlanckTail(double x) {
  // A term below the last digit of the sum.
  constexpr double kNegligible = 1e-17;
  double sum = 0.0;
  for (int i = 1;; ++i) {
    const double n = i;
    const double term = std::exp(-n * x) *
                        (x * x * x + 3.0 * x * x / n + 6.0 * x / (n * n) + 6.0 / (n * n * n)) / n;
    sum += term;
    if (term <= kNegligible * sum || i == 100000) return sum;
  }
}

double ScaledFrequency(double wavelength_um, double kelvin) {
  return kPlanck * kLightSpeed / (wavelength_um * 1e-6 * kBoltzmann * kelvin);
}

/// L = kPrefactor T^4 (tail(x_max wavelength) - tail(x_min wavelength)).
constexpr double kPrefactor = 2.0 * kBoltzmann * kBoltzmann * kBoltzmann * kBoltzmann /
                              (kPlanck * kPlanck * kPlanck * kLightSpeed * kLightSpeed);

double KelvinSlope(double kelvin, const SpectralBand& band) {
  const auto integrand_times_x = [](double x) { return x * x * x * x / std::expm1(x); };
  const double x_short = ScaledFrequency(band.min_um, kelvin);
  const double x_long = ScaledFrequency(band.max_um, kelvin);
  const double tails = PlanckTail(x_long) - PlanckTail(x_short);
  const double edges = integrand_times_x(x_long) - integrand_times_x(x_short);
  return kPrefactor * kelvin * kelvin * kelvin * (4.0 * tails + edges);
}

double InvertExactly(double radiance, double first_guess, const SpectralBand& band) {
  // Newton's method from the table's value takes two or three steps; the limit ends what NaN would
  // not.
  constexpr int kMaxIterations = 30;
  // Far below any use, above the rounding of a radiance.
  constexpr double kConverged_k = 1e-9;
  double celsius = first_guess;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double step =
        (PlanckBandRadiance(celsius, band) - radiance) / PlanckBandRadianceSlope(celsius, band);
    celsius -= step;
    if (std::abs(step) < kConverged_k) break;
  }
  return celsius;
}

}  // namespace

double PlanckBandRadiance(double celsius, const SpectralBand& band) {
  const double kelvin = celsius + kCelsiusZero_k;
  const double tails = PlanckTail(ScaledFrequency(band.max_um, kelvin)) -
                       PlanckTail(ScaledFrequency(band.min_um, kelvin));
  return kPrefactor * kelvin * kelvin * kelvin * kelvin * tails;
}

double PlanckBandRadianceSlope(double celsius, const SpectralBand& band) {
  return KelvinSlope(celsius + kCelsiusZero_k, band);
}

BandRadiance::BandRadiance(const SpectralBand& band) : band_(band) {
  CHECK(band.min_um > 0.0 && band.max_um > band.min_um);
  constexpr double kStep =
      (kMaxRadiometric_celsius - kMinRadiometric_celsius) / static_cast<double>(kForwardIntervals);
  for (int i = 0; i <= kForwardIntervals; ++i) {
    const double celsius = kMinRadiometric_celsius + i * kStep;
    radiance_.push_back(
        {PlanckBandRadiance(celsius, band), PlanckBandRadianceSlope(celsius, band) * kStep});
  }
  min_radiance_ = radiance_.front().value;
  max_radiance_ = radiance_.back().value;
  min_log_ = std::log(min_radiance_);
  log_step_ = (std::log(max_radiance_) - min_log_) / kInverseIntervals;
  double celsius = kMinRadiometric_celsius;
  for (int i = 0; i <= kInverseIntervals; ++i) {
    const double radiance = std::exp(min_log_ + i * log_step_);
    celsius = InvertExactly(radiance, celsius, band);
    celsius_.push_back({celsius, radiance / PlanckBandRadianceSlope(celsius, band) * log_step_});
  }
}

double BandRadiance::Evaluate(const std::vector<Knot>& table, double position) {
  const int last = static_cast<int>(table.size()) - 2;
  const int index = std::clamp(static_cast<int>(position), 0, last);
  const double s = position - index;
  const Knot& a = table[static_cast<std::size_t>(index)];
  const Knot& b = table[static_cast<std::size_t>(index) + 1];
  const double delta = b.value - a.value;
  const double c2 = 3.0 * delta - 2.0 * a.slope - b.slope;
  const double c3 = a.slope + b.slope - 2.0 * delta;
  return a.value + s * (a.slope + s * (c2 + s * c3));
}

double BandRadiance::RadianceFromCelsius(double celsius) const {
  if (!(celsius >= kMinRadiometric_celsius && celsius <= kMaxRadiometric_celsius)) return kNan;
  constexpr double kPerCelsius =
      kForwardIntervals / (kMaxRadiometric_celsius - kMinRadiometric_celsius);
  return Evaluate(radiance_, (celsius - kMinRadiometric_celsius) * kPerCelsius);
}

double BandRadiance::CelsiusFromRadiance(double radiance) const {
  // Forward interpolation at the ends of the range may leave it by rounding.
  constexpr double kRounding = 1e-12;
  if (!(radiance >= min_radiance_ * (1.0 - kRounding) &&
        radiance <= max_radiance_ * (1.0 + kRounding))) {
    return kNan;
  }
  return Evaluate(celsius_, (std::log(radiance) - min_log_) / log_step_);
}

double FresnelReflectivity(double angle_rad, double n, double kappa) {
  const double theta = std::abs(angle_rad);
  if (theta >= std::numbers::pi / 2.0) return 1.0;
  // Symbols as in thesis B.2; p and q are sqrt((a + z) / 2) and sqrt((a - z) / 2).
  const double sine = std::sin(theta);
  const double cosine = std::cos(theta);
  const double z = n * n - kappa * kappa - sine * sine;
  const double a = std::hypot(z, 2.0 * n * kappa);
  const double p = std::sqrt(std::max(0.0, (a + z) / 2.0));
  const double q2 = std::max(0.0, (a - z) / 2.0);
  const auto ratio = [&](double x) { return ((p - x) * (p - x) + q2) / ((p + x) * (p + x) + q2); };
  const double rho_perpendicular = ratio(cosine);
  const double rho_parallel = ratio(sine * sine / cosine) * rho_perpendicular;
  return (rho_perpendicular + rho_parallel) / 2.0;
}

double DirectionalEmissivity(double angle_rad, double normal_emissivity, double n, double kappa) {
  const double along_normal = 1.0 - FresnelReflectivity(0.0, n, kappa);
  if (!(along_normal > 0.0)) return normal_emissivity;
  const double emissivity =
      normal_emissivity * (1.0 - FresnelReflectivity(angle_rad, n, kappa)) / along_normal;
  return std::clamp(emissivity, 0.0, 1.0);
}

double ApparentCelsius(const BandRadiance& band, double true_celsius, double emissivity,
                       double reflected_celsius) {
  return band.CelsiusFromRadiance(emissivity * band.RadianceFromCelsius(true_celsius) +
                                  (1.0 - emissivity) * band.RadianceFromCelsius(reflected_celsius));
}

Result<double> TrueCelsius(const BandRadiance& band, double apparent_celsius, double emissivity,
                           double reflected_celsius) {
  if (!(emissivity > 0.0 && emissivity <= 1.0)) {
    return Err(InvalidArgument(fmt::format("emissivity must be in (0, 1], got {}", emissivity)));
  }
  const double apparent = band.RadianceFromCelsius(apparent_celsius);
  const double reflected = band.RadianceFromCelsius(reflected_celsius);
  if (!std::isfinite(apparent) || !std::isfinite(reflected)) {
    return Err(InvalidArgument(fmt::format(
        "temperatures must be {}..{} °C, got {} °C apparent and {} °C reflected",
        kMinRadiometric_celsius, kMaxRadiometric_celsius, apparent_celsius, reflected_celsius)));
  }
  const double emitted = (apparent - (1.0 - emissivity) * reflected) / emissivity;
  const double celsius = band.CelsiusFromRadiance(emitted);
  if (!std::isfinite(celsius)) {
    return Err(FailedPrecondition(
        fmt::format("no temperature in {}..{} °C looks like {} °C with emissivity {} and {} °C "
                    "reflected",
                    kMinRadiometric_celsius, kMaxRadiometric_celsius, apparent_celsius, emissivity,
                    reflected_celsius)));
  }
  return celsius;
}

}  // namespace isotherm
