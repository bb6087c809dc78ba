#pragma once

#include <cstdint>
#include <span>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_kernel.h"

namespace isotherm {

/// The near-range rule: something closer than the depth camera's near range gives no return, so it
/// is neither in the model nor in the depth image, but it makes a hole there. A hole is a square of
/// hole_px pixels in which the depth image has (almost) nothing, although the model has a surface
/// there, or although there are surfaces to the left and right or above and below. Thermal pixels
/// whose line of sight crosses the space before a hole, up to the near range, are left out. Small
/// holes (edges, dark spots) do not count, nor does an emptiness that reaches the image's border
/// on two sides, nor what can be the projector's shadow beside something near; so what comes near
/// there before a place never scanned is not noticed. Thread-compatible.
class NearRangeOcclusion {
 public:
  /// `thermal_camera` without distortion.
  NearRangeOcclusion(const ThermalOcclusionOptions& options, const DepthSensorModel& depth_sensor,
                     const CameraModel& thermal_camera);

  /// `depth_m`: the last depth image, 0 = no return. `model`: the model's surface at the same time
  /// from the same pose, seen by the depth camera at the same or a halved size.
  void Update(const Image<float>& depth_m, const SurfaceMaps& model,
              const CameraModel& model_camera);

  /// Sets the pose of the thermal camera when the frame to be assessed was captured, in the depth
  /// camera's frame of the last Update.
  void Aim(const RigidTransform& T_depth_thermal);

  /// Makes pixels of row `y` that are left out unassignable. Returns how many were assignable.
  std::int64_t LeaveOut(int y, std::span<ThermalPixel> row) const;

 private:
  /// Says what a square of the depth image shows.
  enum class Kind : std::uint8_t {
    kNeither,
    kSurface,
    kEmpty,  ///< No return, and nothing is known behind.
    kHole,
  };
  /// hole_px x hole_px pixels of the depth image.
  struct Square {
    Kind kind = Kind::kNeither;
    float depth_m = 0.0F;  ///< Depth of a surface; 0 for others.
    bool is_empty() const { return kind == Kind::kEmpty || kind == Kind::kHole; }
  };
  Square Look(int column, int row, const Image<float>& depth_m, const SurfaceMaps& model) const;
  /// Calls `assess(first, end, depth before, depth behind)` for each run of empty squares of a
  /// line.
  template <typename At, typename Assess>
  static void ForEmptyRuns(int count, const At& at, const Assess& assess);
  /// Runs no longer than the projector's shadow are no holes, others between surfaces are.
  void AssessRow(int row, double model_fx);
  void AssessColumn(int column);
  bool FindHoles(const Image<float>& depth_m, const SurfaceMaps& model, double model_fx);
  bool CrossesHole(const Eigen::Vector2d& xy_thermal) const;

  const double near_range_m_;
  const int hole_px_;
  const CameraModel thermal_camera_;
  RigidTransform T_depth_thermal_ = RigidTransform::Identity();
  CameraModel model_camera_;
  int hole_side_ = 0;             ///< Side of a square, pixels of the model's view.
  Image<Square> squares_;         ///< The squares of the model's view.
  Image<std::uint8_t> left_out_;  ///< Per tile of the thermal image.
  bool has_holes_ = false;
  bool any_ = false;  ///< Some thermal pixel is left out.
};

}  // namespace isotherm
