#pragma once

#include "common/geometry/map_pose.h"
#include "ground/tracker/icp_tracker.h"

namespace isotherm {

/// What became of a depth frame.
struct DepthReport {
  bool tracked = false;
  bool unconfirmed = false;  ///< Has a pose that is not believed yet; counts as not tracked.
  bool repeated = false;  ///< The same image as before: it says nothing new, and nothing was done.
  bool integrated = false;
  TrackingResult
      tracking;  ///< In the coordinates of the sub-map that the frame was tracked against.
  MapPose pose;  ///< If tracked: in the sub-map that is active after the frame.
};

}  // namespace isotherm
