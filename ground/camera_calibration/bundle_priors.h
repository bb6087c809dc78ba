#pragma once

#include <array>

#include "ground/camera_calibration/board_shape.h"
#include "ground/camera_calibration/lens_projection.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// How far a target's face may be off a plane, by term of BoardShape: standard deviations, metres.
/// A board bends rather than ripples.
std::array<double, BoardShape::kWarpTerms> WarpSigmas(const CalibrationTarget& target);

/// How far coefficients of wide lenses may be from 0: standard deviations, infinite without a
/// prior. Numerator and denominator of a rational lens may otherwise grow together without bound,
/// and the highest power of a fisheye takes a corner that no feature reached anywhere. A lens whose
/// own coefficients are larger projects as one with smaller ones does, within a hundredth of a
/// pixel: the others make up for them. Not tuned.
LensParameters LensSigmas(LensKind kind);

/// Counts a lens's parameters without a prior.
int FreeLensParameters(LensKind kind);

}  // namespace isotherm
