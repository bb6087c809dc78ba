#include "ground/console/console_inbox.h"

#include <utility>

#include "common/base/log.h"

namespace isotherm {

std::unique_ptr<BlockBatch> ConsoleInbox::TakeEmpty() {
  const MutexLock lock(mutex_);
  if (!empty_.empty()) {
    std::unique_ptr<BlockBatch> batch = std::move(empty_.back());
    empty_.pop_back();
    return batch;
  }
  if (made_ == kBatches) return nullptr;
  ++made_;
  return std::make_unique<BlockBatch>();
}

void ConsoleInbox::GiveBack(std::unique_ptr<BlockBatch> batch, bool is_filled) {
  const MutexLock lock(mutex_);
  (is_filled ? filled_ : empty_).push_back(std::move(batch));
  if (!is_filled) return;
  is_changed_ = true;
  changed_.notify_all();
}

void ConsoleInbox::Add(ConsoleEvent event) {
  const MutexLock lock(mutex_);
  if (events_.size() == kMaxEvents) {
    if (dropped_events_++ == 0) {
      LOG(Ground, Warning) << "the console is behind and leaves out what it was to show, events="
                           << kMaxEvents << ": the scan is not touched";
    }
    return;
  }
  events_.push_back(std::move(event));
  is_changed_ = true;
  changed_.notify_all();
}

void ConsoleInbox::SetDepth(DepthFramePtr frame) {
  const MutexLock lock(mutex_);
  depth_ = std::move(frame);
}

void ConsoleInbox::SetThermal(ThermalFramePtr frame) {
  const MutexLock lock(mutex_);
  thermal_ = std::move(frame);
}

void ConsoleInbox::Wait(Nanoseconds patience, const std::stop_token& stop) {
  MutexLock lock(mutex_);
  changed_.wait_for(lock, stop, patience, [this]() REQUIRES(mutex_) { return is_changed_; });
  is_changed_ = false;
}

std::unique_ptr<BlockBatch> ConsoleInbox::TakeFilled() {
  const MutexLock lock(mutex_);
  if (filled_.empty()) return nullptr;
  std::unique_ptr<BlockBatch> batch = std::move(filled_.front());
  filled_.erase(filled_.begin());
  return batch;
}

std::vector<ConsoleEvent> ConsoleInbox::TakeEvents() {
  const MutexLock lock(mutex_);
  return std::exchange(events_, {});
}

DepthFramePtr ConsoleInbox::TakeDepth() {
  const MutexLock lock(mutex_);
  return std::exchange(depth_, nullptr);
}

ThermalFramePtr ConsoleInbox::TakeThermal() {
  const MutexLock lock(mutex_);
  return std::exchange(thermal_, nullptr);
}

}  // namespace isotherm
