#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/geometry/rigid_transform.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {

struct ModelView;
struct IcpLimits;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Tells which motions of the camera the geometry in view can measure. Motions are twists
/// (translation, rotation about the camera's position, in `map`) with rotations in metres at the
/// mean depth: twist = scale * motion, element by element.
struct Observability {
  Vector6 scale = Vector6::Ones();
  Matrix6 axes = Matrix6::Identity();  ///< Orthonormal columns, the least observed first.
  Vector6 strength = Vector6::Ones();  ///< Per axis: mean square of the change of a residual per
                                       ///< motion, 0 = slides along the surface.
  bool measured = false;               ///< There was enough to tell.
  int unobservable_axes = 0;           ///< The first ones, which are not observed.
  double mean_depth_m = 1.0;

  bool fully_observed() const { return unobservable_axes == 0; }
  /// The part of a twist along the unobservable axes, as a twist.
  Vector6 UnobservablePart(const Vector6& twist) const;
  /// Solves H twist = -g along the observed axes; nullopt if that is singular. The twist has no
  /// part along the free ones (solution remapping: Zhang, Kaess, Singh, ICRA 2016).
  std::optional<Vector6> SolveObserved(const Matrix6& H, const Vector6& g) const;
};

/// Measures which motions are observed between `current` (camera coordinates) and the model, with
/// associations as ICP's. The normals of both sides enter, one each into either factor: their noise
/// is independent, so that it does not look like structure, as it would in the square of one
/// side's. `min_strength` separates unobservable from observed axes. All are observed if there are
/// too few associations to tell.
Observability MeasureObservability(const SurfaceMaps& current, const RigidTransform& T_map_depth,
                                   const ModelView& model, const IcpLimits& limits,
                                   double min_strength);

}  // namespace isotherm
