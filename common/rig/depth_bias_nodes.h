#pragma once

#include <array>
#include <cstddef>

#include "common/rig/depth_bias.h"

namespace isotherm {

/// Holds the nodes around a place of a table and their shares in its multiplier, which add up to 1.
struct NodeShares {
  std::array<std::size_t, 8> nodes;  ///< Indices of DepthBias::multipliers.
  std::array<double, 8> shares;
};

/// `x` and `y` in fractions of the image. The table's sides and distances count, its multipliers
/// may be missing.
NodeShares SharesAt(const DepthBias& table, double x, double y, double measured_m);

}  // namespace isotherm
