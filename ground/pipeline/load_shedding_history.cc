#include "ground/pipeline/load_shedding_history.h"

#include <algorithm>

namespace isotherm {

void LoadSheddingHistory::Add(Nanoseconds time, LoadShedding level) {
  last_ = time;
  const Nanoseconds period = time - time % kPeriod;
  if (open_ && open_->since == period) {
    open_->level = std::max(open_->level, level);
    return;
  }
  Close();
  open_ = Change{period, level};
}

std::deque<LoadSheddingHistory::Change> LoadSheddingHistory::Changes() const {
  LoadSheddingHistory history = *this;
  history.Close();
  return history.changes_;
}

void LoadSheddingHistory::Close() {
  if (!open_ || (!changes_.empty() && changes_.back().level == open_->level)) return;
  changes_.push_back(*open_);
  if (changes_.size() > kMaxChanges) changes_.pop_front();
}

}  // namespace isotherm
