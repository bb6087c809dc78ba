#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"
#include "ground/options/ground_options.pb.h"
#include "ground/pipeline/thermal_stage.h"
#include "ground/scan/scan_counts.h"
#include "ground/scan/scan_model.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// Holds what decides about temperatures beside the model: options, and the known properties of the
/// rig.
struct ThermalSettings {
  ThermalOptions options;
  Rig rig;
};

/// A rule beside visibility by which a temperature is not assigned, or dropped again.
struct ThermalRule {
  std::string_view name;
  std::function<void(ThermalSettings&)> switch_off;
};
/// Returns all rules that stand between a surface which the thermal camera sees and a temperature,
/// but for the limits of distance and angle.
std::span<const ThermalRule> ThermalRules();

/// Follows a pipeline: gives the same thermal frames, at the same poses, to another thermal stage
/// with settings and a thermal volume of its own. With the pipeline's settings, it has the
/// pipeline's temperatures in the end. Thread-bound, with the pipeline.
class StageFusion {
 public:
  StageFusion(const ThermalSettings& settings, float min_weight, const ScanModel& model);

  void AddThermal(ThermalFramePtr frame) { stage_.Add(std::move(frame)); }
  /// After the pipeline has processed a depth frame that measured `depth_m` (0 = no return).
  void AfterDepth(const Image<float>& depth_m, ThreadPool& pool);
  void Finish(ThreadPool& pool) { stage_.Finish(model_.tsdf(), thermal_, pool); }

  const ThermalVolume& thermal() const { return thermal_; }

 private:
  const ScanModel model_;
  ScanCounts counts_;
  ThermalStage stage_;
  ThermalVolume thermal_;
};

}  // namespace isotherm
