#include "ground/feedback/view_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/base/check.h"
#include "common/base/units.h"
#include "common/geometry/rectified_camera.h"

namespace isotherm {
namespace {

/// Width of the coarse cast, pixels: one ray per centimetre or so.
constexpr int kCastWidth = 48;

/// Pieces of lacking surface that candidates look at before the choice is renewed.
constexpr std::size_t kMaxTargets = 48;

/// Candidates look along the normal and from so far askew, to four sides.
constexpr double kAskew_rad = 25.0 * kRadPerDeg;

/// Another view takes the place of the best one when it gains this much more: it should not jump.
constexpr double kClearlyBetter = 1.2;

/// A surface nearer to the camera than this fraction of the least distance is in its way.
constexpr double kClearance = 0.7;

/// From a view with less surface that the depth camera can measure than the first, as a fraction of
/// the rays, or of what is in its view than the second, the rig would be lost.
constexpr double kMinTrackable = 0.05, kMinTrackableOfView = 0.6;

/// Targets are looked at from this much more than the nearest depth that the depth camera measures.
constexpr double kDepthReserve = 1.15;

/// A view counts as taken within this far of it, for this many steps.
constexpr double kAtView_m = 0.10;
constexpr double kAtView_rad = 15.0 * kRadPerDeg;
constexpr int kStepsAtView = 20;
/// Nor is it proposed for longer than this many steps (a quarter of a minute) if nobody goes there:
/// there may be no way.
constexpr int kStepsToView = 150;
constexpr std::size_t kMaxExhausted = 512;

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

bool IsNear(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm() < kAtView_m &&
         std::acos(std::clamp(a.linear().col(2).dot(b.linear().col(2)), -1.0, 1.0)) < kAtView_rad;
}

/// Returns whether a point lies behind an observed surface.
bool IsInside(const TsdfVolume& tsdf, const Eigen::Vector3d& p_map) {
  const Eigen::Vector3d p = tsdf.grid().ToVoxel(p_map).array().round();
  if ((p.array() < 0.0).any()) return false;
  const TsdfVoxel voxel = tsdf.VoxelAt(p.cast<int>());
  return voxel.observed() && voxel.tsdf() < 0.0F;
}

}  // namespace

ViewPlanner::ViewPlanner(const FeedbackOptions& options, const ThermalOptions& limits,
                         const Rig& rig, float min_weight)
    : options_(options),
      limits_(limits, rig.thermal_sensor),
      angle_min_rad_(std::acos(limits_.cosine_min_angle)),
      angle_good_rad_(std::acos(limits_.cosine_good_angle)),
      min_weight_(min_weight),
      min_depth_m_(std::max(rig.depth_sensor.near_range_m, rig.depth_sensor.min_depth_m)),
      depth_camera_(rig.depth->WithoutDistortion()),
      thermal_camera_(Coarse(*rig.thermal)),
      T_thermal_depth_(*rig.T_thermal_depth) {
  CHECK(rig.depth && rig.thermal && rig.T_thermal_depth);
}

RigidTransform ViewPlanner::LookAt(const Eigen::Vector3d& target,
                                   const Eigen::Vector3d& towards_camera,
                                   const RigidTransform& T_map_depth) const {
  const double middle_m = 0.5 * (limits_.distance_min_m + limits_.distance_good_m);
  const double distance_m = std::clamp(kDepthReserve * min_depth_m_, middle_m,
                                       std::max<double>(middle_m, limits_.distance_good_m));
  const Eigen::Vector3d z = -towards_camera;
  // As the rig is held now: x stays as level as it is.
  Eigen::Vector3d x = T_map_depth.linear().col(1).cross(z);
  if (x.norm() < 0.1) x = T_map_depth.linear().col(0) - z.dot(T_map_depth.linear().col(0)) * z;
  if (x.norm() < 0.1) x = z.unitOrthogonal();
  x.normalize();
  RigidTransform T_map_thermal = RigidTransform::Identity();
  T_map_thermal.linear().col(0) = x;
  T_map_thermal.linear().col(1) = z.cross(x);
  T_map_thermal.linear().col(2) = z;
  T_map_thermal.translation() = target + distance_m * towards_camera;
  return T_map_thermal * T_thermal_depth_;
}

void ViewPlanner::MakeCandidates(const ModelCoverage& coverage, const RigidTransform& T_map_depth) {
  // Straight on, the operator may be reflected.
  const double straight_rad = angle_min_rad_ > 0.0 ? 0.5 * (angle_min_rad_ + angle_good_rad_) : 0.0;
  const double askew_rad = straight_rad > 0.0 ? straight_rad : kAskew_rad;
  constexpr int kSides = 4;
  const std::vector<LackingSurface> targets = coverage.Lacking(
      kMaxTargets,
      [this](std::uint64_t cell, double area_m2) { return !reach_.IsOutOfReach(cell, area_m2); });
  for (const LackingSurface& target : targets)
    reach_.Begin(target, straight_rad == 0.0 ? 1 + kSides : kSides);
  // All straight views first: they are the most likely, and cells see parts of each other.
  if (straight_rad == 0.0) {
    for (const LackingSurface& target : targets) {
      candidates_.push_back(
          {LookAt(target.position_map, target.normal_map, T_map_depth), target.cell});
    }
  }
  for (int side = 0; side < kSides; ++side) {
    for (const LackingSurface& target : targets) {
      const Eigen::Vector3d u = target.normal_map.unitOrthogonal();
      const double azimuth = 0.5 * std::numbers::pi * side;
      const Eigen::Vector3d tangent =
          std::cos(azimuth) * u + std::sin(azimuth) * target.normal_map.cross(u);
      const Eigen::Vector3d towards_camera =
          std::cos(askew_rad) * target.normal_map + std::sin(askew_rad) * tangent;
      candidates_.push_back(
          {LookAt(target.position_map, towards_camera, T_map_depth), target.cell});
    }
  }
}

bool ViewPlanner::IsDepthInView(const Eigen::Vector3d& p_depth) const {
  if (p_depth.z() <= 0.0) return false;
  const double u = depth_camera_.fx * p_depth.x() / p_depth.z() + depth_camera_.cx;
  const double v = depth_camera_.fy * p_depth.y() / p_depth.z() + depth_camera_.cy;
  return u >= -0.5 && v >= -0.5 && u < depth_camera_.width - 0.5 && v < depth_camera_.height - 0.5;
}

double ViewPlanner::Gain(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                         const ThermalVolume& thermal, ThreadPool& pool) {
  const RigidTransform T_map_thermal = T_map_depth * T_thermal_depth_.inverse();
  const Eigen::Vector3d viewer = T_map_thermal.translation();
  if (IsInside(tsdf, viewer) || IsInside(tsdf, T_map_depth.translation())) return 0.0;
  raycaster_.Cast(tsdf, thermal_camera_, T_map_thermal, min_weight_, pool, maps_);
  const RigidTransform T_depth_map = T_map_depth.inverse();
  const Eigen::Vector3d forward = T_map_thermal.linear().col(2);
  double gain_m2 = 0.0;
  int in_view = 0, trackable = 0;
  for (int y = 0; y < maps_.height(); ++y) {
    for (int x = 0; x < maps_.width(); ++x) {
      const Eigen::Vector3d p_map(maps_.vx.At(x, y), maps_.vy.At(x, y), maps_.vz.At(x, y));
      const Eigen::Vector3d to_viewer = viewer - p_map;
      const double distance_m = to_viewer.norm();
      if (!std::isfinite(distance_m)) continue;
      if (distance_m <= 0.0 || distance_m < kClearance * limits_.distance_min_m) return 0.0;
      const Eigen::Vector3d p_depth = T_depth_map * p_map;
      const bool is_in_view = IsDepthInView(p_depth);
      const bool has_depth = is_in_view && p_depth.z() >= min_depth_m_;
      in_view += is_in_view ? 1 : 0;
      trackable += has_depth ? 1 : 0;
      const Eigen::Vector3d n_map(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
      const double cosine = std::min(to_viewer.dot(n_map) / distance_m, 1.0);
      const bool would_be_good =
          cosine > 0.0 &&
          limits_.ClassifyDistance(static_cast<float>(distance_m)) == ConditionClass::kGood &&
          limits_.ClassifyAngle(static_cast<float>(cosine)) == ConditionClass::kGood;
      if (!would_be_good || !has_depth) continue;
      if (ThermalVoxelAt(tsdf, thermal, p_map).quality() == MeasurementQuality::kGood) continue;
      // Solid angle of the pixel times the squared distance over the cosine.
      const double depth_m = -to_viewer.dot(forward);
      gain_m2 += depth_m * depth_m * depth_m /
                 (thermal_camera_.fx * thermal_camera_.fy * distance_m * cosine);
    }
  }
  if (trackable < kMinTrackable * maps_.width() * maps_.height()) return 0.0;
  return trackable < kMinTrackableOfView * in_view ? 0.0 : gain_m2;
}

void ViewPlanner::NotePose(const RigidTransform& T_map_depth) {
  if (!best_) return;
  ++steps_proposed_;
  steps_at_best_ = IsNear(best_->T_map_depth, T_map_depth) ? steps_at_best_ + 1 : 0;
  if (steps_at_best_ < kStepsAtView && steps_proposed_ < kStepsToView) return;
  // What was not measured well from there by now will not be.
  exhausted_.push_back(best_->T_map_depth);
  if (exhausted_.size() > kMaxExhausted) exhausted_.pop_front();
  best_.reset();
  steps_at_best_ = steps_proposed_ = 0;
}

bool ViewPlanner::IsExhausted(const RigidTransform& T_map_depth) const {
  return std::ranges::any_of(exhausted_,
                             [&](const RigidTransform& view) { return IsNear(view, T_map_depth); });
}

void ViewPlanner::Step(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                       const ModelCoverage& coverage, const RigidTransform& T_map_depth,
                       bool is_measuring, ThreadPool& pool) {
  if (options_.expert().views_per_message() == 0) return;
  if (is_measuring) NotePose(T_map_depth);
  int left = options_.expert().views_per_message();
  if (best_) {
    best_->gain_m2 = Gain(best_->T_map_depth, tsdf, thermal, pool);
    if (best_->gain_m2 < options_.expert().min_gain_m2()) best_.reset();
    --left;
  }
  if (candidates_.empty()) MakeCandidates(coverage, T_map_depth);
  for (; left > 0 && !candidates_.empty(); candidates_.pop_front()) {
    const auto& [T_map_candidate, cell] = candidates_.front();
    if (IsExhausted(T_map_candidate)) {
      reach_.Note(cell, false);
      continue;
    }
    --left;
    const double gain_m2 = Gain(T_map_candidate, tsdf, thermal, pool);
    reach_.Note(cell, gain_m2 >= options_.expert().min_gain_m2());
    const double needed_m2 =
        best_ ? kClearlyBetter * best_->gain_m2 : options_.expert().min_gain_m2();
    if (gain_m2 < needed_m2) continue;
    best_ = NextView{T_map_candidate, gain_m2};
    steps_at_best_ = steps_proposed_ = 0;
  }
}

}  // namespace isotherm
