#include "ground/tracker/trajectory.h"

#include <optional>

namespace isotherm {

void Trajectory::Add(const StampedMapPose& pose, const PoseSigma& sigma, int map,
                     const Atlas& atlas) {
  tracked_.push_back({pose, sigma, map});
  Append(tracked_.back(), atlas);
}

void Trajectory::Update(const Atlas& atlas) {
  poses_.clear();
  sigmas_.clear();
  for (const TrackedPose& tracked : tracked_) Append(tracked, atlas);
}

void Trajectory::Append(const TrackedPose& tracked, const Atlas& atlas) {
  const std::optional<WorldPose> world =
      atlas.ToWorld({.map = tracked.map, .T_map_depth = tracked.pose.T_map_depth});
  // Poses in a sub-map that is not joined have no place in `world` yet; Update brings them in
  // later.
  if (!world) return;
  poses_.push_back({tracked.pose.time, world->T_world_depth});
  sigmas_.push_back(tracked.sigma);
}

}  // namespace isotherm
