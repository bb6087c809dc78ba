#include "ground/subscriber/subscriber_options.h"

#include <fmt/format.h>

#include "common/messages/messages.h"

namespace isotherm {
namespace {

/// A missing frame holds up the whole line for this long: what comes later is better given up. Not
/// tuned.
constexpr Nanoseconds kMaxReorderWindow = std::chrono::milliseconds(200);

}  // namespace

Status Validate(const SubscriberOptions& options) {
  if (options.edge_id.size() > kMaxIdBytes) {
    return InvalidArgument(fmt::format("edge_id must have at most {} bytes", kMaxIdBytes));
  }
  if (options.ground_id.empty() || options.ground_id.size() > kMaxIdBytes) {
    return InvalidArgument(fmt::format("ground_id must have 1 to {} bytes", kMaxIdBytes));
  }
  if (options.reorder_window < Nanoseconds(0) || options.reorder_window > kMaxReorderWindow) {
    return InvalidArgument(fmt::format("reorder_window = {} s is outside 0..{}",
                                       ToSeconds(options.reorder_window),
                                       ToSeconds(kMaxReorderWindow)));
  }
  if (options.max_clock_offset < Nanoseconds(0)) {
    return InvalidArgument("max_clock_offset must not be negative");
  }
  if (options.receipt_interval <= Nanoseconds(0) || options.end_grace < Nanoseconds(0)) {
    return InvalidArgument("receipt_interval must be positive and end_grace not negative");
  }
  return OkStatus();
}

}  // namespace isotherm
