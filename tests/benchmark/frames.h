#pragma once

#include <vector>

#include "common/frame/frame.h"
#include "common/geometry/camera.h"

namespace isotherm {

/// The first frames of the simulated furnace door scan, always the same.
struct BenchmarkFrames {
  Rig rig;
  std::vector<DepthFrame> depth;
  std::vector<ThermalFrame> thermal;
};

/// Rendered once per process.
const BenchmarkFrames& FurnaceDoorFrames();

}  // namespace isotherm
