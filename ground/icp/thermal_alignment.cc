#include "ground/icp/thermal_alignment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/quantile.h"
#include "ground/icp/icp_tracker.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {
namespace {

// Cells of 4 x 4 pixels have a quarter of a pixel's noise, and temperatures on walls are smooth
// over them. Larger: fine patterns vanish; smaller: more noise and time. Not tuned.
constexpr int kHalvings = 2;
constexpr int kCell = 1 << kHalvings;
constexpr int kCellPixels = kCell * kCell;

/// Points across the model's view: about 2000 in all.
constexpr int kPointsAcross = 54;
// A seventh of what a full view gives. Fewer do not tell an image's shift from its noise. Not
// tuned.
constexpr std::size_t kMinSamples = 300;
/// A reference of which less than this fraction is in view is replaced.
constexpr double kMinOverlap = 0.6;

constexpr int kMaxIterations = 20;  ///< Two or three do, but after a while without images.
// Far below a pixel of the reduced image, which is centimetres at scanning distance.
constexpr double kConverged_m = 1e-4;
/// Further off than this from the motion before, the image is not where it seems to be.
constexpr double kMaxShift_m = 0.1;
/// Residuals beyond this many standard deviations (by the median, so that they do not count) are
/// something else than noise, and than the image's shift.
constexpr double kOutlier = 3.0;
constexpr double kSigmaOfMedian = 1.4826;
constexpr double kMinSpread_k =
    0.02;  ///< Counts of some centi-kelvin spread so far, however little noise there is.
/// A fit that leaves more than this part of the reference's variance unexplained is none.
constexpr double kMaxUnexplained = 0.25;
/// Neighbouring cells share pixels by interpolation: about one of this many samples counts.
constexpr double kSamplesPerValue = 4.0;

/// Older frames say nothing about where the first depth frame was.
constexpr double kMaxAgeAtStart_s = 0.05;

}  // namespace

/// About the mean over the samples, so that the level does not count.
struct ThermalAlignment::Sums {
  int in_view = 0;
  int count = 0;          ///< How many of those are summed.
  double median_k = 0.0;  ///< Median of the residuals in view.
  double spread_k = 0.0;  ///< Standard deviation of the residuals in view, if they are normal.
  double mean_square_k2 = 0.0;  ///< Mean square of those summed, about their mean.
  /// Mean of the reference's derivatives times the image's, K^2/m^2: noise, which is independent
  /// in both, averages out and does not look like structure.
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();  ///< Mean of derivative times residual, K^2/m.
};

ThermalAlignment::ThermalAlignment(const CameraModel& thermal_camera,
                                   const RigidTransform& T_thermal_depth, double min_gradient_k_m,
                                   double prior_sigma_m_s)
    : camera_(thermal_camera.WithoutDistortion().Downscaled(kHalvings)),
      T_depth_thermal_(T_thermal_depth.inverse()),
      min_gradient_k_m_(min_gradient_k_m),
      prior_sigma_m_s_(prior_sigma_m_s) {
  const CameraModel ideal = thermal_camera.WithoutDistortion();
  source_.reserve(static_cast<std::size_t>(camera_.width * camera_.height * kCellPixels));
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      for (int i = 0; i < kCellPixels; ++i) {
        const Eigen::Vector2d pixel(u * kCell + i % kCell, v * kCell + i / kCell);
        const Eigen::Vector2d source = ProjectNormalized(thermal_camera, Unproject(ideal, pixel));
        const int x =
            std::clamp(static_cast<int>(std::lround(source.x())), 0, thermal_camera.width - 1);
        const int y =
            std::clamp(static_cast<int>(std::lround(source.y())), 0, thermal_camera.height - 1);
        // The nearest pixel, not interpolated: the mean over sixteen of them averages the rounding
        // out.
        source_.push_back(y * thermal_camera.width + x);
      }
    }
  }
}

void ThermalAlignment::Reduce(const ThermalFrame& frame, Image<float>& celsius) const {
  celsius.Resize(camera_.width, camera_.height);
  const std::int32_t* source = source_.data();
  for (float& cell : celsius.pixels()) {
    std::uint32_t sum = 0;
    bool whole = true;
    for (int i = 0; i < kCellPixels; ++i) {
      const std::uint16_t raw = frame.temperature_raw.data()[*source++];
      sum += raw;
      // A mean without the missing pixels would be of another place than the cell's middle.
      whole = whole && raw != 0;
    }
    cell = whole ? frame.scale.Celsius(static_cast<double>(sum) / kCellPixels) : NAN;
  }
}

