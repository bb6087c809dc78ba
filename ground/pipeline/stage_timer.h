#pragma once

#include <chrono>

#include "common/base/stage_stats.h"

namespace isotherm {

/// Adds the time from construction to destruction to a stage.
class StageTimer {
 public:
  explicit StageTimer(StageStats& stats) : stats_(stats) {}
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;
  ~StageTimer() {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start_;
    stats_.Add(elapsed.count());
  }

 private:
  StageStats& stats_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace isotherm
