#include "ground/icp/icp_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/base/enum_array.h"
#include "common/base/units.h"
#include "ground/icp/icp_kernel.h"
#include "ground/icp/odometry_stream.h"
#include "ground/icp/thermal_alignment.h"

namespace isotherm {
namespace {

constexpr EnumArray<LostReason, std::string_view> kLostReasons = {
    {LostReason::kNone, "none"},
    {LostReason::kNotFound, "not_found"},
    {LostReason::kOutsideVolume, "outside_volume"},
    {LostReason::kResidual, "residual"},
    {LostReason::kSingular, "singular"},
    {LostReason::kStep, "step"},
    {LostReason::kTooFewInliers, "too_few_inliers"},
    {LostReason::kTooFewPixels, "too_few_pixels"}};

/// The finest level (480 rows) makes 60 tasks, the coarsest 15. More rows: threads wait for the
/// last one at the coarse levels; fewer: more sums to add up afterwards. Not tuned.
constexpr int kRowsPerTask = 8;

IcpSums ToIcpSums(const IcpKernelSums& strip) {
  IcpSums result;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) result.H(i, j) = result.H(j, i) = strip.sums[k++];
  }
  for (int i = 0; i < 6; ++i) result.g(i) = strip.sums[k++];
  result.squared_residuals_m2 = strip.sums[k];
  result.inliers = strip.inliers;
  result.candidates = strip.candidates;
  result.overlap = strip.overlap;
  return result;
}

/// Row-major rotation and translation in single precision.
void CopyTransform(const RigidTransform& transform, float* R, float* t) {
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rotation = transform.linear().cast<float>();
  const Eigen::Vector3f translation = transform.translation().cast<float>();
  std::copy_n(rotation.data(), 9, R);
  std::copy_n(translation.data(), 3, t);
}

/// The bilateral filter and the normals mix a pixel with its neighbours, so that errors within a
/// window of 5 x 5 pixels are nearly the same: one pixel in that window counts. A smaller number
/// makes the covariance too small, and thermal frames are then fused at a pose that is not known
/// well enough. Not fitted to errors.
constexpr double kPixelsPerSample = 25.0;

/// Returns the covariance along the observed axes, from the residual and the normal equations of
/// the last iteration.
Matrix6 ObservedCovariance(const IcpSums& sums, const TrackingResult& result) {
  const double weight = sums.H.topLeftCorner<3, 3>().trace();  // Normals have length 1.
  if (!(weight > 0.0) || result.motion.unobservable_axes == 6) return Matrix6::Zero();
  // H was summed with weights relative to the reference depth; divided by their sum it is the
  // information of one mean pixel.
  const double samples = static_cast<double>(sums.inliers) / kPixelsPerSample;
  const Observability& motion = result.motion;
  const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> basis =
      motion.scale.asDiagonal() * motion.axes.rightCols(6 - motion.unobservable_axes);
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> information =
      basis.transpose() * sums.H * basis / weight;
  return basis * information.inverse() * basis.transpose() *
         (result.residual_m * result.residual_m / samples);
}

/// Makes the axes that temperatures observe observed ones: they go behind the axes that stay
/// unobservable.
void Adopt(const ThermalFit& fit, TrackingResult& result) {
  Observability& motion = result.motion;
  const Matrix6 before = motion.axes;
  motion.axes.leftCols(motion.unobservable_axes) =
      before.leftCols(motion.unobservable_axes) * fit.rotation;
  motion.unobservable_axes -= fit.observed;
  for (int i = 0; i < fit.observed; ++i) {
    const Vector6 twist = motion.scale.cwiseProduct(motion.axes.col(motion.unobservable_axes + i));
    result.covariance += fit.variance_m2(i) * twist * twist.transpose();
  }
}

/// Notes how the frame fits the model at the pose that `sums` are of.
void NoteFit(const IcpSums& sums, TrackingResult& result) {
  ++result.iterations;
  result.inlier_ratio = sums.inlier_ratio();
  result.overlap_ratio = sums.overlap_ratio();
  result.agreement = sums.agreement();
  result.residual_m = sums.residual_m();
}

/// Returns the step towards the model in the observed directions. Without one `result` is lost.
std::optional<Vector6> SolveStep(const IcpSums& sums, TrackingResult& result) {
  // Each correspondence gives one equation.
  constexpr std::int64_t kUnknowns = 6;
  if (sums.inliers < kUnknowns) {
    result.lost = LostReason::kTooFewInliers;
    return std::nullopt;
  }
  // Only the observed directions are solved for. In the others noise decides where the minimum is.
  const std::optional<Vector6> step = result.motion.SolveObserved(sums.H, sums.g);
  if (!step) result.lost = LostReason::kSingular;
  return step;
}

}  // namespace

