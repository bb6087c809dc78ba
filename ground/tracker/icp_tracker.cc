#include "ground/tracker/icp_tracker.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace isotherm {
namespace {

constexpr int kRowsPerTask = 8;
constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Depth at which an observation has weight 1, metres.
constexpr float kReferenceDepth = 0.5F;

/// Upper triangle of H (21), g (6), squared residuals, in single precision for one strip of rows.
struct StripSums {
  std::array<float, 28> sums{};
  std::int64_t inliers = 0;
  std::int64_t candidates = 0;

  void Add(const std::array<float, 6>& J, float residual, float weight) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const float weighted = weight * J[i];
      for (std::size_t j = i; j < 6; ++j) sums[k++] += weighted * J[j];
    }
    for (std::size_t i = 0; i < 6; ++i) sums[k++] += weight * J[i] * residual;
    sums[k] += residual * residual;
    ++inliers;
  }

  IcpSums ToIcpSums() const {
    IcpSums result;
    std::size_t k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) result.H(i, j) = result.H(j, i) = sums[k++];
    }
    for (int i = 0; i < 6; ++i) result.g(i) = sums[k++];
    result.squared_residuals_m2 = sums[k];
    result.inliers = inliers;
    result.candidates = candidates;
    return result;
  }
};

/// Single-precision copies of all that a strip needs.
struct StripContext {
  const SurfaceMaps& current;
  const SurfaceMaps& model;
  Eigen::Matrix3f R_world_depth;
  Eigen::Vector3f t_world_depth;
  Eigen::Matrix3f R_model_world;
  Eigen::Vector3f t_model_world;
  float fx, fy, cx, cy;
  Eigen::Vector3f volume_min, volume_max, centre;
  float max_squared_distance, min_normal_cosine;
};

void AccumulateRow(const StripContext& c, int y, StripSums& sums) {
  const auto vertex = [](const SurfaceMaps& m, std::size_t i) {
    return Eigen::Vector3f(m.vx.data()[i], m.vy.data()[i], m.vz.data()[i]);
  };
  const auto normal = [](const SurfaceMaps& m, std::size_t i) {
    return Eigen::Vector3f(m.nx.data()[i], m.ny.data()[i], m.nz.data()[i]);
  };
  const int width = c.current.width();
  for (int x = 0; x < width; ++x) {
    const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    const float depth = c.current.vz.data()[i];
    if (!(depth > 0.0F)) continue;
    const Eigen::Vector3f p = c.R_world_depth * vertex(c.current, i) + c.t_world_depth;
    if ((p.array() < c.volume_min.array()).any() || (p.array() > c.volume_max.array()).any()) continue;
    ++sums.candidates;
    const Eigen::Vector3f p_model = c.R_model_world * p + c.t_model_world;
    if (!(p_model.z() > 0.0F)) continue;
    const int u = static_cast<int>(std::floor(c.fx * p_model.x() / p_model.z() + c.cx + 0.5F));
    const int v = static_cast<int>(std::floor(c.fy * p_model.y() / p_model.z() + c.cy + 0.5F));
    if (!c.model.vx.Contains(u, v)) continue;
    const auto j = static_cast<std::size_t>(v) * static_cast<std::size_t>(c.model.width()) +
                   static_cast<std::size_t>(u);
    const Eigen::Vector3f q = vertex(c.model, j);
    const Eigen::Vector3f difference = p - q;
    if (!(difference.squaredNorm() < c.max_squared_distance)) continue;  // Also refuses NaN.
    const Eigen::Vector3f n = normal(c.model, j);
    if (!(n.dot(c.R_world_depth * normal(c.current, i)) > c.min_normal_cosine)) continue;
    const float weight = std::pow(kReferenceDepth / depth, 4.0F);
    const Eigen::Vector3f rotation = (p - c.centre).cross(n);
    sums.Add({n.x(), n.y(), n.z(), rotation.x(), rotation.y(), rotation.z()}, n.dot(difference), weight);
  }
}

}  // namespace

std::string_view ToString(LostReason reason) {
  switch (reason) {
    case LostReason::kNone:
      return "none";
    case LostReason::kTooFewPixels:
      return "too_few_pixels";
    case LostReason::kTooFewInliers:
      return "too_few_inliers";
    case LostReason::kResidual:
      return "residual";
    case LostReason::kStep:
      return "step";
    case LostReason::kSingular:
      return "singular";
  }
  return "unknown";
}

Status Validate(const TrackerOptions& o) {
  if (o.iterations_coarse() < 0 || o.iterations_middle() < 0 || o.iterations_fine() < 1 ||
      o.iterations_coarse() + o.iterations_middle() + o.iterations_fine() > 1000) {
    return InvalidArgument("tracker: iterations must not be negative, iterations_fine at least 1, 1000 in all");
  }
  if (!(o.max_distance_m() > 0.0 && o.max_normal_angle_deg() > 0.0 && o.max_normal_angle_deg() <= 90.0)) {
    return InvalidArgument("tracker: max_distance_m must be positive and max_normal_angle_deg in (0, 90]");
  }
  if (!(o.min_inlier_ratio() >= 0.0 && o.min_inlier_ratio() <= 1.0 && o.max_residual_m() > 0.0 &&
        o.max_step_m() > 0.0 && o.max_step_deg() > 0.0)) {
    return InvalidArgument(
        "tracker: min_inlier_ratio must be 0..1; max_residual_m, max_step_m and max_step_deg must be positive");
  }
  return OkStatus();
}

