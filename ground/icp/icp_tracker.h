#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/icp/observability.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/surface_maps.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

class ThermalAlignment;

/// Says why a frame could not be tracked, in the order of the names, as in stats.json.
enum class LostReason : std::uint8_t {
  kNone,
  kNotFound,       ///< Lost before, and nothing convincing since.
  kOutsideVolume,  ///< The first frame shows nothing of the scan volume.
  kResidual,
  kSingular,
  kStep,
  kTooFewInliers,
  kTooFewPixels,
  kCount
};
/// "not_found", as in stats.json.
std::string_view ToString(LostReason reason);

/// Holds what the model looks like from a pose: the tracker's reference. Maps in `map`.
struct ModelView {
  SurfaceMaps maps;
  CameraModel camera;  ///< The camera of the maps; may be smaller than the depth image.
  RigidTransform T_map_depth;
  bool is_young = false;  ///< Little more than one frame's noise: its normals are rough.
};

/// Tells how far a frame's pose can be trusted.
enum class TrackingQuality : std::uint8_t {
  kTracked,
  kDegraded,  ///< Not all directions are observed: the rest is held by the motion before.
  kLost,      ///< No pose.
};

/// Depth at which an observation has weight 1, metres; the weight falls with its fourth power.
inline constexpr float kIcpReferenceDepth = 0.5F;

/// Frames with fewer pixels that have a depth are lost.
inline constexpr int kMinTrackedPixels = 1000;

/// Holds a frame's pose and the figures that say how well it was measured.
struct TrackingResult {
  LostReason lost = LostReason::kNone;
  RigidTransform T_map_depth;  ///< The best estimate, meaningful only if not lost.
  double inlier_ratio = 0.0;   ///< Correspondences / valid pixels inside the volume, finest level.
  double overlap_ratio = 0.0;  ///< Pixels where the model has a surface / the same pixels.
  double agreement = 0.0;      ///< Correspondences / pixels where the model has a surface.
  double residual_m = 0.0;     ///< RMS point-to-plane distance of the inliers.
  double step_m = 0.0;         ///< Motion since the model view's pose.
  double step_rad = 0.0;
  int iterations = 0;
  Observability motion;  ///< Says which directions of the motion were measured.
  /// The covariance of T_map_depth as a twist (translation, rotation about the camera's position)
  /// in `map`, m and rad. It is of what this frame measured, so 0 along axes that are not observed
  /// (PoseUncertainty has the rest).
  Matrix6 covariance = Matrix6::Zero();

  bool tracked() const { return lost == LostReason::kNone; }
  TrackingQuality quality() const {
    if (!tracked()) return TrackingQuality::kLost;
    return motion.fully_observed() ? TrackingQuality::kTracked : TrackingQuality::kDegraded;
  }
};

/// Says which pixels correspond: a point and the model's surface must be this near and this
/// parallel.
struct IcpLimits {
  float max_distance_m;
  float min_normal_cosine;
};

/// Sums of one ICP iteration. H x = -g in the twist (translation, rotation) applied from the left
/// in `map`, about the camera's position.
struct IcpSums {
  Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
  double squared_residuals_m2 = 0.0;  ///< Unweighted.
  std::int64_t inliers = 0;
  std::int64_t candidates = 0;  ///< Valid pixels inside the volume.
  std::int64_t overlap = 0;     ///< Candidates behind which the model has a surface, near or not.

  double inlier_ratio() const { return Fraction(inliers, candidates); }
  double overlap_ratio() const { return Fraction(overlap, candidates); }
  double agreement() const { return Fraction(inliers, overlap); }
  /// Root mean square of the inliers' distances to the model's planes, metres.
  double residual_m() const {
    return std::sqrt(squared_residuals_m2 /
                     static_cast<double>(std::max<std::int64_t>(inliers, 1)));
  }
  IcpSums& operator+=(const IcpSums& other);

 private:
  static double Fraction(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  }
};

Status Validate(const TrackerOptions& options);

/// Pyramid ICP with projective data association and the point-to-plane metric (algorithm 1, line 9;
/// Newcombe et al., KinectFusion, 2011). Stateless between calls. Thread-compatible.
class IcpTracker {
 public:
  explicit IcpTracker(const TrackerOptions& options) : options_(options) {}

  /// Says where the search starts, and what holds the directions that the geometry cannot measure.
  struct Start {
    RigidTransform guess;
    RigidTransform prior;
    ThermalAlignment* alignment = nullptr;  ///< Goes before the prior where it observes something.
  };

  /// Finds T_map_depth of `depth` near the guess. Residuals are weighted by the sensor's depth
  /// noise (variance grows with the fourth power of the depth). In directions along which the view
  /// slides on itself (a plane, a cylinder), the pose is the thermal alignment's or else the
  /// prior's.
  TrackingResult Track(const PreparedDepth& depth, const ModelView& model, const VoxelGrid& grid,
                       const Start& start, ThreadPool& pool) const;

 private:
  IcpLimits Limits() const;
  /// Finds the directions that the geometry cannot measure (result.motion), and moves the pose
  /// along them from the guess to where the prior or the thermal alignment holds it.
  void HoldUnobservable(const PreparedDepth& depth, const ModelView& model, const Start& start,
                        TrackingResult& result) const;
  /// Improves the pose in the other directions, from coarse to fine; `result` is lost if they
  /// cannot be solved. Returns the sums of the last iteration.
  IcpSums Iterate(const PreparedDepth& depth, const ModelView& model, const VoxelGrid& grid,
                  ThreadPool& pool, TrackingResult& result) const;
  /// Returns whether a step is small enough to end with (min_update_m, min_update_deg).
  bool IsLastStep(const Vector6& twist) const;
  TrackingResult Assess(TrackingResult result, double min_inlier_ratio) const;

  const TrackerOptions options_;
};

/// The twist that takes `from` to `to`, both T_map_depth.
Vector6 TwistBetween(const RigidTransform& from, const RigidTransform& to);

/// Moves a pose by a twist in `map`: rotates about the camera's position, then translates.
void ApplyTwist(const Vector6& twist, RigidTransform& T_map_depth);

/// One pass over the current maps (camera coordinates): associates, rejects, accumulates.
IcpSums AccumulateIcp(const SurfaceMaps& current, const RigidTransform& T_map_depth,
                      const ModelView& model, const VoxelGrid& grid, const IcpLimits& limits,
                      ThreadPool& pool);

}  // namespace isotherm
