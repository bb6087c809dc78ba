#pragma once

#include <cstdint>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/camera_motion.h"
#include "ground/thermal/line_of_sight_occlusion.h"
#include "ground/thermal/measurement_conditions.h"
#include "ground/thermal/measurement_recorder.h"
#include "ground/thermal/near_range_occlusion.h"
#include "ground/thermal/nuc_epochs.h"
#include "ground/thermal/temperature_review.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/thermal_rectifier.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/thermal/uncertainty_budget.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_volume.h"
#include "ground/tsdf/visible_blocks.h"

namespace isotherm {

/// Holds what one thermal frame did to the model.
struct FusionReport {
  std::int64_t considered = 0;  ///< Voxels on the surface that both cameras see.
  // Thermal pixels that were not assigned.
  std::int64_t occluded = 0;      ///< Too near the edge of something nearer.
  std::int64_t smeared = 0;       ///< By motion.
  std::int64_t steep = 0;         ///< Where the temperature changes too fast from pixel to pixel.
  std::int64_t maybe_hidden = 0;  ///< By something that the depth camera does not see.
  std::int64_t assigned = 0;      ///< Voxels.
  std::int64_t dropped = 0;       ///< Voxels whose temperature did not stand a review.

  FusionReport& operator+=(const FusionReport& other);
};

/// Holds what is known about a thermal frame beside its image and pose.
struct CaptureConditions {
  CameraMotion motion;           ///< Motion of the thermal camera.
  double registration_px = 0.0;  ///< Standard deviation of the pose in its image.
  double extrinsic_px = 0.0;     ///< The same of the calibration between the cameras.
  double time_sigma_s = 0.0;     ///< One sigma of the capture time.
  CameraUncertainty camera;
  const NearRangeOcclusion* near_range = nullptr;  ///< Where something unseen may be in the way.
  const LineOfSightOcclusion* line_of_sight =
      nullptr;  ///< Space that the depth camera sees through.
  NucAge nuc;
  /// All that was ever scanned is in the model already: surface that the depth camera does not see
  /// at the time takes temperatures, too.
  bool surface_is_finished = false;
};

/// A valid thermal frame and where both cameras were.
struct PosedThermalFrame {
  const ThermalFrame& frame;
  const RigidTransform& T_map_thermal;  ///< When the frame was captured.
  const CameraModel& depth_camera;
  const RigidTransform& T_map_depth;  ///< At about the same time.
};

/// Assigns temperatures to the surface that both cameras see (algorithms 4 to 6). What the thermal
/// camera sees is decided by casting the model from its own pose, so that whatever was scanned
/// hides what lies behind it, whether or not the depth camera sees it now (beyond algorithm 4).
/// Keeps scratch images. Thread-compatible.
class ThermalFuser {
 public:
  /// Voxels lighter than `min_weight` do not count as observed.
  ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera,
               const ThermalSensorModel& sensor, float min_weight);

  /// The frame must be valid and have the camera's size (CHECK).
  FusionReport Fuse(const PosedThermalFrame& posed, const CaptureConditions& capture,
                    const TsdfVolume& tsdf, ThreadPool& pool, ThermalVolume& thermal);

  /// The final review of all temperatures (TemperatureReview), once at the end: it also drops those
  /// beside steep faces, which the reviews of what is in view in Fuse do not. Returns how many were
  /// dropped.
  std::int64_t FinalReview(const TsdfVolume& tsdf, ThermalVolume& thermal, ThreadPool& pool) const;

  /// Blocks that the last Fuse may have changed.
  const std::vector<std::int32_t>& fused_blocks() const { return blocks_; }
  const CameraModel& ideal_camera() const { return rectifier_.ideal_camera(); }

 private:
  /// Casts what the thermal camera sees of the model, into surface_ and distances_m_.
  void CastSurface(const RigidTransform& T_map_thermal, const TsdfVolume& tsdf, ThreadPool& pool);
  PixelRowArgs RowArgs(const PosedThermalFrame& posed, const CaptureConditions& capture) const;
  SigmaArgs UncertaintyArgs(const CaptureConditions& capture, double voxel_m) const;
  void MakePixels(const PixelRowArgs& args, const CaptureConditions& capture, ThreadPool& pool,
                  FusionReport& report);
  FusionKernelArgs BlockArgs(const RigidTransform& T_thermal_map, const TsdfVolume& tsdf) const;
  void SelectBlocks(const RigidTransform& T_map_thermal, const TsdfVolume& tsdf);

  const ThermalOptions options_;
  const ThermalSensorModel sensor_;
  const ConditionLimits limits_;
  const TemperatureReview review_;
  const float min_weight_;
  const int apron_;  ///< Pixels around distances_m_ and celsius_.
  const ReadingCorrections corrections_;
  ThermalRectifier rectifier_;
  Raycaster raycaster_{RaycastPrecision::kVisibility};
  SurfaceMaps coarse_;                ///< Every second pixel each way.
  SurfaceMaps surface_;               ///< The model as the thermal camera sees it, in `map`.
  Image<float> distances_m_;          ///< Distances of its vertices from the camera, with an apron.
  Image<float> celsius_;              ///< With an apron.
  std::vector<ThermalPixel> pixels_;  ///< And one more that shows nothing.
  std::vector<std::int32_t> planes_;  ///< Planes of the pixels (PixelPlane).
  Image<float> nearest_m_, farthest_m_;  ///< Depth of the surface per tile; farthest 0 = none.
  VisibleBlocks visible_;
  std::vector<std::int32_t> blocks_;
  std::uint32_t frames_ = 0;
};

}  // namespace isotherm
