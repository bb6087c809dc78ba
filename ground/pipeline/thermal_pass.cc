#include "ground/pipeline/thermal_pass.h"

#include <algorithm>
#include <utility>

namespace isotherm {

ThermalPass::ThermalPass(const GroundOptions& options, const Rig& rig, std::vector<PassPose> poses,
                         const PassModel& model)
    : poses_(std::move(poses)),
      model_(model),
      preprocessor_(options.preprocessor(), *rig.depth, rig.depth_sensor),
      raycaster_(options.raycast()) {
  // As the tracker looks at the model in the first pass.
  view_.camera = rig.depth->WithoutDistortion().Downscaled(options.raycast().expert().halvings());
}

const PassPose* ThermalPass::FindPose(CaptureTime time) const {
  const auto found = std::ranges::lower_bound(poses_, time, {}, &PassPose::time);
  return found != poses_.end() && found->time == time ? &*found : nullptr;
}

void ThermalPass::ProcessDepth(const DepthFrame& frame) {
  // As in the first pass, a repeated image says nothing about the motion.
  if (repeats_.Add(frame.depth_raw) > 0 && motion_.last()) return;
  const PassPose* const pose = FindPose(frame.header.capture_time);
  if (pose == nullptr) return motion_.Clear();
  motion_.Add({pose->time, pose->T_map_depth});
  if (model_.stage.HasFramesUpTo(pose->time)) FuseUpTo(frame, *pose);
}

void ThermalPass::FuseUpTo(const DepthFrame& frame, const PassPose& pose) {
  const PreparedDepth& depth = preprocessor_.Process(frame, model_.pool);
  view_.T_map_depth = pose.T_map_depth;
  raycaster_.Cast(model_.tsdf, view_.camera, view_.T_map_depth, model_.pool, view_.maps);
  model_.stage.FuseUpTo({.depth_m = depth.depth_m,
                         .view = view_,
                         .earlier = motion_.third_last(),
                         .before = motion_.before_last(),
                         .now = *motion_.last(),
                         .surface_sigma_rad = pose.surface_sigma_rad,
                         .mean_depth_m = pose.mean_depth_m,
                         .tsdf = model_.tsdf,
                         .is_finished = true},
                        model_.thermal, model_.pool);
}

void ThermalPass::ProcessThermal(ThermalFramePtr frame) {
  ++model_.counts.thermal_in;
  if (IsCountsOnly(*frame)) {
    ++model_.counts.thermal_left_out[LeftOutReason::kCounts];
    return;
  }
  static_cast<void>(model_.stage.Add(std::move(frame)));
}

void ThermalPass::Finish() { model_.stage.Finish(model_.tsdf, model_.thermal, model_.pool); }

}  // namespace isotherm
