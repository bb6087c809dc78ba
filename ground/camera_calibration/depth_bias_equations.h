#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "common/rig/depth_bias.h"
#include "ground/camera_calibration/wall_view.h"

namespace isotherm {

/// Solves for the reciprocals of a table's multipliers, to which inverse depths are proportional:
/// they and the planes of the views solve linear equations together.
class DepthBiasEquations {
 public:
  /// The sides and distances of `table` count. It must outlive this.
  explicit DepthBiasEquations(const DepthBias& table);

  /// Adds what is known before: nodes are about 1, smooth, 1 in the middle of the image, and do not
  /// turn walls.
  void AddPrior();

  /// A view of the wall whose plane is not known. `weights` of its patches; `sigma`: of an inverse
  /// depth, as a fraction.
  void AddView(const WallView& view, std::span<const double> weights, double sigma);

  /// The table's multipliers; what cannot be found is beyond what a table may hold (Validate).
  std::vector<float> Solve() const;

 private:
  int Size() const {
    return static_cast<int>(table_.distances_m.size()) * table_.rows * table_.columns;
  }
  int Index(int layer, int row, int column) const {
    return (layer * table_.rows + row) * table_.columns + column;
  }
  void AddSmoothness();
  void AddMiddle(int layer);
  void AddTurns();
  void AddBend(int node, int stride);
  /// The sum of these parts of nodes is `value`.
  void Add(const std::vector<std::pair<int, double>>& parts, double value, double sigma);

  const DepthBias& table_;
  Eigen::MatrixXd information_;
  Eigen::VectorXd right_;
};

}  // namespace isotherm
