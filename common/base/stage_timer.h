#pragma once

#include <chrono>

#include "common/base/processor_time.h"
#include "common/base/stage_stats.h"

namespace isotherm {

/// Adds the time from construction to Stop() or destruction to a stage, and the processor time that
/// this thread and those of its pools used in it.
class StageTimer {
 public:
  explicit StageTimer(StageStats& stats) : stats_(&stats) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() { Stop(); }

  void Stop() {
    if (stats_ == nullptr) return;
    using Milliseconds = std::chrono::duration<double, std::milli>;
    stats_->Add(Milliseconds(std::chrono::steady_clock::now() - start_).count());
    stats_->AddProcessorTime(Milliseconds(ThreadProcessorTime() - processor_start_).count());
    stats_ = nullptr;
  }

 private:
  StageStats* stats_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const std::chrono::nanoseconds processor_start_ = ThreadProcessorTime();
};

}  // namespace isotherm
