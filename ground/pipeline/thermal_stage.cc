#include "ground/pipeline/thermal_stage.h"

#include <utility>

#include "ground/pipeline/stage_times.h"

namespace isotherm {

ThermalStage::ThermalStage(const ThermalOptions& options, const Rig& rig, float min_weight,
                           PipelineCounts& counts, StageStats& timing)
    : options_(options),
      camera_(*rig.thermal),
      T_depth_thermal_(rig.T_thermal_depth->inverse()),
      counts_(counts),
      timing_(timing),
      fuser_(options, *rig.thermal, rig.thermal_sensor, min_weight),
      near_range_occlusion_(options.expert().occlusion(), rig.depth_sensor, fuser_.ideal_camera()),
      line_of_sight_occlusion_(options.expert().occlusion(), rig.depth_sensor,
                               fuser_.ideal_camera()) {}

bool ThermalStage::Add(ThermalFramePtr frame) {
  const NucAge nuc = nuc_epochs_.Follow(*frame);
  if (!frame->valid) {
    LeaveOut(LeftOutReason::kNuc);
    return false;
  }
  if (frame->centikelvin.width() != camera_.width ||
      frame->centikelvin.height() != camera_.height) {
    LeaveOut(LeftOutReason::kWrongSize);
    return false;
  }
  if (ToSeconds(frame->header.capture_sigma) > options_.expert().max_time_sigma_s()) {
    LeaveOut(LeftOutReason::kTimeUncertain);
    return false;
  }
  waiting_.push_back({std::move(frame), nuc});
  // A depth stream that stopped must not make the buffer grow.
  constexpr std::size_t kMaxWaiting = 64;
  if (waiting_.size() > kMaxWaiting) {
    waiting_.pop_front();
    LeaveOut(LeftOutReason::kDepthStopped);
  }
  return true;
}

double ThermalStage::RegistrationSigmaPx(const TrackedDepth& depth) const {
  return fuser_.ideal_camera().fx * depth.surface_sigma_rad;
}

std::optional<LeftOutReason> ThermalStage::WhyLeftOut(CaptureTime time,
                                                      const TrackedDepth& depth) const {
  if (depth.refusal) return depth.refusal;
  if (!depth.before || time < depth.before->time) return LeftOutReason::kPoseUnknown;
  if (RegistrationSigmaPx(depth) > options_.expert().max_registration_px())
    return LeftOutReason::kPoseUncertain;
  const double interval_s = ToSeconds(depth.now.time - depth.before->time);
  if (interval_s > options_.expert().max_wait_s()) return LeftOutReason::kDepthGap;
  return std::nullopt;
}

void ThermalStage::FuseUpTo(const TrackedDepth& depth, ThermalVolume& thermal, ThreadPool& pool) {
  bool is_prepared = false;
  while (!waiting_.empty() && waiting_.front().frame->header.capture_time <= depth.now.time) {
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (const auto reason = WhyLeftOut(waiting.frame->header.capture_time, depth)) {
      LeaveOut(*reason);
      continue;
    }
    if (depth.every_second && std::exchange(skip_next_, !skip_next_)) {
      LeaveOut(LeftOutReason::kBehind);
      continue;
    }
    const StageTimer timer(timing_);
    if (!std::exchange(is_prepared, true)) {
      near_range_occlusion_.Update(depth.depth_m, depth.view.maps, depth.view.camera);
      line_of_sight_occlusion_.Update(depth.view.maps, depth.view.camera, depth.view.T_map_depth);
    }
    Fuse(waiting, depth, thermal, pool);
  }
}

void ThermalStage::Fuse(const Waiting& waiting, const TrackedDepth& depth, ThermalVolume& thermal,
                        ThreadPool& pool) {
  const StampedMapPose& before = *depth.before;
  const StampedMapPose& now = depth.now;
  const CaptureTime time = waiting.frame->header.capture_time;
  const double interval_s = ToSeconds(now.time - before.time);
  const double alpha = interval_s > 0.0 ? ToSeconds(time - before.time) / interval_s : 1.0;
  const RigidTransform T_map_depth_at_capture =
      Interpolate(before.T_map_depth, now.T_map_depth, alpha);
  const RigidTransform T_map_thermal = T_map_depth_at_capture * T_depth_thermal_;
  const RigidTransform T_view_thermal = depth.view.T_map_depth.inverse() * T_map_thermal;
  near_range_occlusion_.Aim(T_view_thermal);
  line_of_sight_occlusion_.Aim(T_view_thermal);
  const CaptureConditions capture{
      .motion = MotionBetween(before.T_map_depth * T_depth_thermal_,
                              now.T_map_depth * T_depth_thermal_, interval_s),
      .registration_px = RegistrationSigmaPx(depth),
      .near_range = &near_range_occlusion_,
      .line_of_sight = &line_of_sight_occlusion_,
      .nuc = waiting.nuc};
  counts_.fusion += fuser_.Fuse(*waiting.frame, T_map_thermal, depth.view.camera,
                                T_map_depth_at_capture, depth.tsdf, pool, thermal, capture);
  ++counts_.thermal_fused;
}

void ThermalStage::Finish(const TsdfVolume& tsdf, ThermalVolume& thermal, ThreadPool& pool) {
  for (std::size_t i = 0; i < waiting_.size(); ++i) LeaveOut(LeftOutReason::kNoDepthAfter);
  waiting_.clear();
  counts_.fusion.dropped += fuser_.FinalReview(tsdf, thermal, pool);
}

}  // namespace isotherm
