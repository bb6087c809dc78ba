#include "ground/experiment/thesis_fusion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "ground/surface/voxel_grid.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The pixel that a point falls on; nullopt outside the image.
std::optional<Eigen::Vector2i> PixelOf(const CameraModel& camera, const Eigen::Vector3d& p_camera) {
  const auto pixel = Project(camera, p_camera);
  if (!pixel) return std::nullopt;
  // Pixel centres are at integers.
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
      sensor_(rig.thermal_sensor),
      limits_(options, rig.thermal_sensor),
      depth_camera_(rig.depth->WithoutDistortion()),
      min_weight_(min_weight),
      filter_(filter),
      rectifier_(*rig.thermal, {}),
      nearest_m_(rectifier_.ideal_camera().width, rectifier_.ideal_camera().height),
      vertices_(rig.depth->width, rig.depth->height) {}

ThesisFuser::Vertex ThesisFuser::Measure(const Eigen::Vector3f& p_map, const Eigen::Vector3f& n_map,
                                         const RigidTransform& T_map_thermal,
                                         const OtherRules* rules) const {
  Vertex vertex{p_map, kNan, ConditionClass::kBad, ConditionClass::kBad};
  if (!p_map.allFinite() || !n_map.allFinite()) return vertex;
  const Eigen::Vector3f to_camera = T_map_thermal.translation().cast<float>() - p_map;
  const float distance_m = to_camera.norm();
  const float cosine = to_camera.dot(n_map) / distance_m;
  const Eigen::Vector3d p_thermal = T_map_thermal.inverse() * p_map.cast<double>();
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
  if (rules == nullptr) return vertex;
  const bool bad = vertex.distance == ConditionClass::kBad || vertex.angle == ConditionClass::kBad;
  if ((bad && !options_.expert().keep_bad()) || IsLeftOut(p_thermal, *nearest, *rules))
    vertex.celsius = kNan;
  return vertex;
}

bool ThesisFuser::IsLeftOut(const Eigen::Vector3d& p_thermal, const Eigen::Vector2i& pixel,
                            const OtherRules& rules) const {
  const CameraModel& camera = rectifier_.ideal_camera();
  const ThermalExpertOptions& expert = options_.expert();
  const auto index = static_cast<std::size_t>(pixel.y() * camera.width + pixel.x());
  if ((pixels_[index].flags & ThermalPixel::kAssignable) == 0) return true;
  const int margin = expert.occlusion().edge_margin_px();
  float nearest_m = std::numeric_limits<float>::max();
  for (int y = std::max(0, pixel.y() - margin); y <= pixel.y() + margin; ++y) {
    for (int x = std::max(0, pixel.x() - margin); x <= pixel.x() + margin; ++x) {
      if (nearest_m_.Contains(x, y)) nearest_m = std::min(nearest_m, nearest_m_.At(x, y));
    }
  }
  if (p_thermal.norm() - static_cast<double>(nearest_m) > expert.occlusion().parallax_tolerance_m())
    return true;
  // The simulated cameras read all rows at once.
  const Eigen::Vector2d xy = p_thermal.head<2>() / p_thermal.z();
  const double smear_px =
      camera.fx * sensor_.time_constant_s * ImageVelocity(rules.motion, xy, p_thermal.z()).norm();
  if (smear_px > expert.motion().smear_max_px()) return true;
  const auto half_step = [&](int dx, int dy) {
    const Eigen::Vector2i before = pixel - Eigen::Vector2i(dx, dy);
    const Eigen::Vector2i after = pixel + Eigen::Vector2i(dx, dy);
    if (!celsius_.Contains(before.x(), before.y()) || !celsius_.Contains(after.x(), after.y()))
      return 0.0F;
    const float step =
        0.5F * (celsius_.At(after.x(), after.y()) - celsius_.At(before.x(), before.y()));
    return std::isnan(step) ? 0.0F : step;
  };
  constexpr double kPixelUncertainty_px = 0.5;  // As the pipeline's.
  const double slope_k_px = std::hypot(half_step(1, 0), half_step(0, 1));
  return expert.max_gradient_error_k() > 0.0 &&
         std::max(smear_px, kPixelUncertainty_px) * slope_k_px > expert.max_gradient_error_k();
}

void ThesisFuser::FindAssignablePixels(const OtherRules& rules) {
  const CameraModel& camera = rectifier_.ideal_camera();
  pixels_.assign(nearest_m_.pixels().size(), ThermalPixel{});
  for (int y = 0; y < camera.height; ++y) {
    const std::span row(pixels_.data() + static_cast<std::ptrdiff_t>(y) * camera.width,
                        static_cast<std::size_t>(camera.width));
    for (int x = 0; x < camera.width; ++x) {
      const float distance_m = nearest_m_.At(x, y);
      if (distance_m == std::numeric_limits<float>::max()) continue;  // No vertex.
      const double ray = Unproject(camera, Eigen::Vector2d(x, y)).homogeneous().norm();
      row[static_cast<std::size_t>(x)].depth_m = static_cast<float>(distance_m / ray);
      row[static_cast<std::size_t>(x)].flags = ThermalPixel::kAssignable;
    }
    rules.near_range.LeaveOut(y, row);
  }
  rules.line_of_sight.LeaveOut(0, pixels_);
}

void ThesisFuser::FindVertices(const RigidTransform& T_map_thermal, ThreadPool& pool,
                               const OtherRules* rules) {
  const RigidTransform T_thermal_map = T_map_thermal.inverse();
  nearest_m_.Fill(std::numeric_limits<float>::max());
  // Algorithm 4, lines 7 to 10.
  for (int y = 0; y < maps_.height(); ++y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3d p_thermal = T_thermal_map * VertexAt(maps_, x, y).cast<double>();
      if (!p_thermal.allFinite()) continue;
      if (const auto pixel = PixelOf(rectifier_.ideal_camera(), p_thermal)) {
        float& nearest = nearest_m_.At(pixel->x(), pixel->y());
        nearest = std::min(nearest, static_cast<float>(p_thermal.norm()));
      }
    }
  }
  if (rules != nullptr) FindAssignablePixels(*rules);
  pool.ParallelFor(maps_.height(), [&](int y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3f n_map(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
      vertices_.At(x, y) = Measure(VertexAt(maps_, x, y), n_map, T_map_thermal, rules);
    }
  });
}

