#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <stop_token>
#include <thread>
#include <vector>

#include "common/base/mutex.h"

namespace isotherm {

/// A fixed set of threads for parallel loops over blocks or rows. The calling thread works too, so
/// a pool of one has no thread of its own and runs everything inline. Thread-bound: one ParallelFor
/// at a time. What its threads work counts as processor time of the caller (ThreadProcessorTime).
class ThreadPool {
 public:
  /// `threads` >= 1 counts the calling thread.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls `body(index)` once for each index in [0, count), in no particular order and from any
  /// thread of the pool; returns when all are done. Bodies must not write to shared data.
  void ParallelFor(int count, const std::function<void(int index)>& body);
  /// The same for the rows [0, height) of an image, `rows_per_task` neighbouring ones by one
  /// thread.
  template <typename Body>
  void ParallelForRows(int height, int rows_per_task, const Body& body) {
    ParallelFor((height + rows_per_task - 1) / rows_per_task, [&](int task) {
      const int end = std::min(height, (task + 1) * rows_per_task);
      for (int y = task * rows_per_task; y < end; ++y) body(y);
    });
  }

 private:
  void Work(std::stop_token stop);
  void RunIndices(const std::function<void(int)>& body, int count);

  Mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable_any done_;
  const std::function<void(int)>* body_ GUARDED_BY(mutex_) = nullptr;
  int count_ GUARDED_BY(mutex_) = 0;
  int running_ GUARDED_BY(mutex_) = 0;
  std::chrono::nanoseconds worked_ GUARDED_BY(mutex_){0};  ///< By the threads, in this loop.
  long generation_ GUARDED_BY(mutex_) = 0;
  std::atomic<int> next_{0};
  std::vector<std::jthread> workers_;
};

}  // namespace isotherm
