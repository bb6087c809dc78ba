#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "tests/system/process.h"

namespace isotherm::system_test {

/// How long this computer leaves threads waiting that could run: where others need it, losses say
/// nothing about the programs that are tested. Measured from its construction on. Thread-safe.
class StarvationWatch {
 public:
  StarvationWatch()
      : thread_([this](const std::stop_token& stop) {
          using Clock = std::chrono::steady_clock;
          for (auto next = Clock::now(); !stop.stop_requested(); next = Clock::now()) {
            next += kPeriod;
            std::this_thread::sleep_until(next);
            longest_ = std::max(longest_.load(), Seconds(Clock::now() - next));
          }
        }) {}

  Seconds longest() const { return longest_; }

 private:
  static constexpr std::chrono::milliseconds kPeriod{5};

  std::atomic<Seconds> longest_{Seconds(0)};
  std::jthread thread_;
};

}  // namespace isotherm::system_test
