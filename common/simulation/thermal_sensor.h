#pragma once

#include <cstdint>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/radiometry/radiometry.h"
#include "common/simulation/ray_caster.h"

namespace isotherm {

class ThermalCameraOptions;

/// A long-wave camera: band radiance of what each pixel sees with directional emissivity and
/// reflected surroundings (thesis eq. 3.1, B.2), optical blur, noise that is constant in radiance,
/// and conversion to the apparent (black-body) temperature. Thread-safe (immutable); scratch memory
/// is the caller's.
class ThermalSensor {
 public:
  ThermalSensor(const CameraModel& camera, const ThermalCameraOptions& options);

  struct Scratch {
    HitImage hits;
    Image<float> radiance;
    Image<float> rows;
  };

  /// One picture in centi-kelvin. The same `noise_stream` gives the same noise.
  Image<std::uint16_t> Render(const Scene& scene, const RigidTransform& T_world_thermal,
                              std::uint64_t noise_stream, Scratch& scratch) const;
  /// The inside of the closed shutter.
  Image<std::uint16_t> RenderShutter(double shutter_celsius, std::uint64_t noise_stream,
                                     Scratch& scratch) const;

  const BandRadiance& band() const { return band_; }

 private:
  /// Emissivity over the cosine of the emission angle.
  using EmissivityTable = std::vector<float>;
  static EmissivityTable MakeTable(const Material& material);
  static double LookUp(const EmissivityTable& table, float cosine);

  void FillRadiance(const Scene& scene, const RigidTransform& T_world_thermal,
                    Scratch& scratch) const;
  double MirrorRadiance(const Scene& scene, const RigidTransform& T_world_thermal,
                        const Eigen::Vector2f& ray, double emissivity) const;
  void Blur(Scratch& scratch) const;
  Image<std::uint16_t> Detect(std::uint64_t noise_stream, const Scratch& scratch) const;

  const RayGrid grid_;
  const BandRadiance band_;
  const double noise_radiance_;
  std::vector<float> blur_weights_;  ///< From the centre outwards; one weight = sharp.
};

}  // namespace isotherm
