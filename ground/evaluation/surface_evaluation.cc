#include "ground/evaluation/surface_evaluation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/quantile.h"

namespace isotherm {
namespace {

struct PlanePair {
  Eigen::Vector3d p;      // Point of the cloud, moved by the current estimate.
  Eigen::Vector3d n;      // Normal of its disc.
  double offset_m = 0.0;  // Signed distance to the disc's plane.
};

std::vector<PlanePair> Pairs(const std::vector<Eigen::Vector3f>& cloud, std::size_t step,
                             const RigidTransform& motion, const TrueSurface& truth) {
  std::vector<PlanePair> pairs;
  std::vector<double> magnitudes;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    const Eigen::Vector3d p = motion * cloud[i].cast<double>();
    const auto foot = truth.Project(p.cast<float>());
    if (!foot) continue;
    const Eigen::Vector3d n = truth.points().normals[foot->disc].cast<double>();
    const Eigen::Vector3d q = truth.points().positions_m[foot->disc].cast<double>();
    pairs.push_back({p, n, n.dot(p - q)});
    magnitudes.push_back(foot->distance_m);
  }
  if (pairs.empty()) return pairs;
  std::vector<double> sorted = magnitudes;
  // Skirts and surface that the truth lacks must not pull the fit.
  constexpr double kOutlierMedians = 3.0;
  const double limit = kOutlierMedians * TakeMedian(sorted);
  std::vector<PlanePair> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (magnitudes[i] <= limit) inliers.push_back(pairs[i]);
  }
  return inliers;
}

std::vector<double> Distances(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth) {
  std::vector<double> distances;
  distances.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud) {
    if (const auto foot = truth.Project(p)) distances.push_back(foot->distance_m);
  }
  return distances;
}

double Completeness(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth,
                    const SurfaceEvaluationOptions& options, std::size_t& counted) {
  const PointIndex index(cloud);
  const TruePoints& points = truth.points();
  std::size_t found = 0;
  counted = 0;
  for (std::size_t i = 0; i < points.positions_m.size(); ++i) {
    if (!points.seen.empty() && points.seen[i] < options.min_seen) continue;
    ++counted;
    if (index.Nearest(points.positions_m[i], options.complete_within_m)) ++found;
  }
  return counted == 0 ? std::numeric_limits<double>::quiet_NaN()
                      : static_cast<double>(found) / static_cast<double>(counted);
}

}  // namespace

RigidTransform FitToSurface(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth) {
  // Points of the cloud that are fitted. More: more time; fewer: the noise of single points shows
  // in the motion. Not tuned.
  constexpr std::size_t kSamples = 20000;
  // Point-to-plane steps converge in a few; a fit that needs more begins too far away to be right.
  constexpr int kIterations = 15;
  constexpr double kConverged = 1e-7;  // Metres and radians.
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSamples);
  RigidTransform motion = RigidTransform::Identity();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    for (const PlanePair& pair : Pairs(cloud, step, motion, truth)) {
      Eigen::Matrix<double, 6, 1> row;
      row << pair.n, pair.p.cross(pair.n);
      A += row * row.transpose();
      b -= row * pair.offset_m;
    }
    // Damped, so that directions that the surface does not determine stay as they are.
    constexpr double kDamping = 1e-9;
    A.diagonal().array() += kDamping * A.trace() + std::numeric_limits<double>::min();
    const Eigen::Matrix<double, 6, 1> twist = A.ldlt().solve(b);
    if (!twist.allFinite()) break;
    motion = TransformFromTwist(twist) * motion;
    if (twist.norm() < kConverged) break;
  }
  return motion;
}

SurfaceErrors EvaluateSurface(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth,
                              const SurfaceEvaluationOptions& options) {
  SurfaceErrors errors;
  errors.distance_m = Summarize(Distances(cloud, truth));
  errors.completeness = Completeness(cloud, truth, options, errors.surface_points);
  errors.fit = FitToSurface(cloud, truth);
  const std::vector<Eigen::Vector3f> fitted = Transformed(errors.fit, cloud);
  errors.fitted_distance_m = Summarize(Distances(fitted, truth));
  errors.fitted_completeness = Completeness(fitted, truth, options, errors.surface_points);
  return errors;
}

}  // namespace isotherm
