#include "ground/feedback/trackability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// With less known surface in view than the first, as a fraction of the rays, the tracker soon has
/// too few correspondences (it gives up at 0.3 of the valid pixels); more than the second makes
/// nothing surer. Not tuned.
constexpr double kTooFewRays = 0.25, kEnoughRays = 0.65;

/// Below the first tracking drifts along a direction when the rig stops or turns (below 0.0003 it
/// is given up: tracker.expert.min_observed), beyond the second it is sure: scenes with structure
/// are above 0.0026 (ADR 7). Larger: much of a nearly flat door (0.0005) is worth little; smaller:
/// the rig is sent to where it slides.
constexpr double kSlides = 0.0010, kHolds = 0.0030;

double Ramp(double value, double low, double high) {
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

}  // namespace

void Trackability::Add(const Eigen::Vector3d& p_map, const Eigen::Vector3d& n_map, double depth_m) {
  // The noise of depth grows with its square; as the tracker weighs it.
  const double weight = 1.0 / std::pow(depth_m, 4);
  Eigen::Matrix<double, 6, 1> change;
  change << n_map, (p_map - camera_map_).cross(n_map);
  sum_.noalias() += weight * change * change.transpose();
  weight_ += weight;
  depth_m_ += weight * depth_m;
  ++count_;
}

double Trackability::Strength() const {
  if (count_ == 0) return 0.0;
  Eigen::Matrix<double, 6, 1> scale = Eigen::Matrix<double, 6, 1>::Ones();
  scale.tail<3>().setConstant(weight_ / depth_m_);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(
      scale.asDiagonal() * (sum_ / weight_) * scale.asDiagonal(), Eigen::EigenvaluesOnly);
  return std::max(0.0, solver.eigenvalues()(0));
}

double Trackability::Firmness() const {
  return Ramp(surface(), kTooFewRays, kEnoughRays) * Ramp(Strength(), kSlides, kHolds);
}

}  // namespace isotherm
