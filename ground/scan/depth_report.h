#pragma once

#include "common/geometry/map_pose.h"
#include "ground/icp/icp_tracker.h"

namespace isotherm {

/// Tells what became of a depth frame.
struct DepthReport {
  bool tracked = false;
  /// The frame has a pose that is not believed yet; it counts as not tracked.
  bool unconfirmed = false;
  /// The image is the one before it again, so nothing was done with it.
  bool repeated = false;
  bool integrated = false;
  /// The view does not hold the rig in all directions, and has not for so long that its pose is too
  /// uncertain for anything to be added to the model.
  bool slides = false;
  /// The poses are in the coordinates of the sub-map that the frame was tracked against.
  TrackingResult tracking;
  /// The pose of a tracked frame, in the sub-map that is active after it.
  MapPose pose;
};

}  // namespace isotherm
