#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

#include "common/time/time_types.h"
#include "ground/pipeline/load_shedding.h"

namespace isotherm {

/// Keeps when the load shedding of a scan changed. Load shedding may go up and down with each
/// frame, so the highest level of each period counts. Times are from the begin of the scan.
/// Thread-compatible.
class LoadSheddingHistory {
 public:
  /// Longer: fewer changes, and the time of each is less exact. Not tuned.
  static constexpr Nanoseconds kPeriod = std::chrono::milliseconds(500);
  /// The newest changes are kept, so that an hour's scan does not fill stats.json with them.
  static constexpr std::size_t kMaxChanges = 500;

  struct Change {
    Nanoseconds since;  ///< The begin of the first period at this level.
    LoadShedding level;
    friend bool operator==(const Change&, const Change&) = default;
  };

  /// Adds the level of one frame. `time` must not decrease between calls.
  void Add(Nanoseconds time, LoadShedding level);

  /// Returns the first level and those that it changed to, oldest first; empty without a frame. The
  /// last one holds until last().
  std::deque<Change> Changes() const;
  /// Returns the time of the newest frame.
  Nanoseconds last() const { return last_; }

 private:
  /// Takes the open period over into the changes.
  void Close();

  std::optional<Change> open_;  ///< The period of the newest frame.
  std::deque<Change> changes_;
  Nanoseconds last_{};
};

}  // namespace isotherm
