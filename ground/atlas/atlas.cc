#include "ground/atlas/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "ground/atlas/map_merger.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {
namespace {

/// How much a tracker drifts over a sub-map, and how well a view is verified in another one. Only
/// their ratio, ten to one, matters to how a mismatch is spread. Smaller: more of it stays at the
/// link that closed the loop; larger: that link alone decides. Not tuned; drift_test's orbit is 5.0
/// mm off before the closure and 0.5 mm after it.
constexpr double kDrift_m = 0.003;
constexpr double kDrift_rad = 0.004;
constexpr double kVerified_m = 0.0003;
constexpr double kVerified_rad = 0.0005;

/// A view looks at much the same as one that is nearer than this: at 0.6 m, with a field of view of
/// 58 degrees, half of it is common to both. Larger: looks are spent on sub-maps that show
/// something else; smaller: loops are closed late or never. Not tuned.
constexpr double kNearView_m = 0.3;
constexpr double kNearView_rad = 30.0 * kRadPerDeg;

}  // namespace

Status Validate(const SubMapOptions& o) {
  if (!(o.expert().max_rotation_deg() >= 0.0 && o.expert().max_rotation_deg() <= 180.0 &&
        o.expert().max_travel_m() >= 0.0 && o.expert().start_after_lost_s() >= 0.0)) {
    return InvalidArgument(fmt::format(
        "submaps.expert: max_rotation_deg must be 0..180 degrees, max_travel_m and "
        "start_after_lost_s not negative, got {}, {} m and {} s",
        o.expert().max_rotation_deg(), o.expert().max_travel_m(), o.expert().start_after_lost_s()));
  }
  if (o.expert().max_maps() < 1 || o.expert().max_maps() > 1000)
    return InvalidArgument(
        fmt::format("submaps.expert.max_maps must be 1..1000, got {}", o.expert().max_maps()));
  return OkStatus();
}

Atlas::Atlas(const GroundOptions& options, const CameraModel& depth_camera, const VoxelGrid& grid)
    : options_(options),
      depth_camera_(depth_camera),
      grid_(grid),
      max_blocks_(MaxBlocks(options.volume(), grid)) {
  maps_.push_back(MakeMap());
  maps_.front()->joined = true;
}

std::unique_ptr<SubMap> Atlas::MakeMap() const {
  // At least one, so that the volume can be made at all: a map without room stays empty, and the
  // scan goes on in the one before.
  const std::int32_t max_blocks = std::max(1, BlocksLeft());
  const std::string& spill_dir = options_.volume().spill_dir();
  auto map = std::make_unique<SubMap>();
  map->tsdf = std::make_unique<TsdfVolume>(
      grid_, TruncationDistance(options_.tsdf(), options_.volume()), max_blocks, spill_dir);
  map->thermal = MakeThermal(max_blocks);
  map->relocaliser = std::make_unique<Relocaliser>(options_.relocaliser(), depth_camera_);
  return map;
}

std::unique_ptr<ThermalVolume> Atlas::MakeThermal(std::int32_t max_blocks) const {
  return std::make_unique<ThermalVolume>(max_blocks, options_.volume().spill_dir(),
                                         options_.thermal().expert().records());
}

bool Atlas::ForgetTemperatures() {
  SubMap& map = active();
  map.thermal.reset();  // Its memory is given back before the new one takes any.
  map.thermal = MakeThermal(map.tsdf->max_blocks());
  return map.thermal->Commit(map.tsdf->block_count());
}

std::int32_t Atlas::BlocksLeft() const {
  // What is spilled takes no memory, and each sub-map has files of its own.
  if (!options_.volume().spill_dir().empty()) return max_blocks_;
  std::int32_t left = max_blocks_;
  // While merging, the places of maps that are merged already are empty.
  for (const auto& map : maps_) left -= map ? map->tsdf->block_count() : 0;
  return std::max(0, left);
}

