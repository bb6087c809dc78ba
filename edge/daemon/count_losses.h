#pragma once

#include "edge/frame_counters/frame_counters.h"
#include "edge/source/supervised_source.h"

namespace isotherm {

/// Has what `camera` loses counted in `counters`, which must outlive it: frames that the edge did
/// not take in time were captured; those that the camera or its library lost were not.
void CountLosses(SupervisedSource& camera, FrameCounters& counters);

}  // namespace isotherm
