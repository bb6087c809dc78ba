#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/radiometry/radiometry.h"
#include "common/simulation/radiance_view.h"
#include "common/simulation/ray_caster.h"
#include "common/simulation/scene.h"

namespace isotherm {

class SimulatedThermalOptions;

/// Makes each pixel the mean radiance of many rays instead of that of the one through its middle.
/// They are spread over the pixel's area, over the aperture of a thin lens and over the time that
/// the detector remembers. Those of one pixel meet at the focus distance, so that what is nearer or
/// farther is blurred (thesis eq. 2.20) and what is near hides only a part of what is behind it.
/// Their ages have the distribution of an exponential answer, moved so that their mean is 0. Only
/// pixels from which a ray may meet something uneven in the image through a pinhole take the time:
/// a part that no ray through the middle of a pixel meets stays unseen. Thread-safe (immutable);
/// scratch memory is the caller's.
class PixelAverage {
 public:
  PixelAverage(const CameraModel& camera, const SimulatedThermalOptions& options);

  /// T_world_camera when these rows are read, `age_s` earlier (negative: later).
  using PoseOfRows = std::function<RigidTransform(int first_row, double age_s)>;

  /// Keeps buffers from one image to the next.
  struct Scratch {
    Image<std::uint8_t> uneven;  ///< 1 = the radiance is no plane there.
    Image<int> uneven_sums;
    Image<int> reach;  ///< How far from a pixel its rays may meet; one value per tile.
    std::vector<Eigen::Vector2i> pixels;  ///< The pixels that take many rays, in a few rows.
    std::vector<Eigen::Vector2f> rays;
    std::vector<RayHit> hits;
    std::vector<double> sums;
  };

  /// Returns whether there is only the ray through the middle.
  bool IsSingleRay() const { return rays_.size() == 1; }
  /// Diameter of a point's image at depth `z_m`, pixels: eq. (2.20) solved for the circle. `z_m`
  /// may be infinite.
  double BlurDiameterPx(double z_m) const;

  /// Holds what the rays meet, and where they start.
  struct Exposure {
    const Scene& scene;
    const RayGrid& grid;
    const BandRadiance& band;
    const EmissivityTables& emissivity;
    const PoseOfRows& T_world_camera;
    int strip_rows;  ///< Poses are asked for once per so many rows, a multiple of kTileHeight.
  };

  /// Changes `radiance`, which is that of the middles of the pixels; `hits` is what they met.
  void Apply(const Exposure& exposure, const HitImage& hits, Image<float>& radiance,
             Scratch& scratch) const;

 private:
  /// Holds one of the rays whose mean is a pixel: it samples the pixel's area, the lens and the
  /// detector's time constant at once.
  struct Ray {
    Eigen::Vector2f pixel_offset;  ///< From the pixel's middle, pixels.
    Eigen::Vector2d lens_m;        ///< Where it passes the lens, from its middle.
    double age_s;
  };
  /// Returns the ages of as many rays, youngest first.
  static std::vector<double> Ages(double time_constant_s, int count);
  /// Fills scratch.reach. Returns the largest.
  int FindReach(const RayGrid& grid, const PoseOfRows& T_world_camera, const HitImage& hits,
                Scratch& scratch) const;
  /// Fills scratch.pixels with those of some rows, neighbours together.
  static void FindPixels(int first_row, int end_row, Scratch& scratch);
  Eigen::Vector2f RayThrough(const RayGrid& grid, const Eigen::Vector2i& pixel,
                             const Ray& ray) const;

  const double focal_length_px_;
  const double aperture_m_;  ///< Diameter; 0 = pinhole.
  const double focus_m_;
  const double negligible_;  ///< Radiance.
  std::vector<Ray> rays_;
  double youngest_s_ = 0.0, oldest_s_ = 0.0;  ///< Ages of the youngest and the oldest ray.
};

}  // namespace isotherm
