#pragma once

#include <optional>
#include <utility>

#include "common/base/mutex.h"

namespace isotherm {

/// A mailbox that holds the newest value only. Thread-safe.
template <typename T>
class LatestValue {
 public:
  void Set(T value) {
    MutexLock lock(mutex_);
    value_ = std::move(value);
  }
  /// The newest value, which stays; nullopt before the first Set.
  std::optional<T> Get() const {
    MutexLock lock(mutex_);
    return value_;
  }
  /// The newest value, which is taken out.
  std::optional<T> Take() {
    MutexLock lock(mutex_);
    return std::exchange(value_, std::nullopt);
  }

 private:
  mutable Mutex mutex_;
  std::optional<T> value_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
