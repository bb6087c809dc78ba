#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <optional>
#include <stop_token>

#include "common/base/mutex.h"
#include "ground/service/session_item.h"

namespace isotherm {

/// The way to the disk, which may be slow or stuck: the producer waits for a bounded time, once,
/// and memory is bounded by items and by bytes. Thread-safe.
class RecordingQueue {
 public:
  /// Bounds the queue by whichever is reached first.
  struct Limits {
    std::size_t items = 1;
    std::size_t bytes = 1;
  };
  explicit RecordingQueue(const Limits& limits) : limits_(limits) {}

  /// Returns false if there is no room for `item` after `patience`. A queue from which nothing was
  /// taken while somebody waited is not waited for again before something is.
  bool Offer(SessionItem item, std::chrono::nanoseconds patience, const std::stop_token& stop);
  /// Takes what is rare and must not be lost, beginnings and ends of sessions, in any case.
  void Push(SessionItem item);

  /// Says what a wait ended with.
  enum class Outcome { kItem, kTimeout, kEnd };
  /// Waits for an item up to `timeout`. kEnd: stop was requested and nothing is left.
  Outcome Pop(std::chrono::nanoseconds timeout, const std::stop_token& stop,
              std::optional<SessionItem>& item);

 private:
  bool HasRoom(std::size_t bytes) const REQUIRES(mutex_);
  void Add(SessionItem item, std::size_t bytes) REQUIRES(mutex_);

  const Limits limits_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  /// With their size in bytes.
  std::deque<std::pair<SessionItem, std::size_t>> items_ GUARDED_BY(mutex_);
  std::size_t bytes_ GUARDED_BY(mutex_) = 0;
  /// Something was taken since a writer last gave up waiting.
  bool moved_ GUARDED_BY(mutex_) = true;
};

}  // namespace isotherm
