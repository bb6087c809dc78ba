#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace isotherm {

/// A mailbox that holds the newest value only. Thread-safe.
template <typename T>
class LatestValue {
 public:
  void Set(T value) {
    std::scoped_lock lock(mutex_);
    value_ = std::move(value);
  }
  /// The newest value, which stays; nullopt before the first Set.
  std::optional<T> Get() const {
    std::scoped_lock lock(mutex_);
    return value_;
  }
  /// The newest value, which is taken out.
  std::optional<T> Take() {
    std::scoped_lock lock(mutex_);
    return std::exchange(value_, std::nullopt);
  }

 private:
  mutable std::mutex mutex_;
  std::optional<T> value_;
};

}  // namespace isotherm
