#pragma once

#include <cstdint>

namespace isotherm {

/// Tells how well a model predicts thermal frames that it was not made from: errors are what a
/// frame shows minus what the model says.
struct HeldOutReport {
  std::uint64_t frames = 0;        ///< Compared.
  std::uint64_t without_pose = 0;  ///< Left out: the rig was not tracked when they were captured.
  std::uint64_t pixels = 0;        ///< Of the frames that were compared.
  std::uint64_t on_surface = 0;    ///< Pixels in which the model has a surface.
  std::uint64_t assigned = 0;      ///< Pixels for which it has a temperature.
  double sum_k = 0.0, sum_of_magnitudes_k = 0.0;
  // Pixels with a known uncertainty, and of these the errors within so many of it.
  std::uint64_t with_sigma = 0;
  std::uint64_t within_68 = 0, within_95 = 0;
  double sum_of_ratios = 0.0;
};

}  // namespace isotherm
