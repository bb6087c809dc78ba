#pragma once

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/radiometry/radiometry.h"
#include "common/simulation/scene.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {

/// The thermal camera of the thesis's rig without lens distortion, so that what falls on a pixel
/// has a closed form.
CameraModel StillCamera();

/// A target at right angles to a camera at rest at the origin: a black plate at one temperature
/// whose front is at `distance_m`, and on it, flush, a black patch at another, around a point of
/// the plate.
struct FlatTarget {
  /// Names the shape of the warm patch.
  enum class Patch { kSquare, kDisc };
  double distance_m = 0.5;
  double plate_celsius = 23.0;
  Patch patch = Patch::kSquare;
  double patch_m = 0.004;  ///< Half an edge, or the radius.
  double patch_celsius = 50.0;
  Eigen::Vector2d patch_middle_m = Eigen::Vector2d::Zero();
};
Scene MakeFlatTarget(const FlatTarget& target);

/// Returns the camera's image of the scene, °C: the mean of forty images, as in the thesis (5.1).
Image<float> TakeStill(const Scene& scene, const SimulatedThermalOptions& options,
                       ThreadPool& pool);

/// The apparent temperature of a pixel that gets this fraction of its radiation from a black body
/// of the patch's temperature, and the rest from one of the plate's.
double MixedCelsius(const BandRadiance& band, const FlatTarget& target, double patch_fraction);

}  // namespace isotherm
