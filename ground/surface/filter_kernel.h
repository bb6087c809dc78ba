#pragma once

#include <cstdint>
#include <span>

namespace isotherm {

/// One row of the bilateral filter. `rows` are the image rows from -radius to +radius around the
/// centre row (null outside the image); `spatial` the (2 radius + 1)^2 weights over pixels.
/// `tau_at_1m`: depth differences beyond tau_at_1m x depth^2, or beyond the depth itself, have no
/// weight. 0 = no return, in and out.
struct BilateralRowArgs {
  const float* const* rows;
  const float* spatial;
  int radius;
  int width;
  float tau_at_1m;
};

void BilateralRow(const BilateralRowArgs& args, std::span<float> filtered);

/// Converts raw depth of one row to metres: 0 outside [min_depth_m, max_depth_m] and where the
/// sensor had no return (0 or 65535). Returns how many pixels have a depth.
struct MetresRowArgs {
  const std::uint16_t* raw;
  float metres_per_unit;
  float min_depth_m, max_depth_m;
};
int MetresRow(const MetresRowArgs& args, std::span<float> depth_m);

/// Holds how many pixels of a row have a depth, and how many of them lack that of the next pixel in
/// the row or in the row below.
struct GapCount {
  int pixels = 0;
  int beside_gap = 0;
};
GapCount CountGaps(const float* row, const float* below, int width);

/// One row of depth with its holes filled. `rows` are the image rows from -radius to +radius around
/// the centre row (null outside the image). A pixel without return gets the depth of the plane that
/// fits those around it that lie within `max_step_ratio` of the nearest, if they lie on all sides
/// of it and as near the plane as noise (`noise_at_1m` metres, growing with depth squared)
/// explains. Measured depth stays. 0 = no return, in and out.
struct FillRowArgs {
  const float* const* rows;
  int radius;
  int width;
  float max_step_ratio;
  float noise_at_1m;
};
void FillRow(const FillRowArgs& args, std::span<float> filled_m);

/// One row of a depth image of half the size: mean of those of the 2 x 2 pixels that lie within
/// `max_step_ratio` of the nearest. 0 = no return, in and out.
struct HalfRowArgs {
  const float* upper;
  const float* lower;
  float max_step_ratio;
};
void HalfRow(const HalfRowArgs& args, std::span<float> half_m);

}  // namespace isotherm
