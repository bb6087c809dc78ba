#include "ground/results/sigma_figures.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace isotherm {
namespace {

std::array<double, 3> Figures(std::vector<double> sigmas) {
  std::sort(sigmas.begin(), sigmas.end());
  const std::size_t last = sigmas.size() - 1;
  return {sigmas[last / 2], sigmas[last * 95 / 100], sigmas[last]};
}

}  // namespace

std::optional<SigmaFigures> Figures(const std::vector<PoseSigma>& sigmas) {
  if (sigmas.empty()) return std::nullopt;
  std::vector<double> translations_mm;
  std::vector<double> rotations_deg;
  for (const PoseSigma& sigma : sigmas) {
    translations_mm.push_back(1e3 * sigma.translation_m);
    rotations_deg.push_back(sigma.rotation_rad * 180.0 / std::numbers::pi);
  }
  return SigmaFigures{Figures(std::move(translations_mm)), Figures(std::move(rotations_deg))};
}

}  // namespace isotherm
