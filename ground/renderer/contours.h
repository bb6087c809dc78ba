#pragma once

#include <cstdint>

#include "common/frame/image.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

class ThreadPool;

/// Holds what isotherms are drawn from: temperatures that vary continuously along the surface. For
/// lines only; numbers and colours come from the voxels themselves.
struct ContourField {
  static constexpr std::uint8_t kRight = 1;
  static constexpr std::uint8_t kBelow = 2;

  Image<float> celsius;        ///< height x width, row-major; NaN = no temperature.
  Image<std::uint8_t> joined;  ///< kRight, kBelow: that neighbour lies on the same surface.
};

/// Interpolates between voxels (trilinear, measured ones only), then smooths by a line fitted to
/// the temperatures of the same surface around each pixel, weighted with a Gaussian of
/// `smoothing_px` (0 = not): a constant gradient stays what it is, up to the edges. `maps` in
/// `world`. Rows in parallel; the result does not depend on the number of threads.
ContourField SampleContours(const SurfaceMaps& maps, const TsdfVolume& tsdf,
                            const ThermalVolume& thermal, double smoothing_px, ThreadPool& threads);

/// Fraction of each pixel that a line `width_px` wide at `celsius` covers, 0..1. The line's place
/// between pixel centres is interpolated (marching squares); there is none between surfaces that
/// are not joined.
Image<float> IsothermCover(const ContourField& field, double celsius, double width_px);

}  // namespace isotherm
