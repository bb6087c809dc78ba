#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "common/base/check.h"
#include "common/base/mutex.h"

namespace isotherm {

/// Says what Push does when the queue is full.
enum class OverflowPolicy {
  kDropOldest,  ///< Live data: the newest counts. Drops are counted.
  kBlock,       ///< Recordings: nothing may be lost; the producer waits.
};

/// Joins two threads with bounded memory. Thread-safe.
template <typename T>
class BoundedQueue {
 public:
  /// `on_drop` is called for each value that makes room for a newer one, with the queue locked: it
  /// may count, no more.
  BoundedQueue(std::size_t capacity, OverflowPolicy policy,
               std::function<void(const T&)> on_drop = nullptr)
      : capacity_(capacity), policy_(policy), on_drop_(std::move(on_drop)) {
    CHECK(capacity > 0);
  }

  /// Returns false if `value` was not taken because stop was requested while waiting for room.
  bool Push(T value, std::stop_token stop) {
    MutexLock lock(mutex_);
    if (policy_ == OverflowPolicy::kBlock) {
      if (!changed_.wait(lock, stop,
                         [this]() REQUIRES(mutex_) { return values_.size() < capacity_; }))
        return false;
    } else if (values_.size() == capacity_) {
      if (on_drop_) on_drop_(values_.front());
      values_.pop_front();
      ++dropped_;
    }
    values_.push_back(std::move(value));
    changed_.notify_all();
    return true;
  }

  /// Waits for a value. Returns nullopt if stop was requested and nothing is left.
  std::optional<T> Pop(std::stop_token stop) {
    MutexLock lock(mutex_);
    if (!changed_.wait(lock, stop, [this]() REQUIRES(mutex_) { return !values_.empty(); }))
      return std::nullopt;
    T value = std::move(values_.front());
    values_.pop_front();
    changed_.notify_all();
    return value;
  }

  /// As Pop, but waits no longer than `patience`: nullopt after that, too. For consumers that have
  /// something to do when nothing comes.
  template <typename Duration>
  std::optional<T> PopFor(Duration patience, std::stop_token stop) {
    MutexLock lock(mutex_);
    if (!changed_.wait_for(lock, stop, patience,
                           [this]() REQUIRES(mutex_) { return !values_.empty(); }))
      return std::nullopt;
    T value = std::move(values_.front());
    values_.pop_front();
    changed_.notify_all();
    return value;
  }

  std::size_t size() const {
    MutexLock lock(mutex_);
    return values_.size();
  }
  /// Values that made room for newer ones since construction.
  std::uint64_t dropped() const {
    MutexLock lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t capacity_;
  const OverflowPolicy policy_;
  const std::function<void(const T&)> on_drop_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<T> values_ GUARDED_BY(mutex_);
  std::uint64_t dropped_ GUARDED_BY(mutex_) = 0;
};

}  // namespace isotherm
