#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "ground/subscriber/session_counters.h"
#include "ground/subscriber/stream_tally.h"

namespace isotherm {

/// Brings together what the edge says it published and what arrived, and decides when a session is
/// closed:
///   - the edge ended the session and everything has arrived, or
///   - the edge ended it (or began another) and nothing has arrived for the grace time: the rest is
///   missing.
/// Pure. Thread-compatible.
class SessionTracker {
 public:
  explicit SessionTracker(Nanoseconds grace) : grace_(grace) {}

  /// Returns the marks that are new.
  std::vector<ScanMark> OnStatus(const EdgeStatus& status, SteadyTime now);
  /// Takes what is known of the rig's clock; it goes into the counters of its session, if that was
  /// seen.
  void SetClock(const SessionClock& clock);
  /// A good frame of `session` has arrived.
  void OnFrame(std::uint64_t session, SteadyTime now);

  /// The last sessions that were seen, the newest last.
  std::vector<std::uint64_t> sessions() const;
  /// The session that was seen last; nullopt before the first.
  std::optional<std::uint64_t> newest() const;
  SessionCounters Counters(const StreamTally& depth, const StreamTally& thermal) const;

  /// The oldest session that is not closed; the caller looks up its tallies for TryClose. nullopt
  /// if none.
  std::optional<std::uint64_t> oldest_open() const;
  /// Closes the oldest open session if it is time; returns its final counters.
  std::optional<SessionCounters> TryClose(const StreamTally& depth, const StreamTally& thermal,
                                          SteadyTime now);
  /// Returns when the grace time of the oldest open session ends, if it is running.
  std::optional<SteadyTime> deadline() const;

 private:
  /// Holds the newest that the edge said about a session.
  struct Entry {
    std::uint64_t session = 0;
    StreamStatus depth{};
    StreamStatus thermal{};
    FeedbackLatency feedback{};
    std::uint64_t most_lacking = 0;
    std::vector<ScanMark> marks{};
    std::optional<SessionClock> clock{};
    bool ended = false;
    bool closed = false;
    SteadyTime last_activity{};
  };

  Entry* Find(std::uint64_t session);
  const Entry* Find(std::uint64_t session) const;
  Entry& Touch(std::uint64_t session, SteadyTime now);

  const Nanoseconds grace_;
  std::deque<Entry> entries_;  ///< Oldest first; at most kMaxEntries.
};

}  // namespace isotherm
