#pragma once

#include <cstdint>

#include "common/simulation/intersection.h"
#include "common/simulation/trace_tile_kernel.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

/// Returns the depth at which the ray (x, y, 1) meets a primitive; infinity if it does not.
inline double TraceRay(Shape shape, const TileTarget& target, float x, float y) {
  const float* const R = target.R_primitive_camera;
  const auto direction = [&](int row) {
    return double{R[row]} * double{x} + double{R[row + 3]} * double{y} + double{R[row + 6]};
  };
  const LocalRay<double> ray{target.camera_in_primitive[0],
                             target.camera_in_primitive[1],
                             target.camera_in_primitive[2],
                             direction(0),
                             direction(1),
                             direction(2)};
  const LocalSize<double> size{target.size[0], target.size[1], target.size[2]};
  return VisitShape(shape,
                    [&]<Shape kShape>() { return IntersectShape<kShape, double>(ray, size); });
}

}  // namespace isotherm::reference
