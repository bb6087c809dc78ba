#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "common/geometry/pose_covariance.h"

namespace isotherm {

/// One-sigma figures of the trajectory's poses, relative to the model: median, 95 % and largest.
struct SigmaFigures {
  static constexpr std::array<std::string_view, 3> kNames = {"p50", "p95", "max"};
  std::array<double, 3> translation_mm{};
  std::array<double, 3> rotation_deg{};
};

/// Returns the figures of these poses; nullopt if there are none.
std::optional<SigmaFigures> Figures(const std::vector<PoseSigma>& sigmas);

}  // namespace isotherm
