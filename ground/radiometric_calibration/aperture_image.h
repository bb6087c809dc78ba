#pragma once

#include <cstdint>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"

namespace isotherm {

/// Neighbouring pixels whose mean is compared as one.
using PixelPatch = std::vector<std::uint32_t>;

/// Holds a thermal image of a black body that is seen through a hole in a plate (thesis 5.1.3), or
/// fills the image, and which pixels show what.
struct ApertureImage {
  Image<float> celsius;             ///< As measured; NaN = no value.
  double hole_radius_px = 0.0;      ///< Radius of a circle as large as the hole.
  std::vector<PixelPatch> body{};   ///< Pixels that show the black body, away from the hole's rim.
  std::vector<PixelPatch> plate{};  ///< Empty if the black body fills the image.

  bool fills_image() const { return plate.empty(); }
};

/// Pixels nearer than this to the rim of the hole are neither the black body's nor the plate's: the
/// lens blurs it. Pixels.
inline constexpr double kRimMargin_px = 6.0;
/// The plate has to differ from the black body by so much, kelvin.
inline constexpr double kMinContrast_k = 10.0;
/// A black body that fills the image may be uneven by so much: kelvin, and a fraction of its °C
/// (thesis fig. 5.5 shows gradients towards the corners).
inline constexpr double kMaxUneven_k = 2.0, kMaxUnevenFraction = 0.02;

/// Finds the hole, which is the hottest part of the image or, before a black body whose temperature
/// is nearer to that of the coldest, the coldest one. Refuses images in which a hole is too small,
/// is not the only thing of its kind or has pixels without a value; the message says what to do.
Result<ApertureImage> FindAperture(Image<float> celsius, double body_celsius);

/// The mean of a patch.
double MeanOf(const PixelPatch& patch, const Image<float>& image);
/// The mean of patches' means.
double MeanOf(const std::vector<PixelPatch>& patches, const Image<float>& image);

}  // namespace isotherm
