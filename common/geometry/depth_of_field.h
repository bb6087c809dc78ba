#pragma once

namespace isotherm {

/// Distances from the lens between which the image is sharp; `far_m` may be infinite.
struct DepthOfField {
  double near_m;
  double far_m;
};

/// Eq. (2.20a, b) of a thin lens that is focused at `focus_m`: where the blur of a point is as wide
/// as `circle_m` on the detector (thesis 2.3.2: one detector element). All positive, `focus_m`
/// above the focal length (CHECK).
DepthOfField ComputeDepthOfField(double focal_length_m, double f_number, double circle_m,
                                 double focus_m);

/// The nearest focus distance from which everything to infinity is sharp (2.3.2). Half of it is
/// then the near limit.
double HyperfocalDistance(double focal_length_m, double f_number, double circle_m);

/// The part of a surface that one pixel sees, metres.
struct PixelFootprint {
  double across_m;  ///< Across the direction in which the surface is tilted.
  double along_m;   ///< Along it: longer by 1 / cos.
};
/// `ifov_rad`: angle that a pixel sees (2.3.3), pitch / focal length. `angle_rad` below 90 degrees,
/// between the line of sight and the surface's normal.
PixelFootprint FootprintOfPixel(double ifov_rad, double distance_m, double angle_rad);

}  // namespace isotherm
