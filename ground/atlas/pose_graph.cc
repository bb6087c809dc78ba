#include "ground/atlas/pose_graph.h"

#include <Eigen/Dense>
#include <cstddef>

namespace isotherm {
namespace {

using PoseError = Eigen::Matrix<double, 6, 1>;
using PoseJacobian = Eigen::Matrix<double, 6, 6>;

// Gauss-Newton on a handful of poses that are off by centimetres; the limit ends what does not
// converge. Converged is a step far below any pose's uncertainty.
constexpr int kIterations = 20;
constexpr double kConverged = 1e-9;

/// Metres and radians over their standard deviations.
PoseError Residual(const MapLink& link, const RigidTransform& T_world_a,
                   const RigidTransform& T_world_b) {
  const RigidTransform mismatch = Mismatch(link, T_world_a, T_world_b);
  const Eigen::AngleAxisd rotation(mismatch.linear());
  PoseError residual;
  residual << mismatch.translation() / link.sigma_m,
      rotation.angle() * rotation.axis() / link.sigma_rad;
  return residual;
}

/// Change of the residual when one of the two sub-maps moves; central differences, exact enough
/// for a handful of links.
template <typename ResidualOf>
PoseJacobian Differentiate(const RigidTransform& T_world_map, const ResidualOf& residual_of) {
  // A micrometre and a microradian: small against any mismatch, large against rounding.
  constexpr double kStep = 1e-6;
  PoseJacobian jacobian;
  for (int axis = 0; axis < 6; ++axis) {
    const PoseError step = kStep * PoseError::Unit(axis);
    jacobian.col(axis) = (residual_of(T_world_map * TransformFromTwist(step)) -
                          residual_of(T_world_map * TransformFromTwist(-step))) /
                         (2.0 * kStep);
  }
  return jacobian;
}

/// Place of each sub-map among the unknowns, -1 = does not move.
std::vector<int> MovingMaps(std::span<const MapLink> links, std::size_t count) {
  std::vector<bool> connected(count, false);
  // The first sub-map is held: links say only how maps lie to each other, and without it the system
  // would have six directions that cost nothing.
  connected[0] = true;
  for (bool grows = true; grows;) {
    grows = false;
    for (const MapLink& link : links) {
      if (connected[link.a] == connected[link.b]) continue;
      connected[link.a] = connected[link.b] = grows = true;
    }
  }
  std::vector<int> place(count, -1);
  int next = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (connected[i]) place[i] = next++;
  }
  return place;
}

}  // namespace

RigidTransform Mismatch(const MapLink& link, const RigidTransform& T_world_a,
                        const RigidTransform& T_world_b) {
  return (T_world_a * link.T_a_depth).inverse() * (T_world_b * link.T_b_depth);
}

void OptimisePoseGraph(std::span<const MapLink> links, std::vector<RigidTransform>& T_world_map) {
  if (T_world_map.empty()) return;
  const std::vector<int> place = MovingMaps(links, T_world_map.size());
  Eigen::Index unknowns = 0;
  for (const int p : place) unknowns += p >= 0 ? 6 : 0;
  if (unknowns == 0) return;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(unknowns);
    for (const MapLink& link : links) {
      const RigidTransform& a = T_world_map[link.a];
      const RigidTransform& b = T_world_map[link.b];
      const PoseError residual = Residual(link, a, b);
      // Both ends of a link move by a twist on their right side, in their own coordinates, as the
      // step below does.
      const std::array<PoseJacobian, 2> jacobians = {
          Differentiate(a, [&](const RigidTransform& moved) { return Residual(link, moved, b); }),
          Differentiate(b, [&](const RigidTransform& moved) { return Residual(link, a, moved); })};
      const std::array<int, 2> places = {place[link.a], place[link.b]};
      for (int i = 0; i < 2; ++i) {
        if (places[i] < 0) continue;
        g.segment<6>(6 * places[i]) += jacobians[i].transpose() * residual;
        for (int j = 0; j < 2; ++j) {
          if (places[j] < 0) continue;
          H.block<6, 6>(6 * places[i], 6 * places[j]) += jacobians[i].transpose() * jacobians[j];
        }
      }
    }
    const Eigen::VectorXd step = H.ldlt().solve(-g);
    // Links without finite uncertainties make the system singular: the poses so far are kept.
    if (!step.allFinite()) return;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (place[i] < 0) continue;
      T_world_map[i] = T_world_map[i] * TransformFromTwist(step.segment<6>(6 * place[i]));
    }
    if (step.norm() < kConverged) return;
  }
}

}  // namespace isotherm
