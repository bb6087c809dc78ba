#pragma once

#include "common/frame/image.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

/// Holds a depth image and how vertices and normals are made of it.
struct SurfaceMapArgs {
  const Image<float>* depth_m;
  float fx, fy, cx, cy;
  int reach;       ///< Normals come from differences over +-reach pixels.
  float max_step;  ///< Neighbours further apart than this times the depth belong to other surfaces.
  float noise_at_1m;  ///< Uneven steps below this (metres, grows with depth squared) are no edge.
};

/// Vertices and normals of row `y` in camera coordinates; NaN where there is no normal.
void SurfaceMapRow(const SurfaceMapArgs& args, int y, SurfaceMaps& maps);

}  // namespace isotherm
