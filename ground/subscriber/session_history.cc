#include "ground/subscriber/session_history.h"

#include <algorithm>

namespace isotherm {

void SessionHistory::Keep(SessionCounters counters, bool newest, std::uint64_t refused_samples) {
  const auto kept = std::ranges::find(kept_, counters.session, &SessionCounters::session);
  counters.refused_samples =
      newest || kept == kept_.end() ? refused_samples : kept->refused_samples;
  if (kept != kept_.end()) {
    *kept = counters;
    return;
  }
  if (kept_.size() == kMaxSessions) kept_.pop_front();
  kept_.push_back(counters);
}

SessionCounters SessionHistory::Get(std::uint64_t session) const {
  const auto kept = std::ranges::find(kept_, session, &SessionCounters::session);
  if (kept != kept_.end()) return *kept;
  SessionCounters unknown;
  unknown.session = session;
  return unknown;
}

}  // namespace isotherm
