#include "ground/experiment/thesis_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The pixel that a point falls on; nullopt outside the image.
std::optional<Eigen::Vector2i> PixelOf(const CameraModel& camera, const Eigen::Vector3d& p_camera) {
  const auto pixel = Project(camera, p_camera);
  if (!pixel) return std::nullopt;
  const Eigen::Vector2i nearest = (pixel->array() + 0.5).floor().cast<int>();
  if (nearest.x() < 0 || nearest.y() < 0 || nearest.x() >= camera.width ||
      nearest.y() >= camera.height) {
    return std::nullopt;
  }
  return nearest;
}

float Bilinear(const Image<float>& image, const Eigen::Vector2d& pixel) {
  const auto x = static_cast<int>(std::floor(pixel.x()));
  const auto y = static_cast<int>(std::floor(pixel.y()));
  if (x < 0 || y < 0 || x + 1 >= image.width() || y + 1 >= image.height()) return kNan;
  const auto fx = static_cast<float>(pixel.x() - x), fy = static_cast<float>(pixel.y() - y);
  const float above = (1.0F - fx) * image.At(x, y) + fx * image.At(x + 1, y);
  const float below = (1.0F - fx) * image.At(x, y + 1) + fx * image.At(x + 1, y + 1);
  return (1.0F - fy) * above + fy * below;
}

Eigen::Vector3f VertexAt(const SurfaceMaps& maps, int x, int y) {
  return {maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)};
}

}  // namespace

ThesisFuser::ThesisFuser(const ThermalOptions& options, const Rig& rig, float min_weight,
                         ParallaxFilter filter)
    : options_(options),
      limits_(options, rig.thermal_sensor),
      depth_camera_(rig.depth->WithoutDistortion()),
      min_weight_(min_weight),
      filter_(filter),
      rectifier_(*rig.thermal),
      nearest_m_(rectifier_.ideal_camera().width, rectifier_.ideal_camera().height),
      vertices_(rig.depth->width, rig.depth->height) {}

ThesisFuser::Vertex ThesisFuser::Measure(const Eigen::Vector3f& p_world,
                                         const Eigen::Vector3f& n_world,
                                         const RigidTransform& T_world_thermal) const {
  Vertex vertex{p_world, kNan, ConditionClass::kBad, ConditionClass::kBad};
  if (!p_world.allFinite() || !n_world.allFinite()) return vertex;
  const Eigen::Vector3f to_camera = T_world_thermal.translation().cast<float>() - p_world;
  const float distance_m = to_camera.norm();
  const float cosine = to_camera.dot(n_world) / distance_m;
  const Eigen::Vector3d p_thermal = T_world_thermal.inverse() * p_world.cast<double>();
  const auto pixel = Project(rectifier_.ideal_camera(), p_thermal);
  const auto nearest = PixelOf(rectifier_.ideal_camera(), p_thermal);
  if (!pixel || !nearest || cosine <= 0.0F) return vertex;
  if (filter_ == ParallaxFilter::kAlgorithm4 &&
      distance_m - nearest_m_.At(nearest->x(), nearest->y()) >=
          static_cast<float>(options_.expert().occlusion().parallax_tolerance_m())) {
    return vertex;
  }
  vertex.celsius = Bilinear(celsius_, *pixel);
  vertex.distance = limits_.ClassifyDistance(distance_m);
  vertex.angle = limits_.ClassifyAngle(std::min(cosine, 1.0F));
  return vertex;
}

void ThesisFuser::FindVertices(const RigidTransform& T_world_thermal, ThreadPool& pool) {
  const RigidTransform T_thermal_world = T_world_thermal.inverse();
  nearest_m_.Fill(std::numeric_limits<float>::max());
  // Algorithm 4, lines 7 to 10.
  for (int y = 0; y < maps_.height(); ++y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3d p_thermal = T_thermal_world * VertexAt(maps_, x, y).cast<double>();
      if (!p_thermal.allFinite()) continue;
      if (const auto pixel = PixelOf(rectifier_.ideal_camera(), p_thermal)) {
        float& nearest = nearest_m_.At(pixel->x(), pixel->y());
        nearest = std::min(nearest, static_cast<float>(p_thermal.norm()));
      }
    }
  }
  pool.ParallelFor(maps_.height(), [&](int y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3f n_world(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
      vertices_.At(x, y) = Measure(VertexAt(maps_, x, y), n_world, T_world_thermal);
    }
  });
}

