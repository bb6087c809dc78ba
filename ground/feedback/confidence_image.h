#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ground/renderer/rgb.h"
#include "ground/renderer/view_maps.h"

namespace isotherm {

/// Shows how well what is in view has been measured: green good, yellow acceptable, red bad, blue
/// never, dark where there is no surface; darker where the surface turns away. With `lost` there is
/// a red frame around it: the view is the last one that was tracked.
RgbImage DrawConfidence(const ViewMaps& view, bool lost);

/// Returns `image` as a PNG of at most `max_bytes`: it is halved in both directions as often as
/// that takes. Returns nothing if not even a few pixels fit, or if the image is empty.
std::vector<std::uint8_t> EncodeWithin(RgbImage image, std::size_t max_bytes);

}  // namespace isotherm
