#pragma once

#include <span>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// One view of the rig that is known in two sub-maps: they must agree where it was.
struct MapLink {
  int a = 0;  ///< Indices of the sub-maps.
  int b = 0;
  RigidTransform T_a_depth = RigidTransform::Identity();
  RigidTransform T_b_depth = RigidTransform::Identity();
  double sigma_m = 0.0;  ///< How well they must agree, one standard deviation.
  double sigma_rad = 0.0;
};

/// Returns how far two sub-maps placed at `T_world_a` and `T_world_b` disagree about the link's
/// view, as a T_a_b-like motion in the depth camera's coordinates.
RigidTransform Mismatch(const MapLink& link, const RigidTransform& T_world_a,
                        const RigidTransform& T_world_b);

/// Moves sub-maps so that all links are met as well as their uncertainties allow (least squares,
/// Gauss-Newton on rigid motions; Grisetti et al., A tutorial on graph-based SLAM, 2010). The first
/// sub-map stays where it is, and so do all that no chain of links connects with it.
void OptimisePoseGraph(std::span<const MapLink> links, std::vector<RigidTransform>& T_world_map);

}  // namespace isotherm
