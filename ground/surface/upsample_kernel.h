#pragma once

#include "ground/surface/surface_maps.h"

namespace isotherm {

/// Holds a cast at half size and how it is interpolated.
struct UpsampleRowArgs {
  const SurfaceMaps* coarse;   ///< Pixel (i, j) is pixel (2 i, 2 j) of the fine maps: at least
                               ///< width / 2 + 1 wide and height / 2 + 1 high.
  float max_plane_distance_m;  ///< Between vertices of one surface and each other's tangent planes.
  float position[3];           ///< Position of the camera in `map`, for distances only.
};
/// Fills row `y` of `fine` from a cast at half size: between pixels on one surface it is
/// interpolated, between others (edges of occluders, of the model) there is none. `distance_m` gets
/// the distances of the row's vertices from the camera; where there is none, that of the nearest
/// vertex around in `coarse`, a huge one without any. Null = not wanted.
void UpsampleRow(const UpsampleRowArgs& args, int y, SurfaceMaps& fine, float* distance_m);

}  // namespace isotherm
