#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/rigid_transform.h"
#include "ground/atlas/pose_graph.h"
#include "ground/atlas/sub_map.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

Status Validate(const SubMapOptions& options);

/// Holds what the sub-maps told about drift so far.
struct DriftReport {
  std::uint64_t closures = 0;  ///< Times that geometry was met again that another sub-map has.
  double last_gap_m = 0.0;     ///< By how much the newest closure was missed before it was
  double last_gap_rad = 0.0;   ///< spread over the sub-maps, in the depth camera's position.
  double largest_gap_m = 0.0;
};

/// All sub-maps of a scan. One of them is active: the rig is tracked against it and fused into it.
/// A new one is begun as the scan gets far from where the active one was begun, and takes over what
/// is in view; or when the rig was lost for long, and then it is not joined yet. When a view is
/// verified in two sub-maps, they are linked, and what does not fit is spread over all links.
/// All share the scan volume's grid, each in its own coordinates. Thread-bound.
class Atlas {
 public:
  /// Begins the first sub-map.
  Atlas(const GroundOptions& options, const CameraModel& depth_camera, const VoxelGrid& grid);

  SubMap& active() { return *maps_[active_]; }
  const SubMap& active() const { return *maps_[active_]; }
  int active_index() const { return active_; }
  int size() const { return static_cast<int>(maps_.size()); }
  const SubMap& map(int index) const { return *maps_[index]; }
  SubMap& map(int index) { return *maps_[index]; }

  /// Returns whether a pose is too far from all anchors of its sub-map to go on in that.
  bool IsFar(int index, const RigidTransform& T_map_depth) const;
  /// Begins a sub-map at a tracked pose, in the same coordinates; the blocks in view go with it.
  /// False (and nothing changes) if there are too many.
  bool Split(const RigidTransform& T_map_depth, std::span<const std::int32_t> blocks_in_view);
  /// Begins one that has nothing to do with the others yet.
  bool BeginElsewhere();
  /// Goes on in another one.
  void Activate(int index);

  /// Sub-maps which may show what is seen from a pose in the active one: not linked with it yet,
  /// and scanned from nearby. For one that is not joined: all others.
  std::vector<int> ToVerify(const RigidTransform& T_map_depth) const;
  bool IsLinked(int a, int b) const;
  /// One of the views from which sub-map `index` was scanned is near a pose in its coordinates.
  bool IsNearView(int index, const RigidTransform& T_map_depth) const;
  /// The pose of a view of the active sub-map in another one, if both are joined.
  std::optional<RigidTransform> PoseIn(int index, const RigidTransform& T_active_depth) const;

  /// A pose and its covariance in `world`; nullopt while their sub-map is not joined.
  std::optional<WorldPose> ToWorld(const MapPose& pose) const;

  /// Closes the loop: the same view was found, and verified, in the active sub-map and in another.
  void Link(int other, const RigidTransform& T_active_depth, const RigidTransform& T_other_depth);
  const DriftReport& drift() const { return drift_; }

  /// Forgets the temperatures of the active sub-map, and what is known about them. False if there
  /// is no room for new ones.
  bool ForgetTemperatures();

  /// Puts all joined sub-maps into the first one, which becomes the active one. The others, which
  /// were never joined, stay apart. `progress` gets a fraction 0..1. False if there was no room for
  /// all temperatures.
  bool Merge(double max_weight, ThreadPool& pool, const std::function<void(double)>& progress);

 private:
  std::unique_ptr<SubMap> MakeMap() const;
  std::unique_ptr<ThermalVolume> MakeThermal(std::int32_t max_blocks) const;
  std::int32_t BlocksLeft() const;

  const GroundOptions options_;
  const CameraModel depth_camera_;
  const VoxelGrid grid_;
  const std::int32_t max_blocks_;  ///< All sub-maps together.
  std::vector<std::unique_ptr<SubMap>> maps_;
  std::vector<MapLink> links_;
  int active_ = 0;
  DriftReport drift_;
};

}  // namespace isotherm