void ThesisFuser::UpdateBlock(std::int32_t block, const RigidTransform& T_depth_world,
                              const TsdfVolume& tsdf, ThermalVolume& thermal) const {
  const VoxelGrid& grid = tsdf.grid();
  const auto reach_m =
      static_cast<float>(options_.expert().vertex_distance_vox() * grid.voxel_size_m);
  const std::span<const TsdfVoxel, kBlockVoxels> distances = tsdf.voxels(block);
  const std::span<ThermalVoxel, kBlockVoxels> voxels = thermal.voxels(block);
  const GridIndex first = tsdf.block_coordinates(block) * kBlockSide;
  for (int i = 0; i < kBlockVoxels; ++i) {
    const auto index = static_cast<std::size_t>(i);
    // Voxels that are surely too far from any vertex; noise is within a truncation distance.
    if (!distances[index].observed() || std::abs(distances[index].tsdf()) > 0.75F) continue;
    const GridIndex offset(i % kBlockSide, i / kBlockSide % kBlockSide,
                           i / (kBlockSide * kBlockSide));
    const Eigen::Vector3d p_world = grid.VoxelCentre(first + offset);
    const auto pixel = PixelOf(depth_camera_, T_depth_world * p_world);
    if (!pixel) continue;
    const Vertex& vertex = vertices_.At(pixel->x(), pixel->y());
    if (std::isnan(vertex.celsius)) continue;
    if (!((vertex.p_world - p_world.cast<float>()).norm() < reach_m)) continue;
    const ThermalVoxel measured = ThermalVoxel::Make(vertex.celsius, vertex.distance, vertex.angle);
    if (ReplacesMeasurement(vertex.distance, vertex.angle, ConditionClass::kUnchecked,
                            voxels[index]))
      voxels[index] = measured;
  }
}

void ThesisFuser::Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
                       const RigidTransform& T_world_depth, const TsdfVolume& tsdf,
                       ThreadPool& pool, ThermalVolume& thermal) {
  raycaster_.Cast(tsdf, depth_camera_, T_world_depth, min_weight_, pool, maps_);
  rectifier_.Rectify(frame.temperature_raw, frame.scale, 0, pool, celsius_);
  FindVertices(T_world_thermal, pool);
  const RigidTransform T_depth_world = T_world_depth.inverse();
  pool.ParallelFor(tsdf.block_count(),
                   [&](int block) { UpdateBlock(block, T_depth_world, tsdf, thermal); });
}

ThesisFusion::ThesisFusion(const GroundOptions& options, const Rig& rig, const ScanModel& model,
                           ParallaxFilter filter)
    : rig_(rig),
      model_(model),
      fuser_(options.thermal(), rig, static_cast<float>(options.raycast().expert().min_weight()),
             filter),
      thermal_(model.tsdf().max_blocks()) {}

void ThesisFusion::AfterDepth(ThreadPool& pool) {
  const std::vector<StampedPose>& poses = model_.trajectory.poses();
  if (poses.size() < 2) return;
  const StampedPose& before = poses[poses.size() - 2];
  const StampedPose& after = poses.back();
  for (; !waiting_.empty() && waiting_.front()->header.capture_time <= after.time;
       waiting_.pop_front()) {
    const ThermalFrame& frame = *waiting_.front();
    const CaptureTime time = frame.header.capture_time;
    if (time < before.time || !frame.valid) continue;
    const double alpha = ToSeconds(time - before.time) / ToSeconds(after.time - before.time);
    const RigidTransform T_world_depth =
        Interpolate(before.T_world_depth, after.T_world_depth, alpha);
    fuser_.Fuse(frame, T_world_depth * rig_.T_thermal_depth->inverse(), after.T_world_depth,
                model_.tsdf(), pool, thermal_);
  }
}

}  // namespace isotherm
