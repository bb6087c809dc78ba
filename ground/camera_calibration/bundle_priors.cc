#include "ground/camera_calibration/bundle_priors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm {

std::array<double, BoardShape::kWarpTerms> WarpSigmas(const CalibrationTarget& target) {
  constexpr double kCubic = 0.3, kQuartic = 0.15;
  std::array<double, BoardShape::kWarpTerms> sigmas{};
  for (int i = 0; i < BoardShape::kWarpTerms; ++i) {
    const int degree = BoardShape::DegreeOf(i);
    sigmas[static_cast<std::size_t>(i)] = target.warp_sigma_m * (degree == 2   ? 1.0
                                                                 : degree == 3 ? kCubic
                                                                               : kQuartic);
  }
  return sigmas;
}

LensParameters LensSigmas(LensKind kind) {
  LensParameters sigmas;
  sigmas.fill(std::numeric_limits<double>::infinity());
  switch (kind) {
    case LensKind::kBrownConrady:
      break;
    case LensKind::kRational:
      sigmas[9] = 1.0;  // k4
      sigmas[10] = 0.3;
      sigmas[11] = 0.1;
      break;
    case LensKind::kFisheye:
      sigmas[6] = 0.05;  // k3
      sigmas[7] = 0.02;
      break;
  }
  return sigmas;
}

int FreeLensParameters(LensKind kind) {
  const LensParameters sigmas = LensSigmas(kind);
  const auto priors = std::ranges::count_if(sigmas, [](double s) { return std::isfinite(s); });
  return LensParameterCount(kind) - static_cast<int>(priors);
}

}  // namespace isotherm
