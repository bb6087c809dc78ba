#include "ground/subscriber/session_tracker.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace isotherm {
namespace {

/// Sessions that are followed at once: the present one, the one before until it is closed, and
/// edges that were started again in between.
constexpr std::size_t kMaxEntries = 8;
/// Marks of a session; whoever sends more has no operator.
constexpr std::size_t kMaxKeptMarks = 100;

/// `rig` is what the edge said, `final` whether it is its last word. Until then holes may be
/// frames that are still on their way or that the edge dropped itself: they count as missing.
StreamCounters MakeCounters(const StreamTally& tally, const StreamStatus& rig, bool final) {
  StreamCounters counters;
  counters.received = tally.received;
  counters.recorded_before = tally.recorded_before;
  counters.published = std::max(rig.published, final ? tally.received : tally.next);
  counters.missing = counters.published - counters.received;
  counters.late = tally.late;
  counters.duplicates = tally.duplicates;
  counters.refused_by_cause = tally.refused;
  counters.refused = std::accumulate(tally.refused.begin(), tally.refused.end(), std::uint64_t{0});
  counters.captured_by_rig = rig.captured;
  std::ranges::copy_if(rig.dropped, std::back_inserter(counters.dropped_by_rig),
                       [](const DropCount& drop) { return drop.frames > 0; });
  return counters;
}

}  // namespace

const SessionTracker::Entry* SessionTracker::Find(std::uint64_t session) const {
  const auto entry = std::ranges::find(entries_, session, &Entry::session);
  return entry == entries_.end() ? nullptr : &*entry;
}

SessionTracker::Entry* SessionTracker::Find(std::uint64_t session) {
  return const_cast<Entry*>(std::as_const(*this).Find(session));
}

SessionTracker::Entry& SessionTracker::Touch(std::uint64_t session, SteadyTime now) {
  if (Entry* entry = Find(session)) {
    entry->last_activity = now;
    return *entry;
  }
  if (entries_.size() == kMaxEntries) entries_.pop_front();
  entries_.push_back({.session = session, .last_activity = now});
  return entries_.back();
}

void SessionTracker::OnFrame(std::uint64_t session, SteadyTime now) { Touch(session, now); }

std::vector<ScanMark> SessionTracker::OnStatus(const EdgeStatus& status, SteadyTime now) {
  if (status.scan_state == ScanState::kIdle) return {};
  const Entry* known = Find(status.session);
  if (known != nullptr && known->ended)
    return {};  // Its last word was said; repeats are no activity.
  Entry& entry = Touch(status.session, now);
  entry.depth = status.depth;
  entry.thermal = status.thermal;
  entry.feedback = status.feedback;
  entry.most_lacking = std::max(entry.most_lacking, status.spool_frames);
  entry.ended = status.scan_state == ScanState::kEnded;
  // Each status has the newest ones only, and a rig that was started again has none of before.
  std::vector<ScanMark> fresh;
  for (const ScanMark& mark : status.marks) {
    const bool is_known = std::ranges::find(entry.marks, mark) != entry.marks.end();
    if (is_known || entry.marks.size() == kMaxKeptMarks) continue;
    entry.marks.push_back(mark);
    fresh.push_back(mark);
  }
  return fresh;
}

void SessionTracker::SetClock(const SessionClock& clock) {
  if (Entry* entry = Find(clock.session)) entry->clock = clock;
}

std::vector<std::uint64_t> SessionTracker::sessions() const {
  std::vector<std::uint64_t> sessions;
  for (const Entry& entry : entries_) sessions.push_back(entry.session);
  return sessions;
}

std::optional<std::uint64_t> SessionTracker::newest() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.back().session;
}

SessionCounters SessionTracker::Counters(const StreamTally& depth,
                                         const StreamTally& thermal) const {
  SessionCounters counters;
  counters.session = depth.session;
  const Entry* entry = Find(depth.session);
  const Entry unknown;
  if (entry == nullptr) entry = &unknown;
  counters.ended = entry->ended;
  counters.closed = entry->closed;
  counters.feedback = entry->feedback;
  counters.most_lacking = entry->most_lacking;
  counters.marks = entry->marks;
  counters.clock = entry->clock;
  counters.depth = MakeCounters(depth, entry->depth, entry->ended);
  counters.thermal = MakeCounters(thermal, entry->thermal, entry->ended);
  return counters;
}

std::optional<std::uint64_t> SessionTracker::oldest_open() const {
  const auto entry = std::ranges::find(entries_, false, &Entry::closed);
  if (entry == entries_.end()) return std::nullopt;
  return entry->session;
}

std::optional<SteadyTime> SessionTracker::deadline() const {
  const auto entry = std::ranges::find(entries_, false, &Entry::closed);
  if (entry == entries_.end()) return std::nullopt;
  // An edge that was killed never says that its session has ended; the next session says it.
  const bool superseded = &*entry != &entries_.back();
  if (!entry->ended && !superseded) return std::nullopt;
  return entry->last_activity + grace_;
}

std::optional<SessionCounters> SessionTracker::TryClose(const StreamTally& depth,
                                                        const StreamTally& thermal,
                                                        SteadyTime now) {
  Entry* entry = Find(depth.session);
  if (entry == nullptr || entry->closed) return std::nullopt;
  const SessionCounters counters = Counters(depth, thermal);
  const bool complete =
      entry->ended && counters.depth.missing == 0 && counters.thermal.missing == 0;
  const auto given_up_at = deadline();
  if (!complete && (!given_up_at || now < *given_up_at)) return std::nullopt;
  entry->closed = true;
  return Counters(depth, thermal);
}

}  // namespace isotherm
