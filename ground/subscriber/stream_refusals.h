#pragma once

#include "common/transport/refusal.h"
#include "ground/subscriber/rig_gate.h"

namespace isotherm {

/// Counts the samples that the ground refuses: all of them, and those of each stream of frames.
/// Each counter is thread-safe.
struct StreamRefusals {
  RefusalCounter all;
  RefusalCounter depth{&all};
  RefusalCounter thermal{&all};

  /// Enters a whole sample that the gate did not let through.
  void Add(const RigSample& sample, RefusalCause cause);
};

}  // namespace isotherm