Vector6 TwistBetween(const RigidTransform& from, const RigidTransform& to) {
  const Eigen::AngleAxisd rotation(
      Eigen::Quaterniond(to.linear() * from.linear().transpose()).normalized());
  Vector6 twist;
  twist << to.translation() - from.translation(), rotation.angle() * rotation.axis();
  return twist;
}

void ApplyTwist(const Vector6& twist, RigidTransform& T_map_depth) {
  const RigidTransform update = TransformFromTwist(twist);
  T_map_depth.linear() = update.linear() * T_map_depth.linear();
  T_map_depth.translation() += update.translation();
}

std::string_view ToString(LostReason reason) { return kLostReasons[reason]; }

Status Validate(const TrackerOptions& o) {
  if (o.expert().iterations_coarse() < 0 || o.expert().iterations_middle() < 0 ||
      o.expert().iterations_fine() < 1 ||
      o.expert().iterations_coarse() + o.expert().iterations_middle() +
              o.expert().iterations_fine() >
          1000) {
    return InvalidArgument(
        "tracker.expert: iterations must not be negative, iterations_fine at least 1, 1000 in all");
  }
  if (!(o.expert().max_distance_m() > 0.0 && o.expert().max_normal_angle_deg() > 0.0 &&
        o.expert().max_normal_angle_deg() <= 90.0)) {
    return InvalidArgument(
        "tracker.expert: max_distance_m must be positive and max_normal_angle_deg in (0, 90]");
  }
  if (!(o.expert().min_inlier_ratio() >= 0.0 && o.expert().min_inlier_ratio() <= 1.0 &&
        o.expert().max_residual_m() > 0.0 && o.expert().max_step_m() > 0.0 &&
        o.expert().max_step_deg() > 0.0)) {
    return InvalidArgument(
        "tracker.expert: min_inlier_ratio must be 0..1; max_residual_m, max_step_m and "
        "max_step_deg must be positive");
  }
  if (!(o.expert().min_observed() >= 0.0 && o.expert().min_observed() <= 0.1)) {
    return InvalidArgument(
        fmt::format("tracker.expert.min_observed must be 0 (never hold) to 0.1, got {}",
                    o.expert().min_observed()));
  }
  if (!(o.expert().prior_sigma_m_s() >= 0.0 && o.expert().prior_sigma_m_s() <= 100.0)) {
    return InvalidArgument(fmt::format("tracker.expert.prior_sigma_m_s must be 0..100 m/s, got {}",
                                       o.expert().prior_sigma_m_s()));
  }
  if (!(o.expert().thermal_min_gradient_k_m() > 0.0 &&
        o.expert().thermal_min_gradient_k_m() <= 10'000.0)) {
    return InvalidArgument(fmt::format(
        "tracker.expert.thermal_min_gradient_k_m must be above 0 and at most 10000 K/m, got {}",
        o.expert().thermal_min_gradient_k_m()));
  }
  return Validate(o.external_odometry());
}

IcpSums& IcpSums::operator+=(const IcpSums& other) {
  H += other.H;
  g += other.g;
  squared_residuals_m2 += other.squared_residuals_m2;
  inliers += other.inliers;
  candidates += other.candidates;
  overlap += other.overlap;
  return *this;
}

IcpSums AccumulateIcp(const SurfaceMaps& current, const RigidTransform& T_map_depth,
                      const ModelView& model, const VoxelGrid& grid, const IcpLimits& limits,
                      ThreadPool& pool) {
  IcpKernelArgs args{};
  args.current = &current;
  args.model = &model.maps;
  CopyTransform(T_map_depth, args.R_map_depth, args.t_map_depth);
  CopyTransform(model.T_map_depth.inverse() * T_map_depth, args.R_model_depth, args.t_model_depth);
  args.fx = static_cast<float>(model.camera.fx);
  args.fy = static_cast<float>(model.camera.fy);
  args.cx = static_cast<float>(model.camera.cx);
  args.cy = static_cast<float>(model.camera.cy);
  const Eigen::Vector3f volume_min = grid.min_m.cast<float>();
  const Eigen::Vector3f volume_max = grid.max_m().cast<float>();
  std::copy_n(volume_min.data(), 3, args.volume_min);
  std::copy_n(volume_max.data(), 3, args.volume_max);
  args.max_squared_distance_m2 = limits.max_distance_m * limits.max_distance_m;
  args.min_normal_cosine = limits.min_normal_cosine;
  args.reference_depth_m = kIcpReferenceDepth;

  const int height = current.height();
  const int strips = (height + kRowsPerTask - 1) / kRowsPerTask;
  std::vector<IcpKernelSums> partial(static_cast<std::size_t>(strips));
  pool.ParallelFor(strips, [&](int strip) {
    AccumulateIcpRows(args, strip * kRowsPerTask, std::min(height, (strip + 1) * kRowsPerTask),
                      partial[strip]);
  });
  IcpSums total;  // In order, so that the result does not depend on the thread count.
  for (const IcpKernelSums& sums : partial) total += ToIcpSums(sums);
  return total;
}

TrackingResult IcpTracker::Track(const PreparedDepth& depth, const ModelView& model,
                                 const VoxelGrid& grid, const Start& start,
                                 ThreadPool& pool) const {
  TrackingResult result;
  result.T_map_depth = start.guess;
  if (depth.valid_pixels < kMinTrackedPixels) {
    result.lost = LostReason::kTooFewPixels;
    return result;
  }
  HoldUnobservable(depth, model, start, result);
  const IcpSums last = Iterate(depth, model, grid, pool, result);
  if (!result.tracked()) return result;
  // A product of dozens of small rotations is no longer quite a rotation; the drift would add up
  // over frames.
  result.T_map_depth.linear() =
      Eigen::Quaterniond(result.T_map_depth.linear()).normalized().toRotationMatrix();
  result.covariance = ObservedCovariance(last, result);
  if (start.alignment != nullptr && !result.motion.fully_observed()) {
    // Once more, where the geometry has put it.
    const auto fit = start.alignment->Align(result.motion, model.maps, result.T_map_depth);
    if (fit) Adopt(*fit, result);
  }
  result.step_m = TranslationDistance(model.T_map_depth, result.T_map_depth);
  result.step_rad = RotationAngle(model.T_map_depth, result.T_map_depth);
  // The normals of a young model are too rough to reject correspondences fairly: with voxels of 1
  // mm no second frame was accepted without this. Larger: a scan with small voxels does not begin;
  // smaller: a wrong second frame passes.
  constexpr double kYoungFraction = 1.0 / 3.0;
  return Assess(result,
                options_.expert().min_inlier_ratio() * (model.is_young ? kYoungFraction : 1.0));
}

IcpLimits IcpTracker::Limits() const {
  return {static_cast<float>(options_.expert().max_distance_m()),
          static_cast<float>(std::cos(options_.expert().max_normal_angle_deg() * kRadPerDeg))};
}

void IcpTracker::HoldUnobservable(const PreparedDepth& depth, const ModelView& model,
                                  const Start& start, TrackingResult& result) const {
  // The normals of a young model are rough, and quantised in steps as the frame's are, so that
  // their noise is not independent: a plane looks more structured than it is, and the limit is
  // doubled for it.
  result.motion =
      MeasureObservability(depth.maps[kPyramidLevels - 1], start.guess, model, Limits(),
                           (model.is_young ? 2.0 : 1.0) * options_.expert().min_observed());
  if (result.motion.fully_observed()) return;
  // ICP below cannot move the pose along these axes, so it starts there where the prior says.
  ApplyTwist(result.motion.UnobservablePart(TwistBetween(start.guess, start.prior)),
             result.T_map_depth);
  if (start.alignment != nullptr)
    start.alignment->Align(result.motion, model.maps, result.T_map_depth);
}

IcpSums IcpTracker::Iterate(const PreparedDepth& depth, const ModelView& model,
                            const VoxelGrid& grid, ThreadPool& pool, TrackingResult& result) const {
  IcpSums last;
  const std::array<int, kPyramidLevels> iterations = {options_.expert().iterations_fine(),
                                                      options_.expert().iterations_middle(),
                                                      options_.expert().iterations_coarse()};
  // Coarse to fine: at a quarter of the size a correspondence reaches four times as far, and costs
  // a sixteenth.
  for (int level = kPyramidLevels - 1; level >= 0; --level) {
    for (int iteration = 0; iteration < iterations[level]; ++iteration) {
      const IcpSums sums =
          AccumulateIcp(depth.maps[level], result.T_map_depth, model, grid, Limits(), pool);
      NoteFit(sums, result);
      const std::optional<Vector6> step = SolveStep(sums, result);
      if (!step) return last;  // It is lost.
      last = sums;
      ApplyTwist(*step, result.T_map_depth);
      if (IsLastStep(*step)) break;
    }
  }
  return last;
}

bool IcpTracker::IsLastStep(const Vector6& twist) const {
  return twist.head<3>().norm() < options_.expert().min_update_m() &&
         twist.tail<3>().norm() < options_.expert().min_update_deg() * kRadPerDeg;
}

TrackingResult IcpTracker::Assess(TrackingResult result, double min_inlier_ratio) const {
  if (!result.T_map_depth.matrix().allFinite()) {
    result.lost = LostReason::kSingular;
  } else if (result.inlier_ratio < min_inlier_ratio) {
    result.lost = LostReason::kTooFewInliers;
  } else if (result.residual_m > options_.expert().max_residual_m()) {
    result.lost = LostReason::kResidual;
  } else if (result.step_m > options_.expert().max_step_m() ||
             result.step_rad > options_.expert().max_step_deg() * kRadPerDeg) {
    result.lost = LostReason::kStep;
  }
  return result;
}

}  // namespace isotherm
