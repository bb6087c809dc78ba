#pragma once

#include "common/base/service.h"
#include "common/time/clock.h"
#include "common/transport/transport_environment.h"

namespace isotherm {

class EdgeOptions;

/// Puts the edge together from validated options and runs it until `signal` (or the end of the
/// source, if so configured). The process's exit status.
int RunEdge(const EdgeOptions& options, const TransportEnvironment& environment, const Clock& clock,
            const StopSignal& signal);

}  // namespace isotherm
