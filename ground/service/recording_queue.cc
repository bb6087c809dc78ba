#include "ground/service/recording_queue.h"

#include <utility>
#include <variant>

namespace isotherm {
namespace {

/// Returns what an item keeps in memory, but for what all have.
std::size_t Bytes(const SessionItem& item) {
  if (const auto* depth = std::get_if<ReceivedDepth>(&item))
    return depth->encoded->image.payload.size();
  if (const auto* thermal = std::get_if<ReceivedThermal>(&item))
    return thermal->encoded->image.payload.size();
  if (const auto* feedback = std::get_if<Feedback>(&item)) return feedback->image.size();
  return 0;
}

}  // namespace

bool RecordingQueue::HasRoom(std::size_t bytes) const {
  // One item always has room, however large.
  return items_.empty() || (items_.size() < limits_.items && bytes_ + bytes <= limits_.bytes);
}

void RecordingQueue::Add(SessionItem item, std::size_t bytes) {
  items_.emplace_back(std::move(item), bytes);
  bytes_ += bytes;
  changed_.notify_all();
}

bool RecordingQueue::Offer(SessionItem item, std::chrono::nanoseconds patience,
                           const std::stop_token& stop) {
  const std::size_t bytes = Bytes(item);
  MutexLock lock(mutex_);
  if (!HasRoom(bytes)) {
    if (!moved_ || patience.count() == 0) return false;
    if (!changed_.wait_for(lock, stop, patience,
                           [&]() REQUIRES(mutex_) { return HasRoom(bytes); })) {
      // Only the first frame waits for a disk that hangs. Those after it would each wait as long,
      // and the link would stall with them.
      moved_ = false;
      return false;
    }
  }
  Add(std::move(item), bytes);
  return true;
}

// Beginnings and ends of scans: without them the recording could not be closed.
void RecordingQueue::Push(SessionItem item) {
  const std::size_t bytes = Bytes(item);
  MutexLock lock(mutex_);
  Add(std::move(item), bytes);
}

RecordingQueue::Outcome RecordingQueue::Pop(std::chrono::nanoseconds timeout,
                                            const std::stop_token& stop,
                                            std::optional<SessionItem>& item) {
  MutexLock lock(mutex_);
  if (!changed_.wait_for(lock, stop, timeout,
                         [this]() REQUIRES(mutex_) { return !items_.empty(); }))
    return stop.stop_requested() ? Outcome::kEnd : Outcome::kTimeout;
  item = std::move(items_.front().first);
  bytes_ -= items_.front().second;
  items_.pop_front();
  moved_ = true;
  changed_.notify_all();
  return Outcome::kItem;
}

}  // namespace isotherm
