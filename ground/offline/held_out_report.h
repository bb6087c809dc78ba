#pragma once

#include <cstdint>

#include "common/base/sigma_coverage.h"

namespace isotherm {

/// Tells how well a model predicts thermal frames that it was not made from: errors are what a
/// frame shows minus what the model says.
struct HeldOutReport {
  std::uint64_t frames = 0;        ///< Compared.
  std::uint64_t without_pose = 0;  ///< Left out: the rig was not tracked when they were captured.
  std::uint64_t wrong_size = 0;    ///< Left out: of another size than the calibration's.
  /// Thermal frames of the recording that are damaged, so that they could not be held out.
  std::uint64_t undecodable = 0;
  std::uint64_t pixels = 0;      ///< Pixels of the frames that were compared.
  std::uint64_t on_surface = 0;  ///< Pixels in which the model has a surface.
  std::uint64_t assigned = 0;    ///< Pixels for which it has a temperature.
  double sum_k = 0.0, sum_of_magnitudes_k = 0.0;
  SigmaCoverage coverage;  ///< Pixels whose uncertainty is known.
};

}  // namespace isotherm
