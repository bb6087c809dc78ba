#include "ground/feedback/view_outlook.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/geometry/rectified_camera.h"
#include "ground/feedback/model_coverage.h"
#include "ground/feedback/trackability.h"

namespace isotherm {
namespace {

/// Width of the coarse cast, pixels: one ray per centimetre or so at the good distances. More:
/// slower by the square, and areas of millimetres count; fewer: posts and pipes fall between the
/// rays.
constexpr int kCastWidth = 48;

/// A surface nearer to the camera than this fraction of the least distance is in its way. 1 would
/// forbid views beside something near that is itself not measured; smaller ones lead the rig
/// against it. Not tuned.
constexpr double kClearance = 0.7;

/// From a view with less surface that the depth camera can measure than the first, as a fraction of
/// the rays, or of what is in its view than the second, the rig would be lost. Firmness
/// (Trackability) grades what is above; not tuned by themselves.
constexpr double kMinTrackable = 0.05, kMinTrackableOfView = 0.6;

/// The depth camera has looked at a place up to this much more than the good distance away: farther
/// off, noise hides what is there. Larger: what is behind is taken for seen.
constexpr double kSeenReserve = 1.3;

CameraModel Coarse(CameraModel camera) {
  camera = RectifiedCamera(camera);
  const double scale = static_cast<double>(kCastWidth) / camera.width;
  camera.width = kCastWidth;
  camera.height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = (camera.cx + 0.5) * scale - 0.5;
  camera.cy = (camera.cy + 0.5) * scale - 0.5;
  return camera;
}

/// Returns whether a point lies behind an observed surface.
bool IsInside(const TsdfVolume& tsdf, const Eigen::Vector3d& p_map) {
  const Eigen::Vector3d p = tsdf.grid().ToVoxel(p_map).array().round();
  if ((p.array() < 0.0).any()) return false;
  const TsdfVoxel voxel = tsdf.VoxelAt(p.cast<int>());
  return voxel.observed() && voxel.tsdf() < 0.0F;
}

}  // namespace

ViewAssessor::ViewAssessor(const ThermalOptions& limits, const Rig& rig, float min_weight)
    : limits_(limits, rig.thermal_sensor),
      min_weight_(min_weight),
      min_depth_m_(std::max(rig.depth_sensor.near_range_m, rig.depth_sensor.min_depth_m)),
      depth_camera_(rig.depth->WithoutDistortion()),
      thermal_camera_(Coarse(*rig.thermal)),
      T_thermal_depth_(*rig.T_thermal_depth) {
  CHECK(rig.depth && rig.thermal && rig.T_thermal_depth);
}

bool ViewAssessor::IsDepthInView(const Eigen::Vector3d& p_depth) const {
  if (p_depth.z() <= 0.0) return false;
  const double u = depth_camera_.fx * p_depth.x() / p_depth.z() + depth_camera_.cx;
  const double v = depth_camera_.fy * p_depth.y() / p_depth.z() + depth_camera_.cy;
  return u >= -0.5 && v >= -0.5 && u < depth_camera_.width - 0.5 && v < depth_camera_.height - 0.5;
}

bool ViewAssessor::WouldBeGood(double distance_m, double cosine) const {
  return cosine > 0.0 &&
         limits_.ClassifyDistance(static_cast<float>(distance_m)) == ConditionClass::kGood &&
         limits_.ClassifyAngle(static_cast<float>(cosine)) == ConditionClass::kGood;
}

double ViewAssessor::UnseenArea(const RigidTransform& T_map_thermal, int x, int y) const {
  if (!seen_) return 0.0;
  const CameraModel& c = thermal_camera_;
  const double depth_m = 0.5 * (limits_.distance_min_m + limits_.distance_good_m);
  const Eigen::Vector3d ray((x - c.cx) / c.fx, (y - c.cy) / c.fy, 1.0);
  return seen_->IsUnseen(T_map_thermal * (depth_m * ray)) ? depth_m * depth_m / (c.fx * c.fy) : 0.0;
}

void ViewAssessor::NoteSeen(const RigidTransform& T_map_depth, const VoxelGrid& grid) {
  if (!seen_) seen_.emplace(grid, depth_camera_, kSeenReserve * limits_.distance_good_m);
  seen_->Look(T_map_depth);
}

template <typename Visit>
Outlook ViewAssessor::Cast(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                           ThreadPool& pool, const Visit& visit) {
  const RigidTransform T_map_thermal = T_map_depth * T_thermal_depth_.inverse();
  const Eigen::Vector3d viewer = T_map_thermal.translation();
  if (IsInside(tsdf, viewer) || IsInside(tsdf, T_map_depth.translation())) return {};
  raycaster_.Cast(tsdf, thermal_camera_, T_map_thermal, min_weight_, pool, maps_);
  const RigidTransform T_depth_map = T_map_depth.inverse();
  const Eigen::Vector3d forward = T_map_thermal.linear().col(2);
  const int rays = maps_.width() * maps_.height();
  Trackability trackability(T_map_depth.translation(), rays);
  double unseen_m2 = 0.0;
  int in_view = 0;
  for (int y = 0; y < maps_.height(); ++y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3d p_map(maps_.vx.At(x, y), maps_.vy.At(x, y), maps_.vz.At(x, y));
      const Eigen::Vector3d to_viewer = viewer - p_map;
      const double distance_m = to_viewer.norm();
      if (!std::isfinite(distance_m)) {
        unseen_m2 += UnseenArea(T_map_thermal, x, y);
        continue;
      }
      if (distance_m <= 0.0 || distance_m < kClearance * limits_.distance_min_m) return {};
      const Eigen::Vector3d p_depth = T_depth_map * p_map;
      if (!IsDepthInView(p_depth)) continue;
      ++in_view;
      if (p_depth.z() < min_depth_m_) continue;
      const Eigen::Vector3d n_map(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
      trackability.Add(p_map, n_map, p_depth.z());
      const double cosine = std::min(to_viewer.dot(n_map) / distance_m, 1.0);
      if (!WouldBeGood(distance_m, cosine)) continue;
      // Solid angle of the pixel times the squared distance over the cosine.
      const double depth_m = -to_viewer.dot(forward);
      visit(p_map, n_map,
            depth_m * depth_m * depth_m /
                (thermal_camera_.fx * thermal_camera_.fy * distance_m * cosine));
    }
  }
  const double surface = trackability.surface();
  return {
      .is_possible = surface >= kMinTrackable && surface * rays >= kMinTrackableOfView * in_view,
      .gain_m2 = 0.0,
      .unseen_m2 = unseen_m2,
      .firmness = trackability.Firmness()};
}

Outlook ViewAssessor::LookFrom(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                               const ThermalVolume& thermal, ThreadPool& pool) {
  double gain_m2 = 0.0;
  Outlook outlook =
      Cast(T_map_depth, tsdf, pool,
           [&](const Eigen::Vector3d& p_map, const Eigen::Vector3d& /*n_map*/, double area_m2) {
             if (ThermalVoxelAt(tsdf, thermal, p_map).quality() == MeasurementQuality::kGood)
               return;
             if (!tried_.IsVain(p_map)) gain_m2 += area_m2;
           });
  if (outlook.is_possible) outlook.gain_m2 = gain_m2;
  return outlook;
}

void ViewAssessor::NoteLook(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                            const ThermalVolume& thermal, ThreadPool& pool) {
  tried_.BeginLook();
  Cast(T_map_depth, tsdf, pool,
       [&](const Eigen::Vector3d& p_map, const Eigen::Vector3d& n_map, double /*area_m2*/) {
         const bool is_well =
             ThermalVoxelAt(tsdf, thermal, p_map).quality() == MeasurementQuality::kGood;
         tried_.Note(p_map, PieceOf(tsdf.grid(), p_map, n_map), is_well);
       });
}

}  // namespace isotherm
