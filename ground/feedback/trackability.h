#pragma once

#include <Eigen/Core>

namespace isotherm {

/// Sums up how firmly the rig could be tracked from a view of the model: whether the depth camera
/// sees enough surface, and whether that surface holds the camera in all directions, as the
/// tracker will find (Observability). A bare wall lets it slide. Thread-compatible.
class Trackability {
 public:
  /// `camera_map` is where the depth camera would be; `rays` are looked along.
  Trackability(const Eigen::Vector3d& camera_map, int rays)
      : camera_map_(camera_map), rays_(rays) {}

  /// Takes a surface point that the depth camera would measure, `depth_m` along its optical axis;
  /// `n_map` is a unit normal.
  void Add(const Eigen::Vector3d& p_map, const Eigen::Vector3d& n_map, double depth_m);

  /// The fraction of the rays that meet surface.
  double surface() const { return static_cast<double>(count_) / rays_; }
  /// The mean square of the change of a point's distance per motion of the camera, for the motion
  /// that changes distances least; rotations count by their way at the mean depth. 0 of no points.
  double Strength() const;
  /// How sure tracking is, from 0 to 1: between one half and sure as much as there is surface, and
  /// as it holds the camera.
  double Firmness() const;

 private:
  const Eigen::Vector3d camera_map_;
  const int rays_;
  Eigen::Matrix<double, 6, 6> sum_ = Eigen::Matrix<double, 6, 6>::Zero();
  double weight_ = 0.0;
  double depth_m_ = 0.0;
  int count_ = 0;
};

}  // namespace isotherm
