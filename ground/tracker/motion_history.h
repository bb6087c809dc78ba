#pragma once

#include <deque>
#include <optional>

#include "common/geometry/stamped_pose.h"

namespace isotherm {

/// The rig's motion over the last tracked frames, and where it goes on. Thread-compatible.
class MotionHistory {
 public:
  void Add(const StampedPose& pose);
  /// After a lost frame: the motion is not known any more.
  void Clear() { poses_.clear(); }
  /// To other coordinates: every pose becomes T_new_old * pose.
  void Transform(const RigidTransform& T_new_old) {
    for (StampedPose& pose : poses_) pose.T_world_depth = T_new_old * pose.T_world_depth;
  }

  /// The newest pose; nullopt after Clear.
  std::optional<StampedPose> last() const;
  /// The one before; nullopt if fewer than two were tracked since the last Clear.
  std::optional<StampedPose> before_last() const;

  /// The pose at `time` if the velocity between the last two poses goes on; nullopt if that is not
  /// known or `time` is too far away.
  std::optional<RigidTransform> Predict(CaptureTime time) const;
  /// The same with the mean velocity over the last poses: slower to follow, with less of the
  /// tracker's noise. For motions that cannot be measured.
  std::optional<RigidTransform> PredictSmoothly(CaptureTime time) const;

 private:
  std::optional<RigidTransform> Extrapolate(const StampedPose& from, CaptureTime time) const;

  std::deque<StampedPose> poses_;
};

}  // namespace isotherm
