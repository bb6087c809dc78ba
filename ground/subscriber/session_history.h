#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Keeps the newest counters of the last sessions, also of those that never ended. Bounded.
/// Thread-compatible.
class SessionHistory {
 public:
  /// The counters of a scan are read when its results are written, while later scans may already
  /// run. Not tuned.
  static constexpr std::size_t kMaxSessions = 8;

  /// Keeps `counters` in place of what was known of their session. Samples are refused before it is
  /// known whose they are: `refused_samples`, all so far, is entered for the `newest` session and
  /// for one that is not kept yet; others keep theirs.
  void Keep(SessionCounters counters, bool newest, std::uint64_t refused_samples);

  /// Returns the counters of `session`; only the number is set if it is not known.
  SessionCounters Get(std::uint64_t session) const;
  /// Returns the counters of the session that was seen last; all are 0 before the first.
  SessionCounters Newest() const { return kept_.empty() ? SessionCounters() : kept_.back(); }

 private:
  std::deque<SessionCounters> kept_;  ///< Oldest first; at most kMaxSessions.
};

}  // namespace isotherm
