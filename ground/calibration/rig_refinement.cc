#include "ground/calibration/rig_refinement.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "ground/calibration/alignment_step.h"
#include "ground/calibration/image_motion.h"
#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/trajectory_drift.h"

namespace isotherm {
namespace {

/// Holds how finely images are compared.
struct Level {
  double blur_px;  ///< A misalignment of about three times as much is found.
  double range_s;  ///< The delay may be off by this.
  std::size_t points;
};
// Blurred images lead from far away. Sharp ones decide: a blur is not equally wide on all of a
// surface, which pulls the principal point by pixels.
constexpr Level kLevels[] = {
    {8.0, 0.06, 3000}, {4.0, 0.03, 3000}, {2.0, 0.01, 3000}, {0.0, 0.01, kFinestPoints}};
constexpr int kMaxIterations = 12;
/// Says when the iterations end: the step is small against what the placement is uncertain by, or
/// against the prior.
struct StepLimit {
  double in_sigmas;
  double of_prior;

  bool Holds(const AlignmentStep& step) const {
    return step.in_sigmas < in_sigmas || step.length < of_prior;
  }
};
// Where blurred images lead need not be exact, nor what goes to and fro at the end, as points come
// to be compared and cease to be: an error of half a standard deviation in eleven values adds a
// fortieth to the variance. The second part is a fraction of what is wrong alike in the whole scan
// (below).
constexpr StepLimit kConverged{0.2, 0.005}, kNearEnough{0.5, 0.02};
// Points that held-out images are compared at.
constexpr std::size_t kHeldOutPoints = 6000;
// Fewer points with a gradient in temperature are an edge or two, which leave most directions open.
constexpr int kMinTexturedPoints = 300;
// Knots of the drift: as often as a person turns back, but no more than can be solved for in
// seconds.
constexpr double kKnotSpacing_s = 0.7;
constexpr int kMaxKnots = 24;
// What one knot is off by: half of what poses drift by within seconds (ScanViews::pose_drift_m),
// which is a cautious figure for a verdict. Rendered scans are off by as much along each axis; with
// twice as much, simulated ones were refined no better.
constexpr double kDriftOfKnot = 0.5;
// What is wrong alike in the whole scan, so that its parts do not show it: blur and inertia of the
// camera, the surface that drifting poses made. In the calibration-check experiment, whose cameras
// have all of a PI 450's faults, errors are as large on average.
constexpr double kCommonRotation_rad = 0.0002, kCommonTranslation_m = 0.0002;
constexpr double kCommonDelay_s = 0.0004, kCommonPrincipal_px = 0.1, kCommonInfluence = 0.002;
// The same of a turn whose shift of the image a shift of the principal point takes back: defocus
// moves such pairs by up to 0.13 degrees and half a pixel in scans of 10 s.
constexpr double kCommonPair_rad = 0.0012;
// Frames and points of each that the shift in the image is measured at.
constexpr std::size_t kShiftFrames = 40, kShiftPoints = 200;

PlacementVector SigmasOf(const RefinementPrior& prior) {
  PlacementVector sigma;
  sigma << Eigen::Vector3d::Constant(prior.rotation_rad),
      Eigen::Vector3d::Constant(prior.translation_m), prior.delay_s,
      Eigen::Vector2d::Constant(prior.principal_point_px),
      Eigen::Vector2d::Constant(prior.influence);
  return sigma;
}

/// The covariance of what no part of the scan tells, of values that are not to be kept.
PlacementMatrix CommonCovariance(const CameraModel& camera, const PlacementVector& prior_sigma) {
  const PlacementVector alone = SigmasOf({.rotation_rad = kCommonRotation_rad,
                                          .translation_m = kCommonTranslation_m,
                                          .delay_s = kCommonDelay_s,
                                          .principal_point_px = kCommonPrincipal_px,
                                          .influence = kCommonInfluence});
  PlacementMatrix covariance = alone.cwiseMin(prior_sigma).cwiseAbs2().asDiagonal();
  if (prior_sigma[kRotationX] > 0.0 && prior_sigma[kPrincipalX] > 0.0) {
    PlacementVector about_x = PlacementVector::Zero(), about_y = about_x;
    about_x[kRotationX] = about_y[kRotationY] = kCommonPair_rad;
    about_x[kPrincipalY] = kCommonPair_rad * camera.fy;
    about_y[kPrincipalX] = -kCommonPair_rad * camera.fx;
    covariance += about_x * about_x.transpose() + about_y * about_y.transpose();
  }
  return covariance;
}

Eigen::MatrixXd DriftFactor(const ScanViews& views, const TrajectoryDrift& drift) {
  const double sigma_m = kDriftOfKnot * views.pose_drift_m;
  // A turn that moves the surface as far in the image.
  return drift.PriorFactor(sigma_m,
                           sigma_m * PixelsPerMetre(views).value_or(0.0) / views.thermal_camera.fx);
}

/// How far points move in the images from one placement to another, root mean square, pixels.
double ShiftBetween(const ScanViews& views, const ThermalPlacement& from,
                    const ThermalPlacement& to) {
  double squares = 0.0, count = 0.0;
  const std::size_t stride = 1 + views.frames.size() / kShiftFrames;
  for (std::size_t i = 0; i < views.frames.size(); i += stride) {
    const StampedThermal& frame = views.frames[i];
    const auto T_world_depth =
        InterpolatePose(views.trajectory, frame.time + FromSeconds(from.delay_s));
    if (!T_world_depth) continue;
    const RigidTransform T_depth_world = T_world_depth->inverse();
    const std::size_t points = std::min(kShiftPoints, frame.visible.size());
    for (std::size_t k = 0; k < points; ++k) {
      const Eigen::Vector3d p_depth = T_depth_world * views.points[frame.visible[k]].p_world;
      const auto a = Project(from.camera, from.T_thermal_depth * p_depth);
      const auto b = Project(to.camera, to.T_thermal_depth * p_depth);
      if (!a || !b) continue;
      squares += (*b - *a).squaredNorm();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

ImageShift ShiftOf(const ScanViews& views, const Refinement& refinement) {
  ImageShift shift;
  shift.rms_px = ShiftBetween(views, refinement.before, refinement.after);
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> axes(refinement.covariance);
  double variance_px2 = 0.0;
  for (int i = 0; i < kPlacementParameters; ++i) {
    const double sigma = std::sqrt(std::max(0.0, axes.eigenvalues()[i]));
    const double moved_px = ShiftBetween(
        views, refinement.after, Corrected(refinement.after, sigma * axes.eigenvectors().col(i)));
    variance_px2 += moved_px * moved_px;
  }
  shift.sigma_px = std::sqrt(variance_px2);
  return shift;
}

/// The allowed fractions nearest to those found, with their sum, which is the best told. Less than
/// none is chance.
SceneInfluence Allowed(const SceneInfluence& found) {
  SceneInfluence allowed = found;
  constexpr double kMax = SceneInfluence::kMaxFraction;
  allowed.near_fraction = std::clamp(found.near_fraction, 0.0, kMax);
  allowed.total_fraction = std::clamp(found.Total() - allowed.near_fraction, 0.0, kMax);
  allowed.near_fraction = std::clamp(found.Total() - allowed.total_fraction, 0.0, kMax);
  return allowed;
}

Status ToldToStop() { return Unavailable("told to stop"); }

/// Corrects the placement step by step.
class Refiner {
 public:
  Refiner(const ScanViews& views, const ThermalPlacement& before, const RefinementPrior& prior,
          ThreadPool& pool, const std::stop_token& stop)
      : views_(views), pool_(pool), stop_(stop) {
    refinement_.before = refinement_.after = before;
    refinement_.prior_sigma = SigmasOf(prior);
  }

  const ThermalPlacement& placement() const { return refinement_.after; }

  /// The views show the scan from `placement`.
  Status Refine(const Level& level, const std::function<void(double)>& progress) {
    const TextureAlignment& alignment = alignment_.emplace(views_, pool_);
    alignment_->PrepareImages(refinement_.after.influence, level.blur_px, stop_);
    const AlignmentPrior prior{refinement_.prior_sigma, {}};
    const bool is_last = level.blur_px == 0.0;
    const Result<bool> settled =
        Settle(alignment, level.points, prior, TrajectoryDrift(),
               is_last ? kConverged : kNearEnough, PartOf(progress, 0.0, is_last ? 0.4 : 1.0));
    if (stop_.stop_requested()) return ToldToStop();
    // A blur may hide what sharp images show.
    if (!is_last) return OkStatus();
    if (!settled) return settled.error();
    if (!*settled) return NotSettled();
    return RefineWithDrift(alignment, level.points, PartOf(progress, 0.4, 1.0));
  }

  /// After the last level, whose images are sharp. By its influence they differ from that found
  /// last by what one level changes, which is taken to first order.
  Refinement Finish() {
    refinement_.held_out =
        alignment_->CompareHeldOut(refinement_.before, refinement_.after, kHeldOutPoints);
    refinement_.epoch_offset =
        LargestEpochOffset(alignment_->CompareEpochs(refinement_.after, kHeldOutPoints));
    refinement_.after.influence = Allowed(refinement_.after.influence);
    refinement_.correction = CorrectionBetween(refinement_.before, refinement_.after);
    refinement_.covariance += CommonCovariance(refinement_.after.camera, refinement_.prior_sigma);
    refinement_.covariance(kDelay, kDelay) += std::pow(DelaySigmaOfDriftAlong(), 2);
    refinement_.shift = ShiftOf(views_, refinement_);
    refinement_.frames = static_cast<std::size_t>(
        std::count_if(views_.frames.begin(), views_.frames.end(),
                      [](const StampedThermal& frame) { return !frame.visible.empty(); }));
    return std::move(refinement_);
  }

 private:
  /// Corrects the placement until it does not change any more; false if it still does after many
  /// steps. Fails if too little can be compared.
  Result<bool> Settle(const TextureAlignment& alignment, std::size_t points,
                      const AlignmentPrior& prior, TrajectoryDrift drift,
                      const StepLimit& converged, const std::function<void(double)>& progress) {
    AlignmentStep step;
    PlacementVector last_step = PlacementVector::Zero();
    for (int i = 0; i < kMaxIterations; ++i) {
      if (stop_.stop_requested()) return Err(ToldToStop());
      const AlignmentEquations equations = alignment.Linearize(refinement_.after, drift, points);
      if (equations.textured_points < kMinTexturedPoints) return Err(TooFew(equations));
      step =
          SolveAlignment(equations, prior, CorrectionBetween(refinement_.before, refinement_.after),
                         drift.values());
      refinement_.covariance = step.covariance;
      refinement_.observed_directions = step.observed_directions;
      refinement_.textured_points = equations.textured_points;
      refinement_.points = equations.seen_points;
      if (TurnsBack(step.placement, last_step)) step.Halve();
      last_step = step.placement;
      refinement_.after = Corrected(refinement_.after, step.placement);
      drift.Add(step.drift);
      if (progress) progress((i + 1.0) / kMaxIterations);
      // The drift follows the placement.
      if (converged.Holds(step) && i > 0) return true;
    }
    return kNearEnough.Holds(step);
  }

  /// Once more, together with what the tracked poses drift by. The delay stays: a drift along the
  /// motion passes for one, and the freer it is, the more of it does.
  Status RefineWithDrift(const TextureAlignment& alignment, std::size_t points,
                         const std::function<void(double)>& progress) {
    const double delay_variance = refinement_.covariance(kDelay, kDelay);
    const bool delay_is_told = delay_variance < 0.25 * std::pow(refinement_.prior_sigma[kDelay], 2);
    // How everything else goes along with the delay.
    PlacementVector by_delay = PlacementVector::Zero();
    if (delay_variance > 0.0) by_delay = refinement_.covariance.col(kDelay) / delay_variance;
    const TrajectoryDrift drift(views_, kKnotSpacing_s, kMaxKnots);
    AlignmentPrior prior{refinement_.prior_sigma, DriftFactor(views_, drift)};
    prior.placement_sigma[kDelay] = 0.0;
    const Result<bool> settled = Settle(alignment, points, prior, drift, kConverged, progress);
    if (!settled) return settled.error();
    if (!*settled) return NotSettled();
    refinement_.covariance += delay_variance * by_delay * by_delay.transpose();
    refinement_.observed_directions += delay_is_told ? 1 : 0;
    return OkStatus();
  }

  /// Poses that are off along the motion pass for a delay, and the images agree: the drift that is
  /// solved for does not show it. Not more than was known before.
  double DelaySigmaOfDriftAlong() const {
    const double drift_px = views_.pose_drift_m * PixelsPerMetre(views_).value_or(0.0);
    constexpr double kWholeScan_s = std::numeric_limits<double>::infinity();
    return std::min(refinement_.prior_sigma[kDelay],
                    DelaySigmaOfDrift(ImageVelocities(views_), drift_px, kWholeScan_s));
  }

  /// A step back from where the last one led: both go too far, for gradients are means of images
  /// that do not agree yet.
  bool TurnsBack(const PlacementVector& step, const PlacementVector& last) const {
    const PlacementVector sigma = refinement_.prior_sigma.cwiseMax(1e-12);
    return step.cwiseQuotient(sigma).dot(last.cwiseQuotient(sigma)) < 0.0;
  }

  static Status NotSettled() {
    return FailedPrecondition(
        fmt::format("the search does not settle within {} steps: scan for longer, to and fro, "
                    "nearer and farther",
                    kMaxIterations));
  }

  static Status TooFew(const AlignmentEquations& equations) {
    return FailedPrecondition(fmt::format(
        "temperatures change along the surface at {} of {} points that the thermal camera sees "
        "often enough, {} are needed: scan something with warm and cold parts, for ten seconds or "
        "more",
        equations.textured_points, equations.seen_points, kMinTexturedPoints));
  }

  const ScanViews& views_;
  ThreadPool& pool_;
  const std::stop_token& stop_;
  std::optional<TextureAlignment> alignment_;  ///< The present level has it.
  Refinement refinement_;
};

}  // namespace

double Refinement::Sigma(PlacementParameter parameter) const {
  return std::sqrt(covariance(parameter, parameter));
}

bool Refinement::Tells(PlacementParameter parameter) const {
  return Sigma(parameter) < 0.5 * prior_sigma[parameter];
}

Result<Refinement> RefinePlacement(const ScanViews& views, const ThermalPlacement& before,
                                   const RefinementPrior& prior, const LookAgain& look_again,
                                   ThreadPool& pool, const std::function<void(double)>& progress,
                                   const std::stop_token& stop) {
  Refiner refiner(views, before, prior, pool, stop);
  constexpr double kLevelCount = std::size(kLevels);
  double done = 0.0;
  for (const Level& level : kLevels) {
    if (stop.stop_requested()) return Err(ToldToStop());
    const Status seen =
        look_again(refiner.placement(), level.range_s,
                   PartOf(progress, done / kLevelCount, (done + 0.5) / kLevelCount));
    if (!seen.ok()) return Err(seen);
    const Status refined = refiner.Refine(
        level, PartOf(progress, (done + 0.5) / kLevelCount, (done + 1.0) / kLevelCount));
    if (!refined.ok()) return Err(refined);
    done += 1.0;
  }
  return refiner.Finish();
}

}  // namespace isotherm
