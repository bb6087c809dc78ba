#pragma once

#include <span>

namespace isotherm {

/// One row of the bilateral filter. `rows` are the image rows from -radius to +radius around the
/// centre row (null outside the image); `spatial` the (2 radius + 1)^2 weights over pixels.
/// `tau_at_1m`: depth differences beyond tau_at_1m x depth^2 have no weight. 0 = no return, in and
/// out.
struct BilateralRowArgs {
  const float* const* rows;
  const float* spatial;
  int radius;
  int width;
  float tau_at_1m;
};

void BilateralRow(const BilateralRowArgs& args, std::span<float> filtered);

}  // namespace isotherm
