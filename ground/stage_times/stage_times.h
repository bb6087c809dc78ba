#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/base/enum_array.h"
#include "common/base/processor_time.h"
#include "common/base/stage_stats.h"

namespace isotherm {

/// The stages that the pipeline spends time on, in the order of their names, as in stats.json.
enum class Stage : std::uint8_t {
  kDepthFrame,  ///< All that a depth frame does to the geometric model; the next ones are parts.
  kIntegrate,
  kMerge,  ///< Once, at the end: sub-maps become one model.
  kPreprocess,
  kRaycast,
  kRelocalise,  ///< Instead of kTrack while the rig is lost.
  kSubMaps,
  kThermalFrame,
  kTrack,
  kCount
};
/// "depth_frame", as in stats.json.
std::string_view ToString(Stage stage);

/// Milliseconds per call of each stage. Thread-compatible.
class StageTimes {
 public:
  /// The scan has this stage from now on, even if it is never called.
  StageStats& operator[](Stage stage) {
    std::optional<StageStats>& stats = stats_[stage];
    return stats ? *stats : stats.emplace();
  }
  /// nullptr if the scan has had no such stage.
  const StageStats* Find(Stage stage) const {
    const std::optional<StageStats>& stats = stats_[stage];
    return stats ? &*stats : nullptr;
  }

 private:
  EnumArray<Stage, std::optional<StageStats>> stats_;
};

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
