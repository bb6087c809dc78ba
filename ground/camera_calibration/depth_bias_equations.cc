#include "ground/camera_calibration/depth_bias_equations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "common/rig/depth_bias_nodes.h"

namespace isotherm {
namespace {

// Before anything was seen, standard deviations: of a multiplier, of its bend from node to node and
// of its change from distance to distance.
constexpr double kPrior = 0.03, kPriorBend = 0.005, kPriorStep = 0.01;
// What a wall does not tell is right by definition: distances in the middle of the image, and what
// turns walls.
constexpr double kDefined = 1e-6;

}  // namespace

DepthBiasEquations::DepthBiasEquations(const DepthBias& table)
    : table_(table),
      information_(Eigen::MatrixXd::Zero(Size(), Size())),
      right_(Eigen::VectorXd::Zero(Size())) {}

void DepthBiasEquations::AddPrior() {
  AddSmoothness();
  for (int k = 0; k < static_cast<int>(table_.distances_m.size()); ++k) AddMiddle(k);
  AddTurns();
}

void DepthBiasEquations::AddSmoothness() {
  for (int k = 0; k < static_cast<int>(table_.distances_m.size()); ++k)
    for (int row = 0; row < table_.rows; ++row)
      for (int column = 0; column < table_.columns; ++column) {
        const int node = Index(k, row, column);
        Add({{node, 1.0}}, 1.0, kPrior);
        if (column > 1) AddBend(node, 1);
        if (row > 1) AddBend(node, table_.columns);
        if (k > 0) Add({{node, 1.0}, {Index(k - 1, row, column), -1.0}}, 0.0, kPriorStep);
      }
}

void DepthBiasEquations::AddMiddle(int layer) {
  const NodeShares at =
      SharesAt(table_, 0.5, 0.5, table_.distances_m[static_cast<std::size_t>(layer)]);
  std::map<int, double> shares;
  for (std::size_t i = 0; i < at.nodes.size(); ++i)
    shares[static_cast<int>(at.nodes[i])] += at.shares[i];
  Add({shares.begin(), shares.end()}, 1.0, kDefined);
}

/// Planes stay planes if all inverse depths change by a multiple of the direction: multipliers that
/// grow across or down the image, and with the distance. Around the middle of the image there is
/// none of that.
void DepthBiasEquations::AddTurns() {
  constexpr int kReach = 1;
  const int row = table_.rows / 2, column = table_.columns / 2;
  std::vector<std::pair<int, double>> across, down;
  for (int k = 0; k < static_cast<int>(table_.distances_m.size()); ++k) {
    const double distance_m = table_.distances_m[static_cast<std::size_t>(k)];
    across.emplace_back(Index(k, row, column + kReach), distance_m);
    across.emplace_back(Index(k, row, column - kReach), -distance_m);
    down.emplace_back(Index(k, row + kReach, column), distance_m);
    down.emplace_back(Index(k, row - kReach, column), -distance_m);
  }
  Add(across, 0.0, kDefined);
  Add(down, 0.0, kDefined);
}

void DepthBiasEquations::AddBend(int node, int stride) {
  Add({{node, 1.0}, {node - stride, -2.0}, {node - 2 * stride, 1.0}}, 0.0, kPriorBend);
}

void DepthBiasEquations::AddView(const WallView& view, std::span<const double> weights,
                                 double sigma) {
  // Of fewer the plane is not certain.
  constexpr int kMinPatches = 20;
  if (std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0.0; }) < kMinPatches)
    return;
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(Size(), 3);
  Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
  double mean_inverse = 0.0;
  for (const WallPatch& patch : view.patches) mean_inverse += patch.inverse_depth;
  mean_inverse /= static_cast<double>(view.patches.size());
  for (std::size_t i = 0; i < view.patches.size(); ++i) {
    const WallPatch& patch = view.patches[i];
    const double weight = weights[i] / std::pow(sigma * mean_inverse, 2);
    if (weight == 0.0) continue;
    const NodeShares at = SharesAt(table_, patch.across, patch.down, patch.Distance_m());
    const Eigen::Vector3d ray = patch.Ray();
    planes += weight * ray * ray.transpose();
    for (std::size_t a = 0; a < 8; ++a) {
      const double scaled = weight * patch.inverse_depth * at.shares[a];
      mixed.row(static_cast<Eigen::Index>(at.nodes[a])) += scaled * ray.transpose();
      for (std::size_t b = 0; b < 8; ++b)
        information_(static_cast<Eigen::Index>(at.nodes[a]),
                     static_cast<Eigen::Index>(at.nodes[b])) +=
            scaled * patch.inverse_depth * at.shares[b];
    }
  }
  information_ -= mixed * planes.ldlt().solve(mixed.transpose());
}

std::vector<float> DepthBiasEquations::Solve() const {
  const Eigen::VectorXd reciprocals = information_.ldlt().solve(right_);
  std::vector<float> multipliers;
  for (const double reciprocal : reciprocals)
    multipliers.push_back(static_cast<float>(1.0 / reciprocal));
  return multipliers;
}

void DepthBiasEquations::Add(const std::vector<std::pair<int, double>>& parts, double value,
                             double sigma) {
  const double weight = 1.0 / (sigma * sigma);
  for (const auto& [node, part] : parts) {
    right_[node] += weight * part * value;
    for (const auto& [other, other_part] : parts)
      information_(node, other) += weight * part * other_part;
  }
}

}  // namespace isotherm
