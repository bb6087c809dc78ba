#include "ground/icp/odometry_prior.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/log.h"

namespace isotherm {
namespace {

constexpr std::size_t kAnchors = 9;   ///< A third of a second.
constexpr int kFramesToTrust = 15;    ///< Half a second.
constexpr int kFramesToSpeakUp = 15;  ///< Missing in a row.
constexpr double kSigmas = 3.0;       ///< Beyond it, two figures contradict each other.

/// Columns: the observed axes.
auto ObservedAxes(const Observability& motion) {
  return motion.axes.rightCols(6 - motion.unobservable_axes);
}

/// One sigma of the least certain observed motion, metres at the scene's depth.
double ObservedSigma(const Observability& motion, const Matrix6& covariance) {
  const Matrix6 to_motion = motion.scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd observed =
      ObservedAxes(motion).transpose() * to_motion * covariance * to_motion * ObservedAxes(motion);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(observed, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

}  // namespace

OdometryPrior::OdometryPrior(const ExternalOdometryOptions& options)
    : options_(options), stream_(options) {}

std::optional<OdometryPrior::Prediction> OdometryPrior::Predict(const StampedMapPose& last,
                                                                CaptureTime time,
                                                                const RigidTransform& inertial,
                                                                const PriorError& inertial_error) {
  predicted_.reset();
  if (!options_.expert().enabled() || stream_.counts().accepted == 0) return std::nullopt;
  if (!trusted_) {
    ++counts_.distrusted;
    return std::nullopt;
  }
  // From where the last frame was believed to be, not from what is known now: what was wrong then
  // is gone with this frame.
  const bool continues = used_ && used_->time == last.time;
  const auto from = continues ? std::optional(used_->estimate) : stream_.At(last.time);
  const auto to = stream_.At(time);
  if (!from || !to) {
    NoteMissing();
    return std::nullopt;
  }
  if (std::exchange(missing_in_a_row_, 0) >= kFramesToSpeakUp) {
    LOG(Tracker, Info) << "poses from \"" << stream_.source() << "\" are there again";
  }
  predicted_ = Used{time, *to};
  const RigidTransform motion = from->T_reference_depth.inverse() * to->T_reference_depth;
  Prediction result;
  result.T_map_depth = last.T_map_depth * motion;
  result.error.continues = continues;
  result.error.rotation_growth_rad =
      options_.expert().drift_ratio() * RotationAngle(RigidTransform::Identity(), motion);
  // Of the motion since the first such frame: of both its ends.
  result.error.rotation_noise_rad = std::numbers::sqrt2 * to->rotation_noise_rad;
  result.has_position = from->has_position && to->has_position;
  if (result.has_position) {
    result.error.translation_growth_m =
        options_.expert().drift_ratio() * motion.translation().norm();
    result.error.translation_noise_m = std::numbers::sqrt2 * to->position_noise_m;
  } else {
    result.T_map_depth.translation() = inertial.translation();
    result.error.translation_growth_m = inertial_error.translation_growth_m;
  }
  return result;
}

bool OdometryPrior::Contradicts(const TrackingResult& result, CaptureTime time,
                                const Matrix6& known) const {
  const Observability& motion = result.motion;
  if (anchors_.empty() || !motion.measured || motion.unobservable_axes == 6) return false;
  // Behind a change of what is observed, the tracker corrects what had been held till then.
  const StampedMapPose& anchor =
      motion.unobservable_axes == unobservable_axes_ ? anchors_.front() : anchors_.back();
  const auto from = stream_.At(anchor.time);
  const auto to = stream_.At(time);
  if (!from || !to) return false;
  const RigidTransform moved = from->T_reference_depth.inverse() * to->T_reference_depth;
  Vector6 twist = TwistBetween(anchor.T_map_depth * moved, result.T_map_depth);
  double noise_m =
      std::hypot(from->rotation_noise_rad, to->rotation_noise_rad) * motion.mean_depth_m;
  double way_m = RotationAngle(RigidTransform::Identity(), moved) * motion.mean_depth_m;
  if (from->has_position && to->has_position) {
    noise_m = std::hypot(noise_m, from->position_noise_m, to->position_noise_m);
    way_m += moved.translation().norm();
  } else {
    // An attitude filter says nothing of positions.
    twist.head<3>().setZero();
  }
  const double difference_m =
      (ObservedAxes(motion).transpose() * twist.cwiseQuotient(motion.scale)).norm();
  return difference_m > options_.expert().max_disagreement_m() +
                            kSigmas * (noise_m + options_.expert().drift_ratio() * way_m +
                                       ObservedSigma(motion, known));
}

void OdometryPrior::Note(const TrackingResult& result, CaptureTime time, const Matrix6& known,
                         bool used) {
  used_ = used ? predicted_ : std::nullopt;
  if (used) ++counts_.used;
  if (!options_.expert().enabled() || stream_.counts().accepted == 0) return;
  const bool contradicts = Contradicts(result, time, known);
  const bool compared = !anchors_.empty() && result.motion.measured &&
                        result.motion.unobservable_axes < 6 && stream_.At(time).has_value();
  NoteTrust(!contradicts, compared);
  // Poses from before are held differently, or proven wrong: differences to them are not the
  // source's.
  if (contradicts || result.motion.unobservable_axes != unobservable_axes_) anchors_.clear();
  unobservable_axes_ = result.motion.unobservable_axes;
  anchors_.push_back({time, result.T_map_depth});
  if (anchors_.size() > kAnchors) anchors_.pop_front();
}

void OdometryPrior::NoteTrust(bool agrees, bool compared) {
  if (!agrees) {
    ++counts_.contradicted;
    agreeing_ = 0;
    if (std::exchange(trusted_, false)) {
      LOG(Tracker, Warning) << "poses from \"" << stream_.source()
                            << "\" contradict what is measured: not used";
    }
    return;
  }
  if (trusted_ || !compared || ++agreeing_ < kFramesToTrust) return;
  trusted_ = true;
  LOG(Tracker, Info) << "poses from \"" << stream_.source()
                     << "\" agree with what is measured: used again";
}

void OdometryPrior::NoteMissing() {
  ++counts_.missing;
  if (++missing_in_a_row_ == kFramesToSpeakUp) {
    LOG(Tracker, Warning) << "no poses from \"" << stream_.source()
                          << "\": unobservable directions are held by the motion before";
  }
}

void OdometryPrior::Reset() {
  used_.reset();
  predicted_.reset();
  anchors_.clear();
}

void OdometryPrior::Transform(const RigidTransform& T_new_old) {
  for (StampedMapPose& anchor : anchors_) anchor.T_map_depth = T_new_old * anchor.T_map_depth;
}

}  // namespace isotherm
