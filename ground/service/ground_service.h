#pragma once

#include "common/time/clock.h"
#include "common/transport/transport_environment.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

class StopSignal;

/// Says whether the service is for one scan or for all that come.
struct ServiceMode {
  bool single_scan =
      false;  ///< Results go straight into live.output_dir; leave when the scan has ended.
};

/// The threaded driver:
///
///   Subscriber -+-> queue -> LiveScan (Assembler -> GroundPipeline) -> results, feedback
///    (receive)  |            reconstruction thread
///               +-> queue -> ScanRecorder
///                            recording thread
///
/// Runs until the signal (or, with single_scan, the end of the scan), then flushes everything.
/// Returns the process's exit status.
int RunGround(const GroundOptions& options, const ServiceMode& mode,
              const TransportEnvironment& environment, const Clock& clock, StopSignal& signal);

}  // namespace isotherm
