#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/feedback/model_coverage.h"
#include "ground/feedback/reach.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_fuser.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {

/// Describes a view that is worth taking.
struct NextView {
  RigidTransform T_map_depth;
  double gain_m2 = 0.0;  ///< Surface that it would measure well and that is not measured well yet.
};

/// Finds the next best view: the pose from which the most surface would be measured well that is
/// not measured well yet. Candidates look at lacking surface from a good distance, along its normal
/// and at an angle. What each would see is found by casting the model coarsely from there. A few
/// candidates are tried per step; the best so far is tried again each time, as the model grows.
/// Thread-compatible.
class ViewPlanner {
 public:
  /// `rig` must have a thermal camera and its pose (CHECK). Voxels lighter than `min_weight` do not
  /// count as observed.
  ViewPlanner(const FeedbackOptions& options, const ThermalOptions& limits, const Rig& rig,
              float min_weight);

  /// Tries some candidates. `T_map_depth` is where the rig is: views are turned as it is held. A
  /// view that the rig has reached without any gain is not proposed again, nor is one that it did
  /// not go to in 150 steps (there may be no way). Only steps with `is_measuring` count: the rig is
  /// tracked, and temperatures are taken.
  void Step(const TsdfVolume& tsdf, const ThermalVolume& thermal, const ModelCoverage& coverage,
            const RigidTransform& T_map_depth, bool is_measuring, ThreadPool& pool);

  const std::optional<NextView>& best() const { return best_; }

  /// Returns the surface of the model for which no view was found that would measure it well,
  /// square metres.
  double OutOfReach(const ModelCoverage& coverage) const { return reach_.OutOfReach(coverage); }

  /// Returns the surface that a view would measure well and that is not measured well yet, square
  /// metres; 0 where a camera would be inside or too close to something, or the depth camera would
  /// see too little to follow.
  double Gain(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
              const ThermalVolume& thermal, ThreadPool& pool);

 private:
  struct Candidate {
    RigidTransform T_map_depth;
    std::uint64_t cell;  ///< The LackingSurface that it looks at.
  };

  void MakeCandidates(const ModelCoverage& coverage, const RigidTransform& T_map_depth);
  /// Returns a pose that looks at `target` from the direction `towards_camera` (unit).
  RigidTransform LookAt(const Eigen::Vector3d& target, const Eigen::Vector3d& towards_camera,
                        const RigidTransform& T_map_depth) const;
  bool IsDepthInView(const Eigen::Vector3d& p_depth) const;
  void NotePose(const RigidTransform& T_map_depth);
  bool IsExhausted(const RigidTransform& T_map_depth) const;

  const FeedbackOptions options_;
  const ConditionLimits limits_;
  const double angle_min_rad_, angle_good_rad_;
  const float min_weight_;
  const double min_depth_m_;  ///< The depth camera measures nothing closer.
  const CameraModel depth_camera_;
  const CameraModel thermal_camera_;  ///< The camera of the coarse cast.
  const RigidTransform T_thermal_depth_;
  Raycaster raycaster_{RaycastPrecision::kVisibility};
  SurfaceMaps maps_;
  std::deque<Candidate> candidates_;
  Reach reach_;
  std::optional<NextView> best_;
  int steps_at_best_ = 0;                 ///< How long the rig has been there,
  int steps_proposed_ = 0;                ///< ... and how long it has been proposed.
  std::deque<RigidTransform> exhausted_;  ///< Views that gave nothing, or that nobody took.
};

}  // namespace isotherm