void ThesisFuser::UpdateBlock(std::int32_t block, const RigidTransform& T_depth_map,
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
    const Eigen::Vector3d p_map = grid.VoxelCentre(first + offset);
    const auto pixel = PixelOf(depth_camera_, T_depth_map * p_map);
    if (!pixel) continue;
    const Vertex& vertex = vertices_.At(pixel->x(), pixel->y());
    if (std::isnan(vertex.celsius)) continue;
    if (!((vertex.p_map - p_map.cast<float>()).norm() < reach_m)) continue;
    const ThermalVoxel measured = ThermalVoxel::Make(vertex.celsius, vertex.distance, vertex.angle);
    if (ReplacesMeasurement(vertex.distance, vertex.angle, ConditionClass::kUnchecked,
                            voxels[index]))
      voxels[index] = measured;
  }
}

void ThesisFuser::Fuse(const ThesisFrame& posed, const TsdfVolume& tsdf, ThreadPool& pool,
                       ThermalVolume& thermal) {
  raycaster_.Cast(tsdf, depth_camera_, posed.T_map_depth, min_weight_, pool, maps_);
  rectifier_.Rectify(posed.frame.temperature_raw, posed.frame.scale, 0, pool, celsius_);
  FindVertices(posed.T_map_thermal, pool, posed.rules);
  const RigidTransform T_depth_map = posed.T_map_depth.inverse();
  pool.ParallelFor(tsdf.block_count(),
                   [&](int block) { UpdateBlock(block, T_depth_map, tsdf, thermal); });
}

ThesisFusion::ThesisFusion(const GroundOptions& options, const Rig& rig, const ScanModel& model,
                           ParallaxFilter filter, Rules rules)
    : rig_(rig),
      model_(model),
      rules_(rules),
      fuser_(options.thermal(), rig, static_cast<float>(options.raycast().expert().min_weight()),
             filter),
      near_range_(options.thermal().expert().occlusion(), rig.depth_sensor, fuser_.ideal_camera()),
      line_of_sight_(options.thermal().expert().occlusion(), rig.depth_sensor,
                     fuser_.ideal_camera()),
      thermal_(model.tsdf().max_blocks()) {}

void ThesisFusion::AfterDepth(const Image<float>& depth_m, ThreadPool& pool) {
  const std::vector<StampedPose>& poses = model_.trajectory.poses();
  if (poses.size() < 2) return;
  const ModelView& view = model_.view;
  near_range_.Update(depth_m, view.maps, view.camera);
  line_of_sight_.Update(view.maps, view.camera, view.T_map_depth);
  const RigidTransform T_depth_thermal = rig_.T_thermal_depth->inverse();
  const StampedPose& before = poses[poses.size() - 2];
  const StampedPose& after = poses.back();
  for (; !waiting_.empty() && waiting_.front()->header.capture_time <= after.time;
       waiting_.pop_front()) {
    const ThermalFrame& frame = *waiting_.front();
    const CaptureTime time = frame.header.capture_time;
    // Older than both poses: frames before tracking began.
    if (time < before.time || !frame.valid) continue;
    const double alpha = ToSeconds(time - before.time) / ToSeconds(after.time - before.time);
    const RigidTransform T_world_depth =
        Interpolate(before.T_world_depth, after.T_world_depth, alpha);
    const RigidTransform T_map_thermal = InFirstMap(T_world_depth) * T_depth_thermal;
    const RigidTransform T_view_thermal = view.T_map_depth.inverse() * T_map_thermal;
    near_range_.Aim(T_view_thermal);
    line_of_sight_.Aim(T_view_thermal);
    const OtherRules rules{
        MotionBetween(before.T_world_depth * T_depth_thermal, after.T_world_depth * T_depth_thermal,
                      ToSeconds(after.time - before.time)),
        near_range_, line_of_sight_};
    fuser_.Fuse({frame, T_map_thermal, InFirstMap(after.T_world_depth),
                 rules_ == Rules::kAlsoOurOthers ? &rules : nullptr},
                model_.tsdf(), pool, thermal_);
  }
}

}  // namespace isotherm
