#pragma once

#include <deque>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/scan/scan_model.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/camera_motion.h"
#include "ground/thermal/line_of_sight_occlusion.h"
#include "ground/thermal/measurement_conditions.h"
#include "ground/thermal/near_range_occlusion.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/thermal_rectifier.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {

/// Says which vertices of the depth camera's view are not given a temperature.
enum class ParallaxFilter {
  kNone,
  kAlgorithm4,  ///< Vertices behind another one that falls on the same thermal pixel.
};

/// Rules beside the parallax filter that the pipeline has and the thesis has not: margin of edges,
/// smear, steep temperatures, near-range holes, lines of sight, no temperature for bad conditions.
/// Not the review, which needs the records of the pipeline's own fusion.
struct OtherRules {
  CameraMotion motion;                        ///< Motion of the thermal camera.
  const NearRangeOcclusion& near_range;       ///< Aimed from where the thermal camera was.
  const LineOfSightOcclusion& line_of_sight;  ///< The same.
};

/// A valid thermal frame and where both cameras were.
struct ThesisFrame {
  const ThermalFrame& frame;
  const RigidTransform& T_map_thermal;
  const RigidTransform& T_map_depth;
  const OtherRules* rules = nullptr;  ///< nullptr = only the thesis's own.
};

/// The thesis's own assignment of temperatures, literally and slowly, to compare with: the model is
/// cast from the depth camera's pose, filtered (algorithm 4) and each voxel takes the temperature
/// of its vertex (algorithms 5 and 6). Thread-compatible.
class ThesisFuser {
 public:
  /// Voxels lighter than `min_weight` do not count as observed.
  ThesisFuser(const ThermalOptions& options, const Rig& rig, float min_weight,
              ParallaxFilter filter);

  void Fuse(const ThesisFrame& posed, const TsdfVolume& tsdf, ThreadPool& pool,
            ThermalVolume& thermal);

  const CameraModel& ideal_camera() const { return rectifier_.ideal_camera(); }

 private:
  /// A vertex of the depth camera's view and what is measured there.
  struct Vertex {
    Eigen::Vector3f p_map = Eigen::Vector3f::Zero();
    float celsius = 0.0F;  ///< NaN = gets no temperature.
    ConditionClass distance = ConditionClass::kBad;
    ConditionClass angle = ConditionClass::kBad;
  };
  void FindVertices(const RigidTransform& T_map_thermal, ThreadPool& pool, const OtherRules* rules);
  Vertex Measure(const Eigen::Vector3f& p_map, const Eigen::Vector3f& n_map,
                 const RigidTransform& T_map_thermal, const OtherRules* rules) const;
  /// Asks the rules that leave out whole pixels of the thermal image (pixels_).
  void FindAssignablePixels(const OtherRules& rules);
  bool IsLeftOut(const Eigen::Vector3d& p_thermal, const Eigen::Vector2i& pixel,
                 const OtherRules& rules) const;
  void UpdateBlock(std::int32_t block, const RigidTransform& T_depth_map, const TsdfVolume& tsdf,
                   ThermalVolume& thermal) const;

  const ThermalOptions options_;
  const ThermalSensorModel sensor_;
  const ConditionLimits limits_;
  const CameraModel depth_camera_;
  const float min_weight_;
  const ParallaxFilter filter_;
  ThermalRectifier rectifier_;
  Raycaster raycaster_;
  SurfaceMaps maps_;
  Image<float> celsius_;              ///< The rectified thermal image.
  Image<float> nearest_m_;            ///< Per thermal pixel, distance of the nearest vertex.
  std::vector<ThermalPixel> pixels_;  ///< Per thermal pixel, with OtherRules.
  Image<Vertex> vertices_;            ///< Per depth pixel.
};

/// Follows a pipeline: gives the same thermal frames, at the same poses, to a thesis fuser with a
/// thermal volume of its own. Thread-compatible.
class ThesisFusion {
 public:
  /// Says which rules assign temperatures beside the parallax filter.
  enum class Rules {
    kOfTheThesis,
    kAlsoOurOthers,  ///< OtherRules.
  };
  ThesisFusion(const GroundOptions& options, const Rig& rig, const ScanModel& model,
               ParallaxFilter filter, Rules rules = Rules::kOfTheThesis);

  void AddThermal(ThermalFramePtr frame) { waiting_.push_back(std::move(frame)); }
  /// After the pipeline has processed a depth frame that measured `depth_m` (0 = no return).
  void AfterDepth(const Image<float>& depth_m, ThreadPool& pool);

  const ThermalVolume& thermal() const { return thermal_; }

 private:
  const Rig rig_;
  const ScanModel model_;
  const Rules rules_;
  ThesisFuser fuser_;
  NearRangeOcclusion near_range_;
  LineOfSightOcclusion line_of_sight_;
  ThermalVolume thermal_;
  std::deque<ThermalFramePtr> waiting_;
};

}  // namespace isotherm