std::optional<ThermalAlignment::Sample> ThermalAlignment::Look(const Image<float>& celsius,
                                                               const RigidTransform& T_map_thermal,
                                                               const Eigen::Vector3d& p_map) const {
  const Eigen::Matrix3d& R = T_map_thermal.linear();
  const Eigen::Vector3d p = R.transpose() * (p_map - T_map_thermal.translation());
  if (!(p.z() > 0.0)) return std::nullopt;
  const double u = camera_.fx * p.x() / p.z() + camera_.cx;
  const double v = camera_.fy * p.y() / p.z() + camera_.cy;
  if (!(u >= 0.0 && v >= 0.0 && u < celsius.width() - 1 && v < celsius.height() - 1))
    return std::nullopt;
  const int x = static_cast<int>(u);
  const int y = static_cast<int>(v);
  const double s = u - x;
  const double t = v - y;
  const double top_left = celsius.At(x, y);
  const double top_right = celsius.At(x + 1, y);
  const double bottom_left = celsius.At(x, y + 1);
  const double bottom_right = celsius.At(x + 1, y + 1);
  const double top = top_left + s * (top_right - top_left);
  const double bottom = bottom_left + s * (bottom_right - bottom_left);
  const double du = (1.0 - t) * (top_right - top_left) + t * (bottom_right - bottom_left);
  const double dv = bottom - top;
  const double value = top + t * (bottom - top);
  if (!std::isfinite(value)) return std::nullopt;
  // Chain rule through the projection: the change of temperature when the point moves by a metre.
  const Eigen::Vector3d in_camera(camera_.fx * du / p.z(), camera_.fy * dv / p.z(),
                                  -(du * (u - camera_.cx) + dv * (v - camera_.cy)) / p.z());
  return Sample{p_map, value, R * in_camera};
}

void ThermalAlignment::MakeReference(const SurfaceMaps& model_points) {
  reference_.clear();
  if (!placed_) return;
  Image<float> celsius;
  Reduce(*placed_, celsius);
  const int step = std::max(1, (model_points.width() + kPointsAcross - 1) / kPointsAcross);
  double sum = 0.0;
  double squares = 0.0;
  for (int y = step / 2; y < model_points.height(); y += step) {
    for (int x = step / 2; x < model_points.width(); x += step) {
      const Eigen::Vector3d p(model_points.vx.At(x, y), model_points.vy.At(x, y),
                              model_points.vz.At(x, y));
      const auto sample = p.allFinite() ? Look(celsius, T_map_placed_, p) : std::nullopt;
      if (!sample) continue;
      reference_.push_back(*sample);
      sum += sample->celsius;
      squares += sample->celsius * sample->celsius;
    }
  }
  if (reference_.size() < kMinSamples) return reference_.clear();
  const auto count = static_cast<double>(reference_.size());
  reference_variance_k2_ = squares / count - sum * sum / (count * count);
  reference_sigma_m_ = placed_sigma_m_;
}

void ThermalAlignment::Begin(const std::optional<StampedMapPose>& last, CaptureTime time,
                             const RigidTransform& guess) {
  has_image_ = false;
  is_reduced_ = false;
  was_wanted_ = false;
  was_measured_ = false;
  reference_leaves_view_ = false;
  if (!newest_ || !last) return;
  const CaptureTime taken = newest_->header.capture_time;
  if (taken <= last->time || taken > time) return;
  // From the thermal to the depth frame the motion before goes on. To interpolate instead would
  // make the last pose's error, turned over, this one's.
  const double fraction = ToSeconds(taken - last->time) / ToSeconds(time - last->time);
  RigidTransform motion = last->T_map_depth.inverse() * guess;
  // The way back from where it was believed to be meanwhile is no motion to go on.
  if (since_gap_ == 1) motion.setIdentity();
  T_depth_then_ = motion.inverse() * Interpolate(RigidTransform::Identity(), motion, fraction);
  behind_s_ = ToSeconds(time - taken);
  has_image_ = true;
}

