#pragma once

#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Tells by what a depth camera's distances have to be multiplied to be right, over the image and
/// the distance (Teichman, Miller and Thrun 2013: depth cameras swell and bend). Nodes lie evenly
/// over the raw image from its first pixel to its last, and at the distances; between nodes it is
/// linear, beyond the distances as at the nearest of them. Without nodes nothing is wrong.
struct DepthBias {
  int columns = 0;                 ///< Nodes across the image.
  int rows = 0;                    ///< Nodes down the image.
  std::vector<float> distances_m;  ///< As they are measured, ascending.
  std::vector<float> multipliers;  ///< Row by row for the first distance, then for the next.

  static constexpr int kMinSide = 2, kMaxSide = 32;
  static constexpr int kMaxDistances = 16;
  static constexpr float kMinMultiplier = 0.8F, kMaxMultiplier = 1.25F;

  bool empty() const { return multipliers.empty(); }

  /// The multiplier at a node.
  float Node(int distance, int row, int column) const {
    return multipliers[static_cast<std::size_t>((distance * rows + row) * columns + column)];
  }

  /// The multiplier of the layer at a distance, `x` and `y` in fractions of the image, 0 at its
  /// first pixel and 1 at its last; beyond, as at the border.
  double InLayer(int distance, double x, double y) const;

  /// The multiplier of what is measured at `measured_m`.
  double At(double x, double y, double measured_m) const;
};

/// The message names the field of the rig file.
Status Validate(const DepthBias& bias);

}  // namespace isotherm
