#include "ground/experiment/stage_fusion.h"

#include <array>

#include "common/base/check.h"

namespace isotherm {

std::span<const ThermalRule> ThermalRules() {
  // No rig moves so fast: the rule is off.
  constexpr double kAnySmear_px = 1e6;
  // Larger than any hole of the scenes.
  constexpr int kMaxHole_px = 256;
  static const std::array rules = {
      ThermalRule{"margin of edges",
                  [](ThermalSettings& s) {
                    s.options.mutable_expert()->mutable_occlusion()->set_edge_margin_px(0);
                  }},
      ThermalRule{
          "steep temperatures",
          [](ThermalSettings& s) { s.options.mutable_expert()->set_max_gradient_error_k(0.0); }},
      ThermalRule{"smear",
                  [](ThermalSettings& s) {
                    ThermalMotionOptions& motion = *s.options.mutable_expert()->mutable_motion();
                    motion.set_smear_good_px(kAnySmear_px);
                    motion.set_smear_max_px(kAnySmear_px);
                  }},
      ThermalRule{"near-range holes",
                  [](ThermalSettings& s) {
                    s.options.mutable_expert()->mutable_occlusion()->set_hole_px(kMaxHole_px);
                  }},
      // Both begin at the near range, and end without one.
      ThermalRule{"near-range holes, line of sight",
                  [](ThermalSettings& s) { s.rig.depth_sensor.near_range_m = 0.0; }},
      // Both live on the records.
      ThermalRule{"review, choice by uncertainty",
                  [](ThermalSettings& s) { s.options.mutable_expert()->set_records(false); }},
  };
  return rules;
}

StageFusion::StageFusion(const ThermalSettings& settings, float min_weight, const ScanModel& model)
    : model_(model),
      stage_(settings.options, settings.rig, min_weight, counts_),
      thermal_(model.tsdf().max_blocks(), {}, settings.options.expert().records()) {}

void StageFusion::AfterDepth(const Image<float>& depth_m, ThreadPool& pool) {
  if (!model_.motion.last()) return;  // The rig is lost.
  CHECK(thermal_.Commit(model_.tsdf().block_count()));
  const PoseUncertainty& uncertainty = model_.uncertainty;
  const TrackedDepth tracked{
      .depth_m = depth_m,
      .view = model_.view,
      .earlier = model_.motion.third_last(),
      .before = model_.motion.before_last(),
      .now = *model_.motion.last(),
      .surface_sigma_rad = uncertainty.surface_sigma_m() / uncertainty.mean_depth_m(),
      .mean_depth_m = uncertainty.mean_depth_m(),
      .tsdf = model_.tsdf()};
  stage_.FuseUpTo(tracked, thermal_, pool);
}

}  // namespace isotherm
