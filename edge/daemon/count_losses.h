#pragma once

#include "edge/frame/frame_account.h"
#include "edge/source/supervised_source.h"

namespace isotherm {

/// Has what `camera` loses counted in `account`, which must outlive it: frames that the edge did
/// not take in time were captured; those that the camera or its library lost were not.
void CountLosses(SupervisedSource& camera, FrameAccount& account);

}  // namespace isotherm
