#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "common/concurrency/latest_value.h"
#include "common/messages/messages.h"
#include "ground/service/recording_tracker.h"

namespace isotherm {

/// Work that a live scan has left out to keep up.
struct BehindCounts {
  bool now = false;  ///< It is behind at this moment.
  std::uint64_t thermal_frames = 0;
  std::uint64_t depth_frames = 0;  ///< Tracked, but not integrated.
};

/// Holds what the service's threads know of the running scan, for the operator and for each other.
/// Thread-safe.
struct ScanBoard {
  LatestValue<Feedback> feedback;
  LatestValue<EdgeStatus> edge;
  LatestValue<BehindCounts> behind;
  LatestValue<std::shared_ptr<RecordingTracker>> recording;
  /// The part of an earlier process's recording that is in the model, 0..1, while that grows.
  LatestValue<double> rebuilt_fraction;
  /// Says what of the calibration has moved, by the last scan that was checked; empty = nothing.
  LatestValue<std::string> calibration;
  /// The results of the model so far would take this much.
  std::atomic<std::uint64_t> result_bytes{0};
  std::atomic<int> scans_being_written{0};  ///< Ended ones whose results are not there yet.
  std::atomic<int> scans_given_up{0};       ///< Ended ones whose results found no place to wait.
};

}  // namespace isotherm