bool Atlas::IsFar(int index, const RigidTransform& T_map_depth) const {
  const SubMapOptions& limits = options_.submaps();
  // A saved model has many anchors: near any of them its surface was scanned without much drift.
  return std::ranges::all_of(map(index).anchors, [&](const RigidTransform& anchor) {
    return (limits.expert().max_rotation_deg() > 0.0 &&
            RotationAngle(anchor, T_map_depth) > limits.expert().max_rotation_deg() * kRadPerDeg) ||
           (limits.expert().max_travel_m() > 0.0 &&
            TranslationDistance(anchor, T_map_depth) > limits.expert().max_travel_m());
  });
}

bool Atlas::Split(const RigidTransform& T_map_depth, std::span<const std::int32_t> blocks_in_view) {
  if (size() >= options_.submaps().expert().max_maps()) return false;
  const int before = active_;
  std::unique_ptr<SubMap> map = MakeMap();
  // The new map begins in the same coordinates, so that the tracker's poses, its velocity and its
  // view of the model stay valid. The maps move apart only when a loop is closed.
  map->T_world_map = active().T_world_map;
  map->joined = active().joined;
  map->anchors = {T_map_depth};
  map->relocaliser->Add(T_map_depth);
  const SubMap& from = active();
  // From here on a failure leaves the atlas as it was: the map joins it at the very end.
  if (!map->thermal->Commit(static_cast<std::int32_t>(blocks_in_view.size()))) return false;
  for (const std::int32_t block : blocks_in_view) {
    const std::int32_t copy = map->tsdf->FindOrAllocate(from.tsdf->block_coordinates(block));
    if (copy == TsdfVolume::kNoBlock) return false;
    std::ranges::copy(from.tsdf->voxels(block), map->tsdf->voxels(copy).begin());
    std::ranges::copy(from.thermal->voxels(block), map->thermal->voxels(copy).begin());
    // Without this flag rays would pass through the copy, and the next frame had nothing to be
    // tracked against.
    map->tsdf->set_may_end_rays(copy, from.tsdf->may_end_rays(block));
  }
  map->versions.NoteAll(map->tsdf->block_count());
  maps_.push_back(std::move(map));
  // The maps agree here exactly. The link's uncertainty stands for the drift within the map that
  // ends.
  links_.push_back({before, size() - 1, T_map_depth, T_map_depth, kDrift_m, kDrift_rad});
  Activate(size() - 1);
  return true;
}

bool Atlas::BeginElsewhere() {
  if (size() >= options_.submaps().expert().max_maps()) return false;
  maps_.push_back(MakeMap());
  Activate(size() - 1);
  return true;
}

void Atlas::Activate(int index) {
  CHECK(index >= 0 && index < size());
  // Pages of a spilled volume that nobody looks at for now make room for those of the new one.
  active().tsdf->Decommit(0, active().tsdf->block_count());
  active().thermal->Decommit(0, active().tsdf->block_count());
  active_ = index;
  // Memory is one budget for all maps: whoever is active may use what is left of it.
  active().tsdf->LimitBlocks(active().tsdf->block_count() + BlocksLeft());
}

std::optional<RigidTransform> Atlas::PoseIn(int index, const RigidTransform& T_active_depth) const {
  if (!active().joined || !map(index).joined) return std::nullopt;
  return map(index).T_world_map.inverse() * active().T_world_map * T_active_depth;
}

std::optional<WorldPose> Atlas::ToWorld(const MapPose& pose) const {
  CHECK(pose.map >= 0 && pose.map < size());
  if (!map(pose.map).joined) return std::nullopt;
  return isotherm::ToWorld(pose, map(pose.map).T_world_map);
}

bool Atlas::IsLinked(int a, int b) const {
  return std::ranges::any_of(links_, [&](const MapLink& link) {
    return (link.a == a && link.b == b) || (link.a == b && link.b == a);
  });
}

