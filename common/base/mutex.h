#pragma once

#include <condition_variable>
#include <mutex>

#include "common/base/thread_annotations.h"

namespace isotherm {

/// A std::mutex of which the compiler knows when it is held (GUARDED_BY, REQUIRES). Members are
/// named as the standard library's waiting functions expect them. Who only waits takes Pause().
class CAPABILITY("mutex") Mutex {
 public:
  void lock() ACQUIRE() { mutex_.lock(); }
  void unlock() RELEASE() { mutex_.unlock(); }

 private:
  std::mutex mutex_;
};

/// Holds a Mutex as long as it lives, but for what lies between unlock() and lock(). Waiting needs
/// a std::condition_variable_any, which gives the mutex up meanwhile; what it waits for is
/// `[&]() REQUIRES(mutex_) { ... }`.
class SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) ACQUIRE(mutex) : lock_(mutex) {}
  ~MutexLock() RELEASE() {}
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void lock() ACQUIRE() { lock_.lock(); }
  void unlock() RELEASE() { lock_.unlock(); }

 private:
  std::unique_lock<Mutex> lock_;
};

}  // namespace isotherm
