#pragma once

#include "common/frame/image.h"

namespace isotherm {

/// Vertex and normal maps (thesis 6.1.3) as six planes. Vertices in metres, unit normals towards
/// the camera; NaN in all planes = no surface at this pixel. The coordinate frame is said where the
/// maps are declared.
struct SurfaceMaps {
  Image<float> vx, vy, vz;
  Image<float> nx, ny, nz;

  int width() const { return vx.width(); }
  int height() const { return vx.height(); }
  void Resize(int width, int height) {
    for (Image<float>* plane : {&vx, &vy, &vz, &nx, &ny, &nz}) plane->Resize(width, height);
  }
};

}  // namespace isotherm
