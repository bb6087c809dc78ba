#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/messages/messages.h"
#include "common/transport/refusal.h"
#include "ground/subscriber/clock_comparison.h"

namespace isotherm {

/// published = received + missing, always. `received` are distinct frames that were good; late ones
/// included. Samples that arrived = received + duplicates + refused.
struct StreamCounters {
  std::uint64_t published =
      0;  ///< As the edge says; while it has not said it yet, what can be inferred.
  std::uint64_t received = 0;
  /// Part of received: they did not come now, an earlier process of the ground has recorded them.
  std::uint64_t recorded_before = 0;
  std::uint64_t missing = 0;
  std::uint64_t late = 0;        ///< Received behind the reorder window.
  std::uint64_t duplicates = 0;  ///< Further copies, dropped.
  /// Samples that were not used; the numbers that only they had stay missing.
  std::uint64_t refused = 0;
  RefusalCounts refused_by_cause{};
  /// Frames that the rig says it did not publish, as of its newest status.
  std::uint64_t captured_by_rig = 0;
  std::vector<DropCount> dropped_by_rig{};
};

/// The rig's wall clock in a session: what the rig says of it, and how it compares with ours.
struct SessionClock {
  std::uint64_t session = 0;
  ClockReport rig;              ///< As of the newest status.
  CaptureTime time{};           ///< Time of that status, by the rig's clock.
  bool unsynchronised = false;  ///< At some time in the session.
  CameraReport depth_camera;    ///< As of the newest status: stamps and their uncertainty.
  CameraReport thermal_camera;
  std::optional<ClockOffset> offset;  ///< The newest that is known.
  /// The most that both clocks have differed by for certain; NaN = never compared.
  double largest_offset_s = std::numeric_limits<double>::quiet_NaN();
  bool alarm = false;  ///< They differ by more than is allowed, for certain.
  std::uint64_t alarms = 0;
};

/// A moment of a session that somebody had marked.
struct SessionMark {
  std::uint64_t session = 0;
  ScanMark mark;
};

/// Counts what a session delivered, for results and the console.
struct SessionCounters {
  std::uint64_t session = 0;
  bool ended = false;   ///< The edge has sent its final counts.
  bool closed = false;  ///< The edge has, and everything has arrived or was given up.
  StreamCounters depth;
  StreamCounters thermal;
  /// The most recorded frames that the ground lacked at once, as the rig knew.
  std::uint64_t most_lacking = 0;
  std::uint64_t refused_samples = 0;  ///< Samples of all topics, since this process runs.
  FeedbackLatency feedback;           ///< As the edge measured it.
  std::vector<ScanMark> marks{};      ///< Moments that somebody had marked, in that order.
  std::optional<SessionClock> clock;  ///< nullopt before the first status.
};

}  // namespace isotherm
