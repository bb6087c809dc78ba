#pragma once

#include <cmath>
#include <cstdint>

#include "common/testing/kernel_checks.h"
#include "ground/tsdf/culling_kernel.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Returns whether CullBlocks keeps a block. With `precision` 0 all sums are exact.
inline Tribool CullBlock(const float (&planes)[kFrustumPlanes][4], const std::int32_t* block,
                         double precision) {
  Tribool inside = Tribool::kYes;
  for (const auto& plane : planes) {
    double value = plane[3];
    double magnitude = std::abs(value);
    for (int axis = 0; axis < 3; ++axis) {
      const double term = static_cast<double>(plane[axis]) * block[axis];
      value += term;
      magnitude += std::abs(term);
    }
    inside = Both(inside, AtLeastZero(value, precision * magnitude));
  }
  return inside;
}

}  // namespace isotherm::reference
