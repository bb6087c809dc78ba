#include "common/concurrency/thread_pool.h"

#include "common/base/check.h"
#include "common/base/processor_time.h"

namespace isotherm {

ThreadPool::ThreadPool(int threads) {
  CHECK(threads >= 1);
  // The calling thread is the first.
  for (int i = 1; i < threads; ++i) {
    workers_.emplace_back([this](std::stop_token stop) { Work(stop); });
  }
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::RunIndices(const std::function<void(int)>& body, int count) {
  // Indices are taken one by one, since tasks differ in length. Relaxed: what a task reads was
  // published by the mutex, and what it wrote is by the end of the loop.
  for (int i = next_.fetch_add(1, std::memory_order_relaxed); i < count;
       i = next_.fetch_add(1, std::memory_order_relaxed)) {
    body(i);
  }
}

void ThreadPool::ParallelFor(int count, const std::function<void(int)>& body) {
  if (count <= 0) return;
  // Waking threads for one task costs more than it saves.
  if (workers_.empty() || count == 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  {
    MutexLock lock(mutex_);
    body_ = &body;
    count_ = count;
    next_ = 0;
    // All workers must report back, also those that find no index left: `body` lives only until
    // this function returns.
    running_ = static_cast<int>(workers_.size());
    worked_ = std::chrono::nanoseconds(0);
    ++generation_;
  }
  wake_.notify_all();
  RunIndices(body, count);
  MutexLock lock(mutex_);
  done_.wait(lock, [this]() REQUIRES(mutex_) { return running_ == 0; });
  // Counted for the stage that asked, not for the pool.
  AddProcessorTimeOfHelpers(worked_);
}

void ThreadPool::Work(std::stop_token stop) {
  NameThread("pool");
  long seen = 0;
  while (true) {
    const std::function<void(int)>* body = nullptr;
    int count = 0;
    {
      MutexLock lock(mutex_);
      if (!wake_.wait(lock, stop, [&]() REQUIRES(mutex_) { return generation_ != seen; })) return;
      seen = generation_;
      body = body_;
      count = count_;
    }
    const auto before = ThreadProcessorTime();
    RunIndices(*body, count);
    MutexLock lock(mutex_);
    worked_ += ThreadProcessorTime() - before;
    if (--running_ == 0) done_.notify_one();
  }
}

}  // namespace isotherm
