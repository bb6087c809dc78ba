#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "common/base/mutex.h"

namespace isotherm {

/// Bounds the keys (rigs, ground stations) for which a reader keeps state: the middleware keeps
/// some for each key that it has met as long as the key's writer lives. A writer of ours writes
/// one; kPerWriter leaves room for a relay. Thread-safe.
class InstanceLimit {
 public:
  static constexpr std::size_t kPerWriter = 8;
  static constexpr std::size_t kInAll = 1024;

  /// Returns whether a sample of `writer` for the key `instance` may be kept.
  bool Admit(std::uint64_t writer, std::uint64_t instance) {
    MutexLock lock(mutex_);
    if (writer_of_.contains(instance)) return true;
    if (writer_of_.size() >= kInAll) return false;
    const auto is_of_writer = [writer](const auto& entry) { return entry.second == writer; };
    const auto count = std::count_if(writer_of_.begin(), writer_of_.end(), is_of_writer);
    if (static_cast<std::size_t>(count) >= kPerWriter) return false;
    writer_of_.emplace(instance, writer);
    return true;
  }
  /// Returns whether a sample of it was admitted.
  bool Knows(std::uint64_t instance) {
    MutexLock lock(mutex_);
    return writer_of_.contains(instance);
  }
  /// The middleware keeps nothing of any: the reader is a new one.
  void Clear() {
    MutexLock lock(mutex_);
    writer_of_.clear();
  }
  /// The middleware keeps nothing of it any more: all its writers are gone.
  void Forget(std::uint64_t instance) {
    MutexLock lock(mutex_);
    writer_of_.erase(instance);
  }

 private:
  Mutex mutex_;
  /// By instance: who began it.
  std::unordered_map<std::uint64_t, std::uint64_t> writer_of_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
