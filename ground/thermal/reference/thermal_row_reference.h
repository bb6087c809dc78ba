#pragma once

#include <cmath>
#include <limits>

#include "ground/thermal/thermal_kernel.h"

// These functions do what the kernels beside this folder must do, one element at a time and in
// double precision: they are their specification. Compiled for tests only.
namespace isotherm::reference {

/// Returns what ResampleRow must make of pixel x.
inline double ResamplePixel(const ResampleRowArgs& a, int x) {
  if (a.source[x] < 0) return std::numeric_limits<double>::quiet_NaN();
  const float* p = a.image + a.source[x];
  const double fx = a.fraction_x[x];
  const double above = p[0] + fx * (double{p[1]} - p[0]);
  const double below = p[a.stride] + fx * (double{p[a.stride + 1]} - p[a.stride]);
  return above + double{a.fraction_y[x]} * (below - above);
}

/// Returns what DistanceRow must make of a vertex.
inline double Distance(const float* vertex, const float* position) {
  double squared = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    squared += std::pow(double{vertex[axis]} - position[axis], 2);
  return std::isnan(squared) ? std::numeric_limits<float>::max() : std::sqrt(squared);
}

}  // namespace isotherm::reference