IcpSums& IcpSums::operator+=(const IcpSums& other) {
  H += other.H;
  g += other.g;
  squared_residuals_m2 += other.squared_residuals_m2;
  inliers += other.inliers;
  candidates += other.candidates;
  return *this;
}

IcpSums AccumulateIcp(const SurfaceMaps& current, const RigidTransform& T_world_depth, const ModelView& model,
                      const VoxelGrid& grid, const IcpLimits& limits, const Eigen::Vector3d& centre,
                      ThreadPool& pool) {
  const RigidTransform T_model_world = model.T_world_depth.inverse();
  const StripContext context{current,
                             model.maps,
                             T_world_depth.linear().cast<float>(),
                             T_world_depth.translation().cast<float>(),
                             T_model_world.linear().cast<float>(),
                             T_model_world.translation().cast<float>(),
                             static_cast<float>(model.camera.fx),
                             static_cast<float>(model.camera.fy),
                             static_cast<float>(model.camera.cx),
                             static_cast<float>(model.camera.cy),
                             grid.min_m.cast<float>(),
                             grid.max_m().cast<float>(),
                             centre.cast<float>(),
                             limits.max_distance_m * limits.max_distance_m,
                             limits.min_normal_cosine};
  const int height = current.height();
  const int strips = (height + kRowsPerTask - 1) / kRowsPerTask;
  std::vector<StripSums> partial(static_cast<std::size_t>(strips));
  pool.ParallelFor(strips, [&](int strip) {
    const int end = std::min(height, (strip + 1) * kRowsPerTask);
    for (int y = strip * kRowsPerTask; y < end; ++y) AccumulateRow(context, y, partial[strip]);
  });
  IcpSums total;  // In order, so that the result does not depend on the thread count.
  for (const StripSums& sums : partial) total += sums.ToIcpSums();
  return total;
}

TrackingResult IcpTracker::Track(const PreparedDepth& depth, const ModelView& model, const VoxelGrid& grid,
                                 const RigidTransform& guess, ThreadPool& pool) const {
  TrackingResult result;
  result.T_world_depth = guess;
  constexpr int kMinPixels = 1000;
  if (depth.valid_pixels < kMinPixels) {
    result.lost = LostReason::kTooFewPixels;
    return result;
  }
  const IcpLimits limits{static_cast<float>(options_.max_distance_m()),
                         static_cast<float>(std::cos(options_.max_normal_angle_deg() * kRadPerDeg))};
  const std::array<int, kPyramidLevels> iterations = {options_.iterations_fine(), options_.iterations_middle(),
                                                      options_.iterations_coarse()};
  for (int level = kPyramidLevels - 1; level >= 0; --level) {
    for (int iteration = 0; iteration < iterations[level]; ++iteration) {
      const Eigen::Vector3d centre = result.T_world_depth.translation();
      const IcpSums sums =
          AccumulateIcp(depth.maps[level], result.T_world_depth, model, grid, limits, centre, pool);
      ++result.iterations;
      result.inlier_ratio =
          static_cast<double>(sums.inliers) / static_cast<double>(std::max<std::int64_t>(sums.candidates, 1));
      result.residual_m =
          std::sqrt(sums.squared_residuals_m2 / static_cast<double>(std::max<std::int64_t>(sums.inliers, 1)));
      const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> ldlt(sums.H);
      if (sums.inliers < 6 || ldlt.info() != Eigen::Success || !ldlt.isPositive() ||
          ldlt.vectorD().minCoeff() <= 1e-9 * ldlt.vectorD().maxCoeff()) {
        result.lost = sums.inliers < 6 ? LostReason::kTooFewInliers : LostReason::kSingular;
        return result;
      }
      const Eigen::Matrix<double, 6, 1> twist = ldlt.solve(-sums.g);
      // The twist acts about the camera: rotate about its centre, then translate.
      const RigidTransform update = TransformFromTwist(twist);
      result.T_world_depth.linear() = update.linear() * result.T_world_depth.linear();
      result.T_world_depth.translation() += update.translation();
      if (twist.head<3>().norm() < options_.min_update_m() &&
          twist.tail<3>().norm() < options_.min_update_deg() * kRadPerDeg) {
        break;
      }
    }
  }
  result.T_world_depth.linear() =
      Eigen::Quaterniond(result.T_world_depth.linear()).normalized().toRotationMatrix();
  result.step_m = TranslationDistance(model.T_world_depth, result.T_world_depth);
  result.step_rad = RotationAngle(model.T_world_depth, result.T_world_depth);
  return Judge(result);
}

TrackingResult IcpTracker::Judge(TrackingResult result) const {
  if (!result.T_world_depth.matrix().allFinite()) {
    result.lost = LostReason::kSingular;
  } else if (result.inlier_ratio < options_.min_inlier_ratio()) {
    result.lost = LostReason::kTooFewInliers;
  } else if (result.residual_m > options_.max_residual_m()) {
    result.lost = LostReason::kResidual;
  } else if (result.step_m > options_.max_step_m() || result.step_rad > options_.max_step_deg() * kRadPerDeg) {
    result.lost = LostReason::kStep;
  }
  return result;
}

}  // namespace isotherm
