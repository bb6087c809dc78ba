#include "ground/subscriber/session_book.h"

#include <algorithm>
#include <numeric>

namespace isotherm {
namespace {

constexpr std::size_t kMaxEntries = 8;

/// `published` is what the edge said, `final` whether it is its last word. Until then holes may be
/// frames that are still on their way or that the edge dropped itself: they count as missing.
StreamAccount MakeAccount(const StreamTally& tally, std::uint64_t published, bool final) {
  StreamAccount account;
  account.received = tally.received;
  account.published = std::max(published, final ? tally.received : tally.next);
  account.missing = account.published - account.received;
  account.late = tally.late;
  account.duplicates = tally.duplicates;
  account.refused_by_cause = tally.refused;
  account.refused = std::accumulate(tally.refused.begin(), tally.refused.end(), std::uint64_t{0});
  return account;
}

}  // namespace

const SessionBook::Entry* SessionBook::Find(std::uint64_t session) const {
  const auto entry = std::ranges::find(entries_, session, &Entry::session);
  return entry == entries_.end() ? nullptr : &*entry;
}

SessionBook::Entry* SessionBook::Find(std::uint64_t session) {
  return const_cast<Entry*>(std::as_const(*this).Find(session));
}

SessionBook::Entry& SessionBook::Touch(std::uint64_t session, SteadyTime now) {
  if (Entry* entry = Find(session)) {
    entry->last_activity = now;
    return *entry;
  }
  if (entries_.size() == kMaxEntries) entries_.pop_front();
  entries_.push_back({.session = session, .last_activity = now});
  return entries_.back();
}

void SessionBook::OnFrame(std::uint64_t session, SteadyTime now) { Touch(session, now); }

void SessionBook::OnStatus(const EdgeStatus& status, SteadyTime now) {
  if (status.scan_state == ScanState::kIdle) return;
  const Entry* known = Find(status.session);
  if (known != nullptr && known->ended) return;  // Its last word was said; repeats are no activity.
  Entry& entry = Touch(status.session, now);
  entry.depth_published = status.depth.published;
  entry.thermal_published = status.thermal.published;
  entry.feedback = status.feedback;
  entry.ended = status.scan_state == ScanState::kEnded;
}

void SessionBook::SetClock(const ClockAccount& clock) {
  if (Entry* entry = Find(clock.session)) entry->clock = clock;
}

std::vector<std::uint64_t> SessionBook::sessions() const {
  std::vector<std::uint64_t> sessions;
  for (const Entry& entry : entries_) sessions.push_back(entry.session);
  return sessions;
}

std::optional<std::uint64_t> SessionBook::newest() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.back().session;
}

SessionAccount SessionBook::Account(const StreamTally& depth, const StreamTally& thermal) const {
  SessionAccount account;
  account.session = depth.session;
  const Entry* entry = Find(depth.session);
  const Entry unknown;
  if (entry == nullptr) entry = &unknown;
  account.ended = entry->ended;
  account.closed = entry->closed;
  account.feedback = entry->feedback;
  account.clock = entry->clock;
  account.depth = MakeAccount(depth, entry->depth_published, entry->ended);
  account.thermal = MakeAccount(thermal, entry->thermal_published, entry->ended);
  return account;
}

std::optional<std::uint64_t> SessionBook::oldest_open() const {
  const auto entry = std::ranges::find(entries_, false, &Entry::closed);
  if (entry == entries_.end()) return std::nullopt;
  return entry->session;
}

std::optional<SteadyTime> SessionBook::deadline() const {
  const auto entry = std::ranges::find(entries_, false, &Entry::closed);
  if (entry == entries_.end()) return std::nullopt;
  const bool superseded = &*entry != &entries_.back();
  if (!entry->ended && !superseded) return std::nullopt;
  return entry->last_activity + grace_;
}

std::optional<SessionAccount> SessionBook::TryClose(const StreamTally& depth,
                                                    const StreamTally& thermal, SteadyTime now) {
  Entry* entry = Find(depth.session);
  if (entry == nullptr || entry->closed) return std::nullopt;
  const SessionAccount account = Account(depth, thermal);
  const bool complete = entry->ended && account.depth.missing == 0 && account.thermal.missing == 0;
  const auto given_up_at = deadline();
  if (!complete && (!given_up_at || now < *given_up_at)) return std::nullopt;
  entry->closed = true;
  return Account(depth, thermal);
}

}  // namespace isotherm
