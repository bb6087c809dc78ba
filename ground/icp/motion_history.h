#pragma once

#include <deque>
#include <optional>

#include "common/geometry/map_pose.h"

namespace isotherm {

/// The rig's motion over the last tracked frames, and where it goes on. Thread-compatible.
class MotionHistory {
 public:
  void Add(const StampedMapPose& pose);
  /// After a lost frame: the motion is not known any more.
  void Clear() { poses_.clear(); }
  /// To other coordinates: every pose becomes T_new_old * pose.
  void Transform(const RigidTransform& T_new_old) {
    for (StampedMapPose& pose : poses_) pose.T_map_depth = T_new_old * pose.T_map_depth;
  }

  /// The newest pose; nullopt after Clear.
  std::optional<StampedMapPose> last() const;
  /// The one before; nullopt if fewer than two were tracked since the last Clear.
  std::optional<StampedMapPose> before_last() const;
  /// The one before that; nullopt if fewer than three were.
  std::optional<StampedMapPose> third_last() const;

  /// The pose at `time` if the velocity between the last two poses goes on; nullopt if that is not
  /// known or `time` is too far away.
  std::optional<RigidTransform> Predict(CaptureTime time) const;
  /// The same with the mean velocity over the last poses: slower to follow, with less of the
  /// tracker's noise. For motions that cannot be measured.
  std::optional<RigidTransform> PredictSmoothly(CaptureTime time) const;

 private:
  std::optional<RigidTransform> Extrapolate(const StampedMapPose& from, CaptureTime time) const;

  std::deque<StampedMapPose> poses_;
};

}  // namespace isotherm
