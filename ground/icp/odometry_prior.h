#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/geometry/map_pose.h"
#include "ground/icp/icp_tracker.h"
#include "ground/icp/odometry_stream.h"
#include "ground/icp/prior_error.h"

namespace isotherm {

/// Holds what the odometry poses did for depth frames.
struct OdometryPriorCounts {
  std::uint64_t used = 0;          ///< Frames that started from them.
  std::uint64_t missing = 0;       ///< No pose for the frame's time, but some before it.
  std::uint64_t contradicted = 0;  ///< The tracker measured another motion.
  std::uint64_t distrusted = 0;    ///< Not used for want of trust since.
};

/// The motion of the rig as a source sees it, for as long as it agrees with what the
/// tracker measures in observed directions.
///
///   trusted    --(one frame contradicts)----------> distrusted
///   distrusted --(kFramesToTrust frames agree)----> trusted
///
/// Only motions between two frames matter, so the source's reference frame may be any.
/// Thread-compatible.
class OdometryPrior {
 public:
  explicit OdometryPrior(const ExternalOdometryOptions& options);

  void Add(const ExternalOdometry& sample) { stream_.Add(sample); }

  /// Holds a pose and how wrong it may be.
  struct Prediction {
    RigidTransform T_map_depth;
    PriorError error;
    bool has_position = false;  ///< The source told it; else the translation is inertial.
  };
  /// Predicts where the depth camera is at `time` if it moved from `last`, the newest tracked pose,
  /// as the source says. `inertial` and its error stand in for what the source does not measure.
  std::optional<Prediction> Predict(const StampedMapPose& last, CaptureTime time,
                                    const RigidTransform& inertial,
                                    const PriorError& inertial_error);

  /// The frame at `time` moved otherwise than the source says, by more than the errors of both
  /// along the directions that the frame observed. `known` is the pose's covariance before it.
  bool Contradicts(const TrackingResult& result, CaptureTime time, const Matrix6& known) const;
  /// After each tracked frame. `used`: it started from the newest prediction.
  void Note(const TrackingResult& result, CaptureTime time, const Matrix6& known, bool used);
  /// The motion since the frame before is unknown: tracking was lost.
  void Reset();
  /// To other coordinates: what was tracked becomes T_new_old * pose.
  void Transform(const RigidTransform& T_new_old);

  const OdometryStream& stream() const { return stream_; }
  const OdometryPriorCounts& counts() const { return counts_; }

 private:
  /// Holds the source's pose of a frame that was tracked.
  struct Used {
    CaptureTime time;
    OdometryStream::Estimate estimate;
  };
  void NoteMissing();
  void NoteTrust(bool agrees, bool compared);

  const ExternalOdometryOptions options_;
  OdometryStream stream_;
  OdometryPriorCounts counts_;
  std::optional<Used> used_;       ///< The newest frame that started from the source.
  std::optional<Used> predicted_;  ///< The newest prediction.
  /// Frames tracked since the set of observed directions changed, oldest first: what the newest is
  /// compared with, so that slow contradictions add up.
  std::deque<StampedMapPose> anchors_;
  int unobservable_axes_ = 0;  ///< How many the anchors' frames have.
  bool trusted_ = true;
  int agreeing_ = 0;
  int missing_in_a_row_ = 0;
};

}  // namespace isotherm
