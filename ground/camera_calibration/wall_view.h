#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"

namespace isotherm {

/// Holds a patch of a depth image of a wall.
struct WallPatch {
  float x, y;           ///< Direction, as depth camera coordinates at z = 1.
  float across, down;   ///< Where it lies, in fractions of the image.
  float inverse_depth;  ///< Mean, 1/m.
  float weight;         ///< Fraction of its pixels that have a depth.

  Eigen::Vector3d Ray() const { return {x, y, 1.0}; }
  double Distance_m() const { return 1.0 / inverse_depth; }
};

/// An image of a wall.
struct WallView {
  double time_s = 0.0;
  std::vector<WallPatch> patches;
};

/// Patches that are farther than this from a plane do not belong to it, as a fraction of the
/// distance: what swells does.
inline constexpr double kMaxOffWall = 0.05;

/// The patches on the plane that most of them lie on; nullopt if the image does not show a wall in
/// most of it. `depth_m`: as measured, in the camera's size; 0 or NaN = no return.
std::optional<WallView> SeeWall(const CameraModel& depth_camera, double time_s,
                                const Image<float>& depth_m);

/// Weight of what is off by `residual`: Tukey's biweight, 0 from `cut` on.
double Biweight(double residual, double cut);

/// The plane on which most patches lie, as its inverse depth, which is linear in the direction; and
/// how far off each patch is: a fraction of the distance.
struct WallFit {
  Eigen::Vector3d plane;
  std::vector<double> off;
};

/// `inverse_depths` replace those of the patches. What is off by more than `cut` does not count.
WallFit FitWall(const WallView& view, std::span<const double> inverse_depths, double cut);

}  // namespace isotherm
