#include "ground/pipeline/thermal_stage.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/stage_timer.h"
#include "ground/thermal/uncertainty_budget.h"

namespace isotherm {
namespace {

/// A bound that a hand-held rig keeps for 95 % of the time is two standard deviations.
constexpr double kSigmasOfBound = 2.0;
/// Fraction of the scene influence that is left after it was taken out: its parameters are known to
/// about a tenth, if they were measured with a disc and patterns (thesis 5.1).
constexpr double kLeftOfSceneInfluence = 0.1;

CameraUncertainty UncertaintyOf(const ThermalOptions& options, const ThermalSensorModel& sensor) {
  const double left = options.expert().correct_scene_influence() ? kLeftOfSceneInfluence : 1.0;
  CameraUncertainty uncertainty;
  uncertainty.scene_influence = left * sensor.scene_influence.Total();
  if (sensor.housing_drift) {
    uncertainty.error_per_housing_k =
        std::hypot(sensor.housing_drift->error_per_kelvin, sensor.housing_drift->sigma);
    uncertainty.left_per_housing_k = sensor.housing_drift->sigma;
  }
  return uncertainty;
}

}  // namespace

ThermalStage::ThermalStage(const ThermalOptions& options, const Rig& rig, float min_weight,
                           ScanCounts& counts)
    : options_(options),
      camera_(*rig.thermal),
      T_depth_thermal_(rig.T_thermal_depth->inverse()),
      extrinsic_px_(ExtrinsicSigmaPx(rig.reprojection_error_px)),
      uncertainty_(UncertaintyOf(options, rig.thermal_sensor)),
      counts_(counts),
      fuser_(options, *rig.thermal, rig.thermal_sensor, min_weight),
      near_range_occlusion_(options.expert().occlusion(), rig.depth_sensor, fuser_.ideal_camera()),
      line_of_sight_occlusion_(options.expert().occlusion(), rig.depth_sensor,
                               fuser_.ideal_camera()) {}

bool ThermalStage::Add(ThermalFramePtr frame) {
  // Also frames that are left out: they tell of corrections.
  const NucAge nuc = nuc_epochs_.Follow(*frame);
  const CaptureTime time = frame->header.capture_time;
  if (!frame->valid) {
    LeaveOut(LeftOutReason::kNuc, time);
    return false;
  }
  if (frame->temperature_raw.width() != camera_.width ||
      frame->temperature_raw.height() != camera_.height) {
    LeaveOut(LeftOutReason::kWrongSize, time);
    return false;
  }
  if (ToSeconds(frame->header.capture_sigma) > options_.expert().max_time_sigma_s()) {
    LeaveOut(LeftOutReason::kTimeUncertain, time);
    return false;
  }
  waiting_.push_back({std::move(frame), nuc});
  // Frames wait for the depth frame behind them, a handful at 30 and 40 Hz. The bound keeps the
  // buffer from growing when the depth stream stops: 64 are one and a half seconds, and longer gaps
  // are left out anyway (max_depth_gap_s).
  constexpr std::size_t kMaxWaiting = 64;
  if (waiting_.size() > kMaxWaiting) {
    LeaveOut(LeftOutReason::kDepthStopped, waiting_.front().frame->header.capture_time);
    waiting_.pop_front();
  }
  return true;
}

double ThermalStage::RegistrationSigmaPx(CaptureTime time, const TrackedDepth& depth) const {
  const ThermalMotionOptions& motion = options_.expert().motion();
  const double since_s = ToSeconds(time - depth.before->time);
  const double until_s = ToSeconds(depth.now.time - time);
  // A motion with acceleration a leaves the line between its ends by a t (T - t) / 2 at time t.
  const double lever_s2 = 0.5 * since_s * until_s;
  const double off_line_rad =
      lever_s2 * std::hypot(motion.max_acceleration_m_s2() / depth.mean_depth_m,
                            motion.max_angular_acceleration_rad_s2());
  return fuser_.ideal_camera().fx *
         std::hypot(depth.surface_sigma_rad, off_line_rad / kSigmasOfBound);
}

CameraMotion ThermalStage::MotionAround(const TrackedDepth& depth) const {
  const auto between = [this](const StampedMapPose& a, const StampedMapPose& b) {
    return MotionBetween(a.T_map_depth * T_depth_thermal_, b.T_map_depth * T_depth_thermal_,
                         ToSeconds(b.time - a.time));
  };
  const CameraMotion mean = between(*depth.before, depth.now);
  // The motion within the interval may be faster than its mean; what is assessed by smear must not
  // be taken for slower than it was.
  if (!depth.earlier) return mean;
  const CameraMotion start = between(*depth.earlier, *depth.before);
  const std::array motions = {
      mean, start,
      MotionAtEnd(start, ToSeconds(depth.before->time - depth.earlier->time), mean,
                  ToSeconds(depth.now.time - depth.before->time))};
  return FastestInImage(motions, fuser_.ideal_camera(), depth.mean_depth_m);
}

std::optional<LeftOutReason> ThermalStage::WhyLeftOut(CaptureTime time,
                                                      const TrackedDepth& depth) const {
  if (depth.refusal) return depth.refusal;
  if (!depth.before || time < depth.before->time) return LeftOutReason::kPoseUnknown;
  const double interval_s = ToSeconds(depth.now.time - depth.before->time);
  if (interval_s > options_.expert().max_depth_gap_s()) return LeftOutReason::kDepthGap;
  if (RegistrationSigmaPx(time, depth) > options_.expert().max_registration_px())
    return LeftOutReason::kPoseUncertain;
  return std::nullopt;
}

bool ThermalStage::IsThinnedOut(ThermalThinning thinning, CaptureTime time) {
  // At 30 and at 40 frames per second this leaves one every 100 ms, in which a rig at 0.3 m/s moves
  // by a twentieth of what it sees. Larger: less work, and seams between frames; smaller: a slow
  // computer stays behind.
  constexpr Nanoseconds kSparseInterval = std::chrono::milliseconds(80);
  // Four a second: all else has been left out by then.
  constexpr Nanoseconds kScarceInterval = std::chrono::milliseconds(230);
  if (thinning == ThermalThinning::kNone) return false;
  if (thinning == ThermalThinning::kEverySecond) return std::exchange(skip_next_, !skip_next_);
  return last_fused_ && time >= *last_fused_ &&
         time - *last_fused_ <
             (thinning == ThermalThinning::kSparse ? kSparseInterval : kScarceInterval);
}

void ThermalStage::NotePause(CaptureTime time) {
  const bool was_unusable =
      last_unusable_ && last_fused_ && *last_unusable_ > *last_fused_ && *last_unusable_ < time;
  if (last_fused_ && was_thinned_ && !was_unusable) {
    counts_.longest_thermal_pause_s =
        std::max(counts_.longest_thermal_pause_s, ToSeconds(time - *last_fused_));
  }
  last_fused_ = time;
  was_thinned_ = false;
}

void ThermalStage::FuseUpTo(const TrackedDepth& depth, ThermalVolume& thermal, ThreadPool& pool) {
  bool is_prepared = false;
  while (HasFramesUpTo(depth.now.time)) {
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (const auto reason = WhyLeftOut(waiting.frame->header.capture_time, depth)) {
      LeaveOut(*reason, waiting.frame->header.capture_time);
      continue;
    }
    if (IsThinnedOut(depth.thinning, waiting.frame->header.capture_time)) {
      LeaveOut(LeftOutReason::kBehind);
      was_thinned_ = true;
      continue;
    }
    const CaptureTime time = waiting.frame->header.capture_time;
    NotePause(time);
    const StageTimer timer(times_);
    // Several thermal frames share a depth frame: what depends on that alone is done once.
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
  const CaptureConditions capture{.motion = MotionAround(depth),
                                  .registration_px = RegistrationSigmaPx(time, depth),
                                  .extrinsic_px = extrinsic_px_,
                                  .time_sigma_s = ToSeconds(waiting.frame->header.capture_sigma),
                                  .camera = uncertainty_,
                                  .near_range = &near_range_occlusion_,
                                  .line_of_sight = &line_of_sight_occlusion_,
                                  .nuc = waiting.nuc,
                                  .surface_is_finished = depth.is_finished};
  counts_.fusion +=
      fuser_.Fuse({*waiting.frame, T_map_thermal, depth.view.camera, T_map_depth_at_capture},
                  capture, depth.tsdf, pool, thermal);
  ++counts_.thermal_fused;
  if (depth.versions != nullptr) depth.versions->Note(fuser_.fused_blocks());
}

void ThermalStage::Finish(const TsdfVolume& tsdf, ThermalVolume& thermal, ThreadPool& pool) {
  for (std::size_t i = 0; i < waiting_.size(); ++i) LeaveOut(LeftOutReason::kNoDepthAfter);
  waiting_.clear();
  counts_.fusion.dropped += fuser_.FinalReview(tsdf, thermal, pool);
}

}  // namespace isotherm