bool Atlas::IsNearView(int index, const RigidTransform& T_map_depth) const {
  return std::ranges::any_of(map(index).relocaliser->keyframes().poses(),
                             [&](const RigidTransform& view) {
                               return TranslationDistance(view, T_map_depth) < kNearView_m &&
                                      RotationAngle(view, T_map_depth) < kNearView_rad;
                             });
}

std::vector<int> Atlas::ToVerify(const RigidTransform& T_map_depth) const {
  std::vector<int> candidates;
  for (int i = 0; i < size(); ++i) {
    if (i == active_ || IsLinked(i, active_)) continue;
    // Without a pose one of the two is not joined, and may be anywhere.
    const auto pose = PoseIn(i, T_map_depth);
    if (!pose || IsNearView(i, *pose)) candidates.push_back(i);
  }
  return candidates;
}

void Atlas::Link(int other, const RigidTransform& T_active_depth,
                 const RigidTransform& T_other_depth) {
  const MapLink link{active_, other, T_active_depth, T_other_depth, kVerified_m, kVerified_rad};
  std::vector<RigidTransform> T_world_map;
  for (const auto& map : maps_) T_world_map.push_back(map->T_world_map);
  if (active().joined && map(other).joined) {
    // Measured before the optimiser moves anything: afterwards the gap is spread and cannot be
    // seen.
    const RigidTransform gap = Mismatch(link, T_world_map[link.a], T_world_map[link.b]);
    drift_.last_gap_m = gap.translation().norm();
    drift_.last_gap_rad = RotationAngle(gap, RigidTransform::Identity());
    drift_.largest_gap_m = std::max(drift_.largest_gap_m, drift_.last_gap_m);
    ++drift_.closures;
  }
  links_.push_back(link);
  // Maps that were not joined get a first guess by following links from those that are; the
  // optimiser starts there. A newly joined map may join others, so this repeats until nothing
  // changes.
  for (bool grows = true; grows;) {
    grows = false;
    for (const MapLink& known : links_) {
      SubMap& a = *maps_[known.a];
      SubMap& b = *maps_[known.b];
      if (a.joined == b.joined) continue;
      if (a.joined) {
        T_world_map[known.b] = T_world_map[known.a] * known.T_a_depth * known.T_b_depth.inverse();
      } else {
        T_world_map[known.a] = T_world_map[known.b] * known.T_b_depth * known.T_a_depth.inverse();
      }
      a.joined = b.joined = grows = true;
    }
  }
  OptimisePoseGraph(links_, T_world_map);
  for (int i = 0; i < size(); ++i) maps_[i]->T_world_map = T_world_map[i];
}

bool Atlas::Merge(double max_weight, ThreadPool& pool,
                  const std::function<void(double)>& progress) {
  bool has_room = true;
  SubMap& world = *maps_.front();
  for (int i = 1; i < size(); ++i) {
    const SubMap& map = *maps_[i];
    if (!map.joined) continue;
    // The map that was merged last has given its blocks back.
    world.tsdf->LimitBlocks(world.tsdf->block_count() + BlocksLeft());
    has_room = MergeVolume({*map.tsdf, *map.thermal, map.T_world_map},
                           static_cast<float>(max_weight), pool, *world.tsdf, *world.thermal) &&
               has_room;
    for (const RigidTransform& pose : map.relocaliser->keyframes().poses())
      world.relocaliser->Add(map.T_world_map * pose);
    world.integrated += map.integrated;
    maps_[i].reset();
    // From here on this place is empty (BlocksLeft knows); it is taken out below, so that indices
    // stay valid meanwhile.
    if (progress) progress(static_cast<double>(i) / size());
  }
  std::erase(maps_, nullptr);
  world.versions.NoteAll(world.tsdf->block_count());
  links_.clear();
  active_ = 0;
  return has_room;
}

}  // namespace isotherm