ThermalAlignment::Sums ThermalAlignment::Accumulate(const RigidTransform& T_map_depth,
                                                    const Observability& motion, const Sums& last) {
  const RigidTransform T_map_thermal = T_map_depth * T_depth_then_ * T_depth_thermal_;
  // When the camera moves by a twist, the point moves by its inverse.
  const Matrix6 to_axes = -motion.axes.transpose() * motion.scale.asDiagonal();
  Matrix6 products = Matrix6::Zero();
  Vector6 with_residual = Vector6::Zero();
  Vector6 sum_before = Vector6::Zero();
  Vector6 sum_now = Vector6::Zero();
  double sum_residual = 0.0;
  double squares = 0.0;
  Sums sums;
  const double limit_k = last.in_view > 0 ? kOutlier * last.spread_k : HUGE_VAL;
  residuals_.clear();
  for (const Sample& before : reference_) {
    const auto now = Look(image_, T_map_thermal, before.p_map);
    if (!now) continue;
    const double residual = now->celsius - before.celsius;
    residuals_.push_back(residual);
    if (std::abs(residual - last.median_k) > limit_k) continue;
    const Eigen::Vector3d arm = before.p_map - T_map_depth.translation();
    Vector6 jacobian_before;
    jacobian_before << before.gradient, arm.cross(before.gradient);
    Vector6 jacobian_now;
    jacobian_now << now->gradient, arm.cross(now->gradient);
    // As in Observability: two gradients with independent noise, so that noise alone does not look
    // like a pattern.
    const Vector6 j_before = to_axes * jacobian_before;
    const Vector6 j_now = to_axes * jacobian_now;
    products += j_before * j_now.transpose();
    with_residual += 0.5 * residual * (j_before + j_now);
    sum_before += j_before;
    sum_now += j_now;
    sum_residual += residual;
    squares += residual * residual;
    ++sums.count;
  }
  sums.in_view = static_cast<int>(residuals_.size());
  if (sums.count == 0) return sums;
  sums.median_k = TakeMedian(residuals_);
  for (double& residual : residuals_) residual = std::abs(residual - sums.median_k);
  sums.spread_k = std::max(kMinSpread_k, kSigmaOfMedian * TakeMedian(residuals_));
  const double fraction = 1.0 / sums.count;
  // Covariance instead of mean square: the level, which shutter events move, drops out.
  const Matrix6 H = fraction * products - fraction * fraction * (sum_before * sum_now.transpose());
  sums.H = 0.5 * (H + H.transpose());
  const double level_k = fraction * sum_residual;
  sums.g = fraction * with_residual - 0.5 * fraction * level_k * (sum_before + sum_now);
  sums.mean_square_k2 = std::max(0.0, squares * fraction - level_k * level_k);
  return sums;
}

Matrix6 ThermalAlignment::Shifts(const RigidTransform& T_map_depth,
                                 const Observability& motion) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Sample& sample : reference_) {
    const Eigen::Vector3d arm = sample.p_map - T_map_depth.translation();
    sum += arm;
    squares += arm * arm.transpose();
  }
  const double fraction = 1.0 / static_cast<double>(reference_.size());
  // Of the point's motion v + w x arm, squared.
  Eigen::Matrix3d cross;
  cross << 0.0, -sum.z(), sum.y(), sum.z(), 0.0, -sum.x(), -sum.y(), sum.x(), 0.0;
  Matrix6 shifts = Matrix6::Identity();
  shifts.bottomLeftCorner<3, 3>() = fraction * cross;
  shifts.topRightCorner<3, 3>() = fraction * cross.transpose();
  shifts.bottomRightCorner<3, 3>() =
      fraction * (squares.trace() * Eigen::Matrix3d::Identity() - squares);
  const Matrix6 twists = motion.scale.asDiagonal() * motion.axes;
  return twists.transpose() * shifts * twists;
}

Eigen::VectorXd ThermalAlignment::FindObserved(const Eigen::MatrixXd& H,
                                               const Eigen::MatrixXd& shifts,
                                               ThermalFit& fit) const {
  fit.observed = 0;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(H);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::Index unobservable = H.cols();
  fit.rotation.resize(unobservable, unobservable);
  Eigen::VectorXd strength(unobservable);
  Eigen::Index held = 0;
  for (Eigen::Index i = unobservable - 1; i >= 0; --i) {
    const Eigen::VectorXd axis = solver.eigenvectors().col(i);
    const double value = solver.eigenvalues()(i);
    const bool observed = value >= min_gradient_k_m_ * min_gradient_k_m_ * axis.dot(shifts * axis);
    const Eigen::Index column = observed ? unobservable - ++fit.observed : held++;
    fit.rotation.col(column) = axis;
    strength(column) = value;
  }
  return strength;
}

