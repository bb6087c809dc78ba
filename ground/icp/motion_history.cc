#include "ground/icp/motion_history.h"

#include <algorithm>

namespace isotherm {
namespace {

// The smooth prediction takes its velocity over eight intervals, a quarter of a second at 30 Hz.
// More: it lags behind a rig that changes its pace; fewer: it has the noise of single poses, which
// unobservable directions then drift by. Not tuned.
constexpr std::size_t kPoses = 9;

/// One missing frame; beyond that velocity says little.
constexpr double kMaxFramesAhead = 2.0;

}  // namespace

void MotionHistory::Add(const StampedMapPose& pose) {
  poses_.push_back(pose);
  if (poses_.size() > kPoses) poses_.pop_front();
}

std::optional<StampedMapPose> MotionHistory::last() const {
  return poses_.empty() ? std::nullopt : std::optional(poses_.back());
}

std::optional<StampedMapPose> MotionHistory::before_last() const {
  return poses_.size() < 2 ? std::nullopt : std::optional(poses_[poses_.size() - 2]);
}

std::optional<StampedMapPose> MotionHistory::third_last() const {
  return poses_.size() < 3 ? std::nullopt : std::optional(poses_[poses_.size() - 3]);
}

std::optional<RigidTransform> MotionHistory::Predict(CaptureTime time) const {
  return poses_.size() < 2 ? std::nullopt : Extrapolate(*before_last(), time);
}

std::optional<RigidTransform> MotionHistory::PredictSmoothly(CaptureTime time) const {
  return poses_.size() < 2 ? std::nullopt : Extrapolate(poses_.front(), time);
}

std::optional<RigidTransform> MotionHistory::Extrapolate(const StampedMapPose& from,
                                                         CaptureTime time) const {
  const StampedMapPose& to = poses_.back();
  const double span_s = ToSeconds(to.time - from.time);
  const double ahead_s = ToSeconds(time - to.time);
  const double frame_s = ToSeconds(to.time - before_last()->time);
  if (!(span_s > 0.0 && ahead_s >= 0.0 && ahead_s <= kMaxFramesAhead * frame_s))
    return std::nullopt;
  // The motion over the span, in the rig's own coordinates, goes on from the newest pose.
  const double fraction = ahead_s / span_s;
  const RigidTransform motion = from.T_map_depth.inverse() * to.T_map_depth;
  return to.T_map_depth * Interpolate(RigidTransform::Identity(), motion, fraction);
}

}  // namespace isotherm
