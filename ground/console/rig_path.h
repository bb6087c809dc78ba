#pragma once

#include <Eigen/Core>
#include <vector>

#include "ground/console/live.pb.h"

namespace isotherm {

/// The way of the rig, thinned out as it gets long: no two points nearer than a step, which doubles
/// when there are too many. Thread-compatible.
class RigPath {
 public:
  void Clear() { *this = {}; }
  /// A tracked position in the coordinates of sub-map `map`. Returns whether the path has changed.
  bool Add(int map, const Eigen::Vector3d& position_m);
  /// The next point begins a new piece: tracking was lost in between.
  void Break() { is_broken_ = true; }
  live::Path ToMessage() const;
  std::size_t points() const;

 private:
  struct Piece {
    int map = 0;
    std::vector<Eigen::Vector3f> points;
  };
  void ThinOut();

  double step_m_ = 0.004;
  bool is_broken_ = false;
  std::vector<Piece> pieces_;
};

}  // namespace isotherm
