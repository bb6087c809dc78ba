#pragma once

namespace isotherm {

/// Fraction of a pixel's radiation that comes from between two lines along its columns or rows, at
/// these offsets from its middle, pixels. A sharp lens.
double PixelResponse(double from_px, double to_px);

/// The fraction that comes from a square around its middle if the image of each point is a disc of
/// `circle_px` diameter (out of focus), by fine steps over the disc. Pixels.
double SquareResponse(double half_edge_px, double circle_px);

}  // namespace isotherm
