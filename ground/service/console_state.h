#pragma once

#include "ground/console/live.pb.h"
#include "ground/service/status_reporter.h"

namespace isotherm {

/// Fills in what the console shows of the link, the rig and the disks.
void DescribeSituation(const GroundSituation& situation, live::State& state);

}  // namespace isotherm
