#pragma once

#include <span>

#include "ground/evaluation/error_statistics.h"
#include "ground/evaluation/true_surface.h"

namespace isotherm {

/// Says which true surface counts and when it counts as there.
struct SurfaceEvaluationOptions {
  /// Surface counts for completeness if at least this many sampled poses see it.
  std::uint32_t min_seen = 3;
  /// Such surface is there if the cloud has a point within this distance.
  float complete_within_m = 0.005F;
};

/// Holds how far a point cloud is from the true surface and how much of it is there.
struct SurfaceErrors {
  ErrorStatistics distance_m;         ///< Cloud to true surface, the first poses made equal.
  ErrorStatistics fitted_distance_m;  ///< The same after the rigid motion that fits the cloud best.
  RigidTransform fit =
      RigidTransform::Identity();  ///< The motion that fits the cloud, in the truth's world.
  std::size_t surface_points = 0;  ///< True points that count for completeness.
  double completeness =
      0.0;  ///< Fraction of them with a point of the cloud nearby, first poses equal.
  double fitted_completeness = 0.0;
};

/// Compares a cloud, in the truth's world, with the true surface.
SurfaceErrors EvaluateSurface(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth,
                              const SurfaceEvaluationOptions& options);

/// The small rigid motion that brings `cloud` nearest to the true surface: point-to-plane ICP over
/// a sample of the points, those further off than three times the median left out.
RigidTransform FitToSurface(const std::vector<Eigen::Vector3f>& cloud, const TrueSurface& truth);

}  // namespace isotherm
