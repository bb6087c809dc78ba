#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/ray_caster.h"

namespace isotherm {

class SimulatedDepthOptions;

/// A structured-light depth camera (PrimeSense Carmine): noise and quantisation in disparity, so
/// that both grow with the square of the distance; no return at grazing angles, beside depth edges,
/// in the projector's shadow and out of range; depths between both surfaces at some edges, rows
/// read one after the other. The projector is to the right of the camera. Thread-safe (immutable);
/// scratch memory is the caller's.
class DepthSensor {
 public:
  DepthSensor(const CameraModel& camera, const SimulatedDepthOptions& options);

  /// Keeps buffers from one image to the next.
  struct Scratch {
    HitImage hits;
    Image<float> white;        ///< Independent noise.
    Image<float> rows;         ///< The noise, smoothed along rows.
    std::vector<float> noise;  ///< One row of the noise, smoothed along rows and columns.
    std::vector<std::int32_t> raw;
    Image<std::uint8_t> lit;  ///< 1 = the projector reaches it.
  };

  /// One image, `depth_scale` units per metre, 0 = no return. The same `noise_stream` gives the
  /// same noise.
  Image<std::uint16_t> Render(const Scene& scene, const RigidTransform& T_world_depth,
                              std::uint64_t noise_stream, Scratch& scratch) const;

  /// T_world_depth this many seconds after the capture time, which is that of the middle row.
  using PoseAfter = std::function<RigidTransform(double seconds)>;
  /// The same by a camera that moves, whose distances are too long by the factor `stretch`.
  Image<std::uint16_t> RenderMoving(const Scene& scene, const PoseAfter& T_world_depth,
                                    double stretch, std::uint64_t noise_stream,
                                    Scratch& scratch) const;

 private:
  void FindShadow(const HitImage& hits, Image<std::uint8_t>& lit) const;
  bool IsDropped(const HitImage& hits, const CameraView& view, int x, int y,
                 std::uint64_t drop_stream) const;
  /// Raw values of row `y` of true depths with scratch.noise, 0 = out of range, into scratch.raw.
  void MeasureRow(int y, float stretch, Scratch& scratch) const;

  const RayGrid grid_;
  const float disparity_metres_px_;  ///< Focal length x baseline: disparity = this / depth.
  const float step_px_;
  const float sigma_px_;
  const float min_depth_m_;
  const float max_depth_m_;
  const float grazing_start_cos_;
  const float grazing_end_cos_;
  const float edge_dropout_;
  const float depth_scale_;
  const double flying_fraction_;
  const double readout_s_;
  Image<float> swelling_;  ///< Distances are too long by these factors.
};

}  // namespace isotherm