std::optional<ThermalFit> ThermalAlignment::Align(const Observability& motion,
                                                  const SurfaceMaps& model_points,
                                                  RigidTransform& T_map_depth) {
  was_wanted_ = true;
  was_measured_ = false;
  if (!has_image_) return std::nullopt;
  if (reference_.empty()) MakeReference(model_points);
  if (reference_.empty()) return std::nullopt;
  if (!is_reduced_) Reduce(*newest_, image_);
  is_reduced_ = true;
  const int unobservable = motion.unobservable_axes;
  const Eigen::MatrixXd shifts =
      Shifts(T_map_depth, motion).topLeftCorner(unobservable, unobservable);
  RigidTransform pose = T_map_depth;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(unobservable);
  Sums sums = Accumulate(pose, motion, Sums());
  ThermalFit fit;
  double last_step_m = HUGE_VAL;
  for (int i = 0; i < kMaxIterations && last_step_m > kConverged_m; ++i) {
    sums = Accumulate(pose, motion, sums);
    reference_leaves_view_ = sums.in_view < kMinOverlap * static_cast<double>(reference_.size());
    if (sums.count < 0.5 * kMinOverlap * static_cast<double>(reference_.size()))
      return std::nullopt;
    const Eigen::VectorXd strength =
        FindObserved(sums.H.topLeftCorner(unobservable, unobservable), shifts, fit);
    if (fit.observed == 0) return std::nullopt;
    const Eigen::MatrixXd kept = fit.rotation.rightCols(fit.observed);
    const Eigen::VectorXd kept_strength = strength.tail(fit.observed);
    const Eigen::VectorXd slope = kept.transpose() * sums.g.head(unobservable);
    const Eigen::VectorXd step = -(kept * slope.cwiseQuotient(kept_strength));
    // The variance along an axis: of the mean over independent values, by the slope.
    const double values = sums.count / kSamplesPerValue;
    const double ahead_m = prior_sigma_m_s_ * behind_s_;
    fit.variance_m2 = (sums.mean_square_k2 / values) * kept_strength.cwiseInverse();
    fit.variance_m2.array() += reference_sigma_m_ * reference_sigma_m_ + ahead_m * ahead_m;
    moved += step;
    if (!(moved.norm() < kMaxShift_m)) return std::nullopt;
    ApplyTwist(motion.scale.cwiseProduct(motion.axes.leftCols(unobservable) * step), pose);
    last_step_m = step.norm();
  }
  if (last_step_m > 10.0 * kConverged_m) return std::nullopt;
  if (sums.mean_square_k2 > kMaxUnexplained * reference_variance_k2_) return std::nullopt;
  T_map_depth = pose;
  was_measured_ = true;
  return fit;
}

void ThermalAlignment::End(const std::optional<StampedMapPose>& before, const StampedMapPose& last,
                           double sigma_m) {
  // A reference from before the geometry sufficed is older than need be.
  if (!was_wanted_ || reference_leaves_view_) reference_.clear();
  const bool ends_gap = since_gap_ == 0 && was_measured_;
  since_gap_ = was_wanted_ && !was_measured_ ? 0 : std::min(since_gap_ + 1, kNoGap);
  if (!newest_ || newest_ == placed_) return;
  const CaptureTime taken = newest_->header.capture_time;
  if (taken > last.time) return;
  if (ends_gap) {
    T_map_placed_ = last.T_map_depth * T_depth_then_ * T_depth_thermal_;
  } else if (before && taken > before->time) {
    const double fraction = ToSeconds(taken - before->time) / ToSeconds(last.time - before->time);
    T_map_placed_ = Interpolate(before->T_map_depth, last.T_map_depth, fraction) * T_depth_thermal_;
  } else if (!before && ToSeconds(last.time - taken) < kMaxAgeAtStart_s) {
    T_map_placed_ = last.T_map_depth * T_depth_thermal_;
  } else {
    return;
  }
  placed_ = newest_;
  placed_sigma_m_ = sigma_m;
}

void ThermalAlignment::Forget() {
  placed_.reset();
  reference_.clear();
  has_image_ = false;
  since_gap_ = kNoGap;
}

}  // namespace isotherm
