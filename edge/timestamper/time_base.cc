#include "edge/timestamper/time_base.h"

#include "edge/options/edge_options.pb.h"

namespace isotherm {

TimeBase TimeBaseOf(const SourceOptions& options) {
  if (options.kind() == CAMERAS) return TimeBase::kWallClock;
  if (options.rate() != 1.0) return TimeBase::kOther;
  return options.expert().rebase() ? TimeBase::kWallClock : TimeBase::kShifted;
}

}  // namespace isotherm
