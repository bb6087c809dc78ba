#pragma once

#include <vector>

#include "common/geometry/camera.h"
#include "common/simulation/scene.h"
#include "ground/experiment/scripted_operator.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// The side of a scene that an operator sees from the front: what the rays along +z meet.
struct SceneFront {
  Eigen::AlignedBox2d region_m;  ///< In x and y of `world`.
  double median_z_m = 0.0;
};
SceneFront FrontOf(const Scene& scene);

/// How an operator without guidance scans by plan: back and forth over the front in rows that
/// overlap, the thermal camera in the middle of the good distances, first straight on, then askew
/// from four sides so far that faces at right angles to the front are seen at a good angle, too.
/// Rows are gone along at `speed_m_s`; between passes the rig is turned. `limits` come from
/// CompleteLimits. Where a part of the scene is in the way the plan has no waypoint.
std::vector<Waypoint> RasterPath(const Scene& scene, const Rig& rig, const ThermalOptions& limits,
                                 double speed_m_s);

/// Returns the speed at which thermal images are smeared by four fifths of what is good, at the
/// distance of the raster. The rest is for sway, and for what is nearer.
double RasterSpeed(const Rig& rig, const ThermalOptions& limits);

}  // namespace isotherm
