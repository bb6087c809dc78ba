#include "edge/publisher/publisher_options.h"

#include <fmt/format.h>

#include "common/transport/qos.h"

namespace isotherm {

Status Validate(const PublisherOptions& options) {
  if (options.edge_id.empty() || options.edge_id.size() > kMaxIdBytes) {
    return InvalidArgument(fmt::format("edge_id must have 1 to {} bytes", kMaxIdBytes));
  }
  if (options.flow_window_frames < 1 || options.flow_window_frames > kMaxFlowWindowFrames) {
    return InvalidArgument(fmt::format("flow_window_frames = {} is outside 1..{}",
                                       options.flow_window_frames, kMaxFlowWindowFrames));
  }
  if (options.flow_timeout <= Nanoseconds(0)) {
    return InvalidArgument("flow_timeout must be positive");
  }
  return OkStatus();
}

}  // namespace isotherm
