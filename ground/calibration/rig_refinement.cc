#include "ground/calibration/rig_refinement.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
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
  bool with_drift;
};
// Blurred images lead from far away. Sharp ones decide: a blur is not equally wide on all of a
// surface, which pulls the principal point by pixels.
constexpr Level kLevels[] = {{8.0, 0.06, 3000, false},
                             {4.0, 0.03, 3000, false},
                             {2.0, 0.01, 3000, false},
                             {0.0, 0.01, 30'000, true}};
constexpr int kMaxIterations = 10;
// The end of the iterations, in standard deviations of the prior: where blurred images lead need
// not be exact.
constexpr double kConverged = 0.005, kNearEnough = 0.02;
// Points that held-out images are compared at.
constexpr std::size_t kHeldOutPoints = 6000;
// Fewer points with a gradient in temperature are an edge or two, which leave most directions open.
constexpr int kMinTexturedPoints = 300;
// Knots of the drift: as often as a person turns back, but no more than can be solved for in
// seconds.
constexpr double kKnotSpacing_s = 0.7;
constexpr int kMaxKnots = 24;
// What one knot is off by: half of what poses drift by within seconds (ScanViews::pose_drift_m),
// which is a cautious figure for a verdict. Rendered scans are off by as much along each axis.
constexpr double kDriftOfKnot = 0.5;
// What is wrong alike in the whole scan, so that its parts do not show it: blur and inertia of the
// camera, the surface that drifting poses made. On simulated scans of 15 s with all of a PI 450's
// faults errors are as large on average.
constexpr double kCommonRotation_rad = 0.0002, kCommonTranslation_m = 0.0002;
constexpr double kCommonDelay_s = 0.0004, kCommonPrincipal_px = 0.1;
// The same of a turn whose shift of the image a shift of the principal point takes back: defocus
// moves such pairs by up to 0.13 degrees and half a pixel in scans of 10 s.
constexpr double kCommonPair_rad = 0.0012;
// Frames and points of each that the shift in the image is measured at.
constexpr std::size_t kShiftFrames = 40, kShiftPoints = 200;

PlacementVector SigmasOf(const RefinementPrior& prior) {
  PlacementVector sigma;
  sigma << Eigen::Vector3d::Constant(prior.rotation_rad),
      Eigen::Vector3d::Constant(prior.translation_m), prior.delay_s,
      Eigen::Vector2d::Constant(prior.principal_point_px);
  return sigma;
}

/// The covariance of what no part of the scan tells, of values that are not to be kept.
PlacementMatrix CommonCovariance(const CameraModel& camera, const PlacementVector& prior_sigma) {
  const PlacementVector alone = SigmasOf({.rotation_rad = kCommonRotation_rad,
                                          .translation_m = kCommonTranslation_m,
                                          .delay_s = kCommonDelay_s,
                                          .principal_point_px = kCommonPrincipal_px});
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

Eigen::VectorXd DriftSigmas(const ScanViews& views, const TrajectoryDrift& drift) {
  const double shift_m = kDriftOfKnot * views.pose_drift_m;
  // A turn that moves the surface as far in the image.
  const double turn_rad = shift_m * PixelsPerMetre(views).value_or(0.0) / views.thermal_camera.fx;
  Eigen::VectorXd sigmas(drift.size());
  for (int i = 0; i < drift.size(); i += TrajectoryDrift::kPerKnot) {
    sigmas.segment<3>(i).setConstant(shift_m);
    sigmas.segment<3>(i + 3).setConstant(turn_rad);
  }
  return sigmas;
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

/// Corrects the placement step by step.
class Refiner {
 public:
  Refiner(const ScanViews& views, const ThermalPlacement& before, const RefinementPrior& prior,
          ThreadPool& pool)
      : views_(views), pool_(pool) {
    refinement_.before = refinement_.after = before;
    refinement_.prior_sigma = SigmasOf(prior);
  }

  const ThermalPlacement& placement() const { return refinement_.after; }

  /// The views show the scan from `placement`.
  Status Refine(const Level& level, const std::function<void(double)>& progress) {
    TextureAlignment alignment(views_, pool_);
    alignment.BlurImages(level.blur_px);
    TrajectoryDrift drift;
    if (level.with_drift) drift = TrajectoryDrift(views_, kKnotSpacing_s, kMaxKnots);
    const AlignmentPrior prior{refinement_.prior_sigma, DriftSigmas(views_, drift)};
    for (int i = 0; i < kMaxIterations; ++i) {
      const AlignmentEquations equations =
          alignment.Linearize(refinement_.after, drift, level.points);
      if (equations.textured_points < kMinTexturedPoints) {
        // A blur may hide what sharp images show.
        return level.blur_px > 0.0 ? OkStatus() : TooFew(equations);
      }
      const AlignmentStep step =
          SolveAlignment(equations, prior, CorrectionBetween(refinement_.before, refinement_.after),
                         drift.values());
      refinement_.covariance = step.covariance;
      refinement_.observed_directions = step.observed_directions;
      refinement_.textured_points = equations.textured_points;
      refinement_.points = equations.seen_points;
      refinement_.after = Corrected(refinement_.after, step.placement);
      drift.Add(step.drift);
      if (progress) progress((i + 1.0) / kMaxIterations);
      // The drift follows the placement.
      if (step.length < (level.with_drift ? kConverged : kNearEnough) && i > 0) return OkStatus();
    }
    if (!level.with_drift) return OkStatus();
    return FailedPrecondition(
        fmt::format("the search does not settle within {} steps: scan for longer, to and fro, "
                    "nearer and farther",
                    kMaxIterations));
  }

  /// After the last level.
  Refinement Finish() {
    TextureAlignment alignment(views_, pool_);
    refinement_.held_out =
        alignment.CompareHeldOut(refinement_.before, refinement_.after, kHeldOutPoints);
    refinement_.correction = CorrectionBetween(refinement_.before, refinement_.after);
    refinement_.covariance += CommonCovariance(refinement_.after.camera, refinement_.prior_sigma);
    refinement_.shift = ShiftOf(views_, refinement_);
    refinement_.frames = static_cast<std::size_t>(
        std::count_if(views_.frames.begin(), views_.frames.end(),
                      [](const StampedThermal& frame) { return !frame.visible.empty(); }));
    return std::move(refinement_);
  }

 private:
  static Status TooFew(const AlignmentEquations& equations) {
    return FailedPrecondition(fmt::format(
        "temperatures change along the surface at {} of {} points that the thermal camera sees "
        "often enough, {} are needed: scan something with warm and cold parts, for ten seconds or "
        "more",
        equations.textured_points, equations.seen_points, kMinTexturedPoints));
  }

  const ScanViews& views_;
  ThreadPool& pool_;
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
                                   ThreadPool& pool, const std::function<void(double)>& progress) {
  Refiner refiner(views, before, prior, pool);
  constexpr double kLevelCount = std::size(kLevels);
  double done = 0.0;
  for (const Level& level : kLevels) {
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
