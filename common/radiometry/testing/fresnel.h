#pragma once

#include <cmath>
#include <complex>

namespace isotherm::testing {

/// Reflectivity of unpolarised radiation by the textbook's complex amplitudes (Born and Wolf):
/// nothing in common with the real arithmetic of thesis B.2.
inline double ComplexFresnel(double theta, std::complex<double> index) {
  const double cosine = std::cos(theta);
  const std::complex<double> transmitted =
      std::sqrt(index * index - std::sin(theta) * std::sin(theta));
  const auto r_s = (cosine - transmitted) / (cosine + transmitted);
  const auto r_p = (index * index * cosine - transmitted) / (index * index * cosine + transmitted);
  return (std::norm(r_s) + std::norm(r_p)) / 2.0;
}

}  // namespace isotherm::testing
