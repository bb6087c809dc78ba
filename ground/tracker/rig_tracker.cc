#include "ground/tracker/rig_tracker.h"

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "ground/icp/thermal_alignment.h"

namespace isotherm {
namespace {

/// A frame that the limits pass is on the wrong surface all the same if its residual is this many
/// times the usual one (and at least kMinUnusual_m, which noise reaches where little is usual), or
/// its agreement this fraction of the usual. With these, recovery_test fuses no frame at a wrong
/// pose: after a covered camera, a jump of 20 cm and 20 degrees, a whip pan of 90 degrees/s. Nearer
/// to the usual: new surface and noise count as losses; further off: a rig that slid along a
/// surface goes on.
constexpr double kUnusualResidual = 4.0;
constexpr double kMinUnusual_m = 0.002;
constexpr double kUnusualAgreement = 0.5;

/// After the rig was lost, a pose is believed only if it fits nearly as well as usual. It stands
/// between the usual and kUnusual: a wrong pose that was just not unusual would otherwise be taken.
/// Not tuned by itself.
constexpr double kConvincingResidual = 2.5;
constexpr double kConvincingAgreement = 0.8;

/// A rig whose speed was never measured may be this fast, m/s at the scene's depth: as fast as the
/// thesis's operator walks (chapter 7). Larger: poses after a loss count as less certain than they
/// are, and thermal frames wait; smaller: they count as certain while the rig moves off.
constexpr double kUnknownSpeed = 0.3;

/// Frames until what is usual is known: a sixth of a second at 30 Hz. More: a loss right after the
/// start passes for usual longer; fewer: single frames decide what is usual. Not tuned.
constexpr int kFramesToKnow = 5;

}  // namespace

RigTracker::RigTracker(const GroundOptions& options, const CameraModel& depth_camera)
    : options_(options.tracker()),
      relocaliser_options_(options.relocaliser()),
      min_weight_(static_cast<float>(options.raycast().expert().min_weight())),
      tracker_(options.tracker()),
      raycaster_(options.raycast()),
      odometry_(options.tracker().external_odometry()) {
  view_.camera = depth_camera.Downscaled(options.raycast().expert().halvings());
  candidate_.camera = view_.camera;
}

RigTracker::~RigTracker() = default;

void RigTracker::UseThermal(const CameraModel& thermal_camera,
                            const RigidTransform& T_thermal_depth) {
  alignment_ = std::make_unique<ThermalAlignment>(thermal_camera, T_thermal_depth,
                                                  options_.expert().thermal_min_gradient_k_m(),
                                                  options_.expert().prior_sigma_m_s());
}

void RigTracker::AddThermal(ThermalFramePtr frame) {
  if (alignment_) alignment_->Add(std::move(frame));
}

TrackingResult RigTracker::Begin(const PreparedDepth& depth, CaptureTime time,
                                 const RigidTransform& pose) {
  TrackingResult first;
  // A covered camera must not found a sub-map.
  if (depth.valid_pixels < kMinTrackedPixels) first.lost = LostReason::kTooFewPixels;
  first.T_map_depth = pose;
  Forget();
  state_ = State::kFollowing;
  if (first.tracked()) {
    motion_.Add({time, pose});
    odometry_.Note(first, time, uncertainty_.covariance(), /*used=*/false);
    Trust(first, time);
  }
  return first;
}

IcpTracker::Start RigTracker::Predict(CaptureTime time) const {
  const RigidTransform& last = view_.T_map_depth;
  if (!options_.expert().predict_motion()) return {last, last};
  return {motion_.Predict(time).value_or(last), motion_.PredictSmoothly(time).value_or(last)};
}

PriorError RigTracker::InertialError(CaptureTime time, double mean_depth_m) const {
  const double seconds = has_trusted_pose_ ? ToSeconds(time - trusted_time_) : 0.0;
  return ConstantVelocityError(
      speed_is_known_ ? options_.expert().prior_sigma_m_s() : kUnknownSpeed, seconds, mean_depth_m);
}

TrackingResult RigTracker::Follow(const PreparedDepth& depth, CaptureTime time,
                                  const TsdfVolume& volume, ThreadPool& pool) {
  const auto track = [&](IcpTracker::Start start) {
    // While a pose is only a candidate, temperatures would tie the image to a wrong place.
    if (alignment_ && state_ == State::kFollowing) {
      alignment_->Begin(motion_.last(), time, start.guess);
      start.alignment = alignment_.get();
    }
    TrackingResult result = tracker_.Track(depth, view_, volume.grid(), start, pool);
    // A frame within all fixed limits may still lie on the wrong surface.
    if (result.tracked()) result.lost = FindAnomaly(result);
    return result;
  };
  const IcpTracker::Start inertial = Predict(time);
  const Matrix6& known = uncertainty_.covariance();
  std::optional<OdometryPrior::Prediction> odometry;
  // Predict gets the inertial guess too, for what the source does not measure (attitude only).
  if (const auto last = motion_.last())
    odometry = odometry_.Predict(*last, time, inertial.guess,
                                 InertialError(time, uncertainty_.mean_depth_m()));
  if (odometry) {
    const TrackingResult result = track({odometry->T_map_depth, odometry->T_map_depth});
    // If the camera sees nothing, another start would not help.
    if (result.lost == LostReason::kTooFewPixels) return result;
    // A source may be wrong without the frame being lost: then constant velocity gets its try
    // below.
    if (result.tracked() && !odometry_.Contradicts(result, time, known)) {
      odometry_.Note(result, time, known, /*used=*/true);
      odometry_error_ = odometry->error;
      is_position_given_ = odometry->has_position;
      return result;
    }
  }
  // Note compares the source with this result, too, and withdraws its trust if they disagree.
  const TrackingResult result = track(inertial);
  if (result.tracked()) odometry_.Note(result, time, known, /*used=*/false);
  return result;
}

double RigTracker::ResidualLimit(const TrackingResult& result, double times_usual) const {
  // A depth camera's noise grows with the square of the depth.
  const double depth_m = result.motion.mean_depth_m;
  return std::max(times_usual * usual_.residual_per_m * depth_m * depth_m, kMinUnusual_m);
}

LostReason RigTracker::FindAnomaly(const TrackingResult& result) const {
  // Of the first frames nobody knows yet what is usual here.
  if (usual_.frames < kFramesToKnow) return LostReason::kNone;
  if (result.residual_m > ResidualLimit(result, kUnusualResidual)) return LostReason::kResidual;
  if (result.agreement < kUnusualAgreement * usual_.agreement) return LostReason::kTooFewInliers;
  return LostReason::kNone;
}

bool RigTracker::IsConvincing(const TrackingResult& result) const {
  // In front of a plane or a cylinder the rig may be anywhere along it.
  if (result.quality() != TrackingQuality::kTracked || !result.motion.measured) return false;
  if (result.agreement < relocaliser_options_.expert().min_agreement() ||
      result.overlap_ratio < relocaliser_options_.expert().min_overlap()) {
    return false;
  }
  return usual_.frames < kFramesToKnow ||
         (result.agreement >= kConvincingAgreement * usual_.agreement &&
          result.residual_m <= ResidualLimit(result, kConvincingResidual));
}

TrackingResult RigTracker::Verify(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                                  const SubMap& map, ThreadPool& pool) {
  CastView(T_map_depth, *map.tsdf, pool, candidate_);
  TrackingResult result =
      tracker_.Track(depth, candidate_, map.tsdf->grid(), {T_map_depth, T_map_depth}, pool);
  if (result.tracked() && !IsConvincing(result)) result.lost = LostReason::kNotFound;
  return result;
}

TrackingResult RigTracker::LookAround(const PreparedDepth& depth, const SubMap& here,
                                      const SubMap& searched, ThreadPool& pool) {
  TrackingResult result;
  // The verdict if nothing can be tried: the camera is covered, or relocalisation is off and there
  // is no view to look back at.
  result.lost = LostReason::kTooFewPixels;
  // Every fourth lost frame looks where the rig was lost, the others around known poses. More: a
  // hand before the camera costs more frames; fewer: the search is slower. Not tuned.
  constexpr int kTurns = 4;
  const bool looks_back = lost_frames_++ % kTurns == 0 || !relocaliser_options_.expert().enabled();
  if (looks_back && view_.maps.width() > 0) {
    // Where it was lost: a hand before the camera, or a rig that swings back.
    const RigidTransform& last = view_.T_map_depth;
    result = tracker_.Track(depth, view_, here.tsdf->grid(), {last, last}, pool);
    if (result.tracked() && !IsConvincing(result)) result.lost = LostReason::kNotFound;
    return result;
  }
  if (!relocaliser_options_.expert().enabled() || depth.valid_pixels < kMinTrackedPixels)
    return result;
  result.lost = LostReason::kNotFound;
  // Find works on small images; only Verify, at full resolution, may say that the rig is there.
  const auto pose = searched.relocaliser->Find(depth, *searched.tsdf, min_weight_, pool);
  if (!pose) return result;
  const TrackingResult found = Verify(depth, *pose, searched, pool);
  if (!found.tracked()) return result;
  found_elsewhere_ = &searched != &here;
  return found;
}

TrackingResult RigTracker::Track(const PreparedDepth& depth, CaptureTime time, const SubMap& here,
                                 const SubMap& searched, ThreadPool& pool) {
  TrackingResult result;
  found_elsewhere_ = false;
  odometry_error_.reset();
  is_position_given_ = false;
  if (state_ == State::kLost) {
    result = LookAround(depth, here, searched, pool);
    if (!result.tracked()) return result;
    // Motion, odometry and the trusted pose are in the coordinates of the map where the rig was
    // lost.
    if (found_elsewhere_) Forget();
    odometry_.Note(result, time, uncertainty_.covariance(), /*used=*/false);
    state_ = State::kConfirming;
    to_confirm_ = relocaliser_options_.expert().confirming_frames();
  } else {
    result = Follow(depth, time, *here.tsdf, pool);
    if (result.tracked() && state_ == State::kConfirming) {
      // A wrong place often fits one frame, seldom the next ones of a moving rig.
      --to_confirm_;
      if (!IsConvincing(result)) result.lost = LostReason::kNotFound;
    }
  }
  if (!result.tracked()) {
    // What was not confirmed is the wrong place to look back at.
    if (state_ == State::kConfirming && has_trusted_pose_)
      CastView(trusted_pose_, *here.tsdf, pool, view_);
    state_ = State::kLost;
    lost_frames_ = 0;
    // The next pose is found anew: a velocity across the gap would be the error of the search over
    // one frame.
    motion_.Clear();
    odometry_.Reset();
    speed_is_known_ = false;
    if (alignment_) alignment_->Forget();
    return result;
  }
  motion_.Add({time, result.T_map_depth});
  if (state_ == State::kConfirming && to_confirm_ <= 0) {
    state_ = State::kFollowing;
    ++relocalisations_;
  }
  // Candidates leave nothing behind: a wrong one must change neither what is usual nor the
  // uncertainty.
  if (state_ == State::kFollowing) Trust(result, time);
  return result;
}

void RigTracker::Trust(const TrackingResult& result, CaptureTime time) {
  uncertainty_.Update(result,
                      odometry_error_.value_or(InertialError(time, result.motion.mean_depth_m)));
  trusted_pose_ = result.T_map_depth;
  trusted_time_ = time;
  has_trusted_pose_ = true;
  if (alignment_)
    alignment_->End(motion_.before_last(), *motion_.last(), uncertainty_.surface_sigma_m());
  if (result.iterations == 0) return;  // Not tracked against anything.
  if (motion_.before_last() && result.quality() == TrackingQuality::kTracked)
    speed_is_known_ = true;
  // What is usual follows over some ten frames. Larger: one bad frame becomes usual; smaller: after
  // a change of surface good frames count as unusual for long. Not tuned.
  constexpr double kNewFraction = 0.1;
  const double fraction = std::max(kNewFraction, 1.0 / (1.0 + usual_.frames));
  const double depth_m = result.motion.mean_depth_m;
  usual_.residual_per_m +=
      fraction * (result.residual_m / (depth_m * depth_m) - usual_.residual_per_m);
  usual_.agreement += fraction * (result.agreement - usual_.agreement);
  ++usual_.frames;
}

void RigTracker::Forget() {
  motion_.Clear();
  odometry_.Reset();
  if (alignment_) alignment_->Forget();
  has_trusted_pose_ = false;
  speed_is_known_ = false;
}

void RigTracker::Rebase(const RigidTransform& T_new_old) {
  // usual_ stays: the rig and its cameras are the same, and both maps show the same surface here.
  motion_.Transform(T_new_old);
  odometry_.Transform(T_new_old);
  if (alignment_) alignment_->Forget();
  trusted_pose_ = T_new_old * trusted_pose_;
  view_.T_map_depth = T_new_old * view_.T_map_depth;
  uncertainty_.Rotate(T_new_old.linear());
}

void RigTracker::CastView(const RigidTransform& T_map_depth, const TsdfVolume& volume,
                          ThreadPool& pool, ModelView& view) {
  view.T_map_depth = T_map_depth;
  view.is_young = false;
  raycaster_.Cast(volume, view.camera, T_map_depth, pool, view.maps);
}

void RigTracker::LookFrom(const RigidTransform& T_map_depth, const TsdfVolume& volume,
                          bool is_young, ThreadPool& pool) {
  CastView(T_map_depth, volume, pool, view_);
  view_.is_young = is_young;
}

}  // namespace isotherm
