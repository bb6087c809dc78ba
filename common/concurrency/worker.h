#pragma once

#include <chrono>
#include <future>
#include <stop_token>
#include <thread>
#include <utility>

#include "common/base/processor_time.h"

namespace isotherm {

/// A thread whose end can be waited for with a deadline, because it may be stuck in a system call.
/// The destructor waits for it. Thread-compatible.
class Worker {
 public:
  /// `body` gets a std::stop_token; `name` is that of the thread (NameThread).
  template <typename Body>
  Worker(const char* name, Body body)
      : thread_([this, name, body = std::move(body)](const std::stop_token& stop) {
          NameThread(name);
          body(stop);
          end_.set_value_at_thread_exit();
        }) {}

  void RequestStop() { thread_.request_stop(); }
  /// True if it has ended.
  bool WaitForEnd(std::chrono::nanoseconds patience) {
    return ended_.wait_for(patience) == std::future_status::ready;
  }

 private:
  std::promise<void> end_;
  std::future<void> ended_ = end_.get_future();
  std::jthread thread_;
};

}  // namespace isotherm
