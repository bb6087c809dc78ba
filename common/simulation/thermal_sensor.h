#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/radiometry/radiometry.h"
#include "common/rig/sensor_models.h"
#include "common/simulation/pixel_average.h"
#include "common/simulation/radiance_view.h"
#include "common/simulation/ray_caster.h"

namespace isotherm {

class SimulatedThermalOptions;

/// A long-wave camera: band radiance of what each pixel sees, over its area and through a lens that
/// is focused at one distance, optical blur, the detector's inertia and the
/// reading of one row after the other (3.3.1), noise that is constant in radiance, and conversion
/// to the apparent (black-body) temperature. Thread-safe (immutable); scratch memory is the
/// caller's.
class ThermalSensor {
 public:
  ThermalSensor(const CameraModel& camera, const SimulatedThermalOptions& options);

  /// Keeps buffers from one image to the next.
  struct Scratch {
    HitImage hits;
    PixelAverage::Scratch average;
    Image<float> radiance;
    Image<float> rows;
    Image<float> celsius;
  };
  /// T_world_thermal this many seconds after the capture time.
  using PoseAfter = std::function<RigidTransform(double seconds)>;

  /// One image in counts of the scale that the options ask for (ScaleOf). The same `noise_stream`
  /// gives the same noise.
  Image<std::uint16_t> Render(const Scene& scene, const RigidTransform& T_world_thermal,
                              std::uint64_t noise_stream, Scratch& scratch) const;
  /// The same by a camera that moves. A pixel's answer to a change is 1 - exp(-t / time constant);
  /// the capture time is the mean time of the radiation that the middle row shows, so that a camera
  /// with constant speed sees an edge there where it was then, as a calibration of the constant
  /// delay finds it.
  Image<std::uint16_t> RenderMoving(const Scene& scene, const PoseAfter& T_world_thermal,
                                    std::uint64_t noise_stream, Scratch& scratch) const;
  /// The inside of the closed shutter.
  Image<std::uint16_t> RenderShutter(double shutter_celsius, std::uint64_t noise_stream,
                                     Scratch& scratch) const;

  const BandRadiance& band() const { return band_; }

 private:
  void FillRadiance(const RadianceView& view, int first_row, int end_row, Scratch& scratch) const;
  /// Computes what the detector answers, into scratch.radiance.
  void Expose(const Scene& scene, const PoseAfter& T_world_thermal, Scratch& scratch) const;
  /// Adds what each pixel gets of others, in temperature, to scratch.radiance.
  void AddInfluence(Scratch& scratch) const;
  Image<std::uint16_t> Detect(std::uint64_t noise_stream, Scratch& scratch) const;

  const RayGrid grid_;
  const PixelAverage average_;
  const BandRadiance band_;
  const RadiometricScale scale_;
  const double noise_radiance_;
  const double readout_s_;
  const double offset_error_k_, gain_error_;
  const SceneInfluence influence_;
  std::vector<float> blur_weights_;  ///< From the centre outwards; one weight = sharp.
};

}  // namespace isotherm
