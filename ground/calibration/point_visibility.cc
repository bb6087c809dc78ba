#include "ground/calibration/point_visibility.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "common/base/noise.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/rectified_camera.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

// Surfaces more oblique than this (cosine) are left out: emissivity changes with the angle there.
constexpr double kMinCosine = 0.7;
// The surface is cast with pixels this many times as large as the image's, and a point must be
// on it in the pixels around too: so far it is from what hides it, and from its own silhouette.
constexpr int kHalvings = 2;
// Slope of the most oblique surface times half the diagonal of three such pixels, in focal lengths
// of the camera; and the noise of the surface.
constexpr double kNeighbourhood_px = 2.2;
constexpr double kSurfaceNoise_m = 0.005;
// Clear of the image's border for the interpolation and for a motion of some pixels while delays
// are tried.
constexpr double kBorder_px = 4.0;
// Surface seen once may be noise beside an edge.
constexpr float kMinWeight = 2.0F;
// Poses that points are drawn from, spread over the scan: each sees thousands of points, so more
// would only take time.
constexpr std::size_t kPointViews = 60;
// Poses closer in time than this show the same.
constexpr double kPoseSpacing_s = 0.045;

/// Holds what one pose shows.
struct PoseView {
  CaptureTime time;
  std::vector<std::uint8_t> shows;  ///< By point, 0 or 1.
};

class PoseViewer {
 public:
  PoseViewer(const ScanViews& views, const TsdfVolume& tsdf, ThreadPool& pool)
      : views_(views),
        tsdf_(tsdf),
        pool_(pool),
        ideal_(RectifiedCamera(views.thermal_camera).Downscaled(kHalvings)),
        tolerance_per_m_(kNeighbourhood_px / ideal_.fx * std::sqrt(1.0 - kMinCosine * kMinCosine) /
                         kMinCosine) {
    const CameraModel& camera = views.thermal_camera;
    for (const double u : {0.0, camera.width - 1.0}) {
      for (const double v : {0.0, camera.height - 1.0})
        max_normalized_ = std::max(max_normalized_, Unproject(camera, {u, v}).norm());
    }
  }

  PoseView See(const StampedPose& pose) {
    const RigidTransform T_world_thermal = pose.T_world_depth * views_.T_thermal_depth.inverse();
    const RigidTransform T_thermal_world = T_world_thermal.inverse();
    raycaster_.Cast(tsdf_, ideal_, InFirstMap(T_world_thermal), kMinWeight, pool_, maps_);
    MakeDepths(T_thermal_world);
    PoseView view{pose.time, std::vector<std::uint8_t>(views_.points.size(), 0)};
    constexpr int kPointsPerTask = 1024;
    const int points = static_cast<int>(views_.points.size());
    pool_.ParallelFor((points + kPointsPerTask - 1) / kPointsPerTask, [&](int task) {
      const int end = std::min(points, (task + 1) * kPointsPerTask);
      for (int i = task * kPointsPerTask; i < end; ++i) {
        const auto index = static_cast<std::size_t>(i);
        view.shows[index] = Shows(views_.points[index], T_thermal_world) ? 1 : 0;
      }
    });
    return view;
  }

 private:
  void MakeDepths(const RigidTransform& T_thermal_world) {
    depth_m_.Resize(maps_.width(), maps_.height());
    for (int y = 0; y < maps_.height(); ++y) {
      for (int x = 0; x < maps_.width(); ++x) {
        const Eigen::Vector3d p_world(maps_.vx.At(x, y), maps_.vy.At(x, y), maps_.vz.At(x, y));
        depth_m_.At(x, y) = static_cast<float>((T_thermal_world * p_world).z());
      }
    }
  }

  bool Shows(const TexturePoint& point, const RigidTransform& T_thermal_world) const {
    const Eigen::Vector3d p_thermal = T_thermal_world * point.p_world;
    if (p_thermal.z() < 0.05) return false;
    const Eigen::Vector3d n_thermal = T_thermal_world.linear() * point.n_world;
    if (-n_thermal.dot(p_thermal) < kMinCosine * p_thermal.norm()) return false;
    const Eigen::Vector2d normalized = p_thermal.head<2>() / p_thermal.z();
    // Further out distortion folds back.
    if (normalized.norm() > max_normalized_) return false;
    const CameraModel& camera = views_.thermal_camera;
    const Eigen::Vector2d pixel = ProjectNormalized(camera, normalized);
    if (!(pixel.x() >= kBorder_px && pixel.y() >= kBorder_px &&
          pixel.x() < camera.width - 1 - kBorder_px &&
          pixel.y() < camera.height - 1 - kBorder_px)) {
      return false;
    }
    return Clear(ProjectNormalized(ideal_, normalized), p_thermal.z());
  }

  /// Returns whether the surface is at this depth in the pixels around.
  bool Clear(const Eigen::Vector2d& pixel, double depth_m) const {
    const auto x = static_cast<int>(std::lround(pixel.x()));
    const auto y = static_cast<int>(std::lround(pixel.y()));
    if (x < 1 || y < 1 || x + 1 >= depth_m_.width() || y + 1 >= depth_m_.height()) return false;
    const double tolerance_m = kSurfaceNoise_m + tolerance_per_m_ * depth_m;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        // No surface is NaN, and not clear.
        const auto there_m = static_cast<double>(depth_m_.At(x + dx, y + dy));
        if (!(std::abs(there_m - depth_m) <= tolerance_m)) return false;
      }
    }
    return true;
  }

  const ScanViews& views_;
  const TsdfVolume& tsdf_;
  ThreadPool& pool_;
  const CameraModel ideal_;
  const double tolerance_per_m_;
  double max_normalized_ = 0.0;
  Raycaster raycaster_{RaycastPrecision::kVisibility};
  SurfaceMaps maps_;
  Image<float> depth_m_;
};

std::vector<std::uint32_t> ShownByAll(const std::deque<PoseView>& window, std::size_t points) {
  std::vector<std::uint32_t> visible;
  if (window.empty()) return visible;
  for (std::size_t i = 0; i < points; ++i) {
    if (std::all_of(window.begin(), window.end(),
                    [i](const PoseView& view) { return view.shows[i] != 0; }))
      visible.push_back(static_cast<std::uint32_t>(i));
  }
  return visible;
}

/// Returns whether there is a pose for every delay within the range.
bool Covered(const ScanViews& views, CaptureTime time, double range_s) {
  // Shorter than a gap that poses are not interpolated over (kMaxGap_s).
  constexpr double kStep_s = 0.025;
  const int steps = std::max(1, static_cast<int>(std::ceil(range_s / kStep_s)));
  for (int k = -steps; k <= steps; ++k) {
    if (!InterpolatePose(views.trajectory, time + FromSeconds(range_s * k / steps))) return false;
  }
  return true;
}

/// In random order that is always the same.
void Shuffle(std::vector<TexturePoint>& points) {
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(MixBits(i) % i)]);
}

}  // namespace

std::vector<TexturePoint> DrawPoints(const TsdfVolume& tsdf, const ScanViews& views,
                                     std::size_t max_points, ThreadPool& pool) {
  std::vector<TexturePoint> points;
  if (views.frames.empty()) return points;
  const CameraModel camera = RectifiedCamera(views.thermal_camera).Downscaled(kHalvings);
  const std::size_t count = std::min(kPointViews, views.frames.size());
  Raycaster raycaster;
  SurfaceMaps maps;
  for (std::size_t view = 0; view < count; ++view) {
    const StampedThermal& frame = views.frames[view * views.frames.size() / count];
    const auto T_world_depth =
        InterpolatePose(views.trajectory, frame.time + FromSeconds(views.delay_s));
    if (!T_world_depth) continue;
    const RigidTransform T_world_thermal = *T_world_depth * views.T_thermal_depth.inverse();
    raycaster.Cast(tsdf, camera, InFirstMap(T_world_thermal), kMinWeight, pool, maps);
    const std::uint64_t stream = NoiseStream(1, 0x706f696e7473, view);
    for (std::uint64_t i = 0; i < max_points / count; ++i) {
      const auto x = static_cast<int>(UniformNoise(stream, 2 * i) * maps.width());
      const auto y = static_cast<int>(UniformNoise(stream, 2 * i + 1) * maps.height());
      if (std::isnan(maps.vz.At(x, y))) continue;  // No surface.
      points.push_back({{maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)},
                        {maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y)}});
    }
  }
  Shuffle(points);
  return points;
}

void FindVisiblePoints(const TsdfVolume& tsdf, double range_s, ThreadPool& pool, ScanViews& views,
                       const std::function<void(double)>& progress, const std::stop_token& stop) {
  PoseViewer viewer(views, tsdf, pool);
  std::deque<PoseView> window;
  std::size_t next = 0, done = 0;
  for (StampedThermal& frame : views.frames) {
    frame.visible.clear();
    if (stop.stop_requested()) continue;
    if (progress) progress(static_cast<double>(done++) / static_cast<double>(views.frames.size()));
    const CaptureTime time = frame.time + FromSeconds(views.delay_s);
    if (!Covered(views, time, range_s)) continue;
    // There is a pose in between however short the range is.
    const Nanoseconds range = FromSeconds(std::max(range_s, kPoseSpacing_s));
    const CaptureTime first = time - range, last = time + range;
    while (!window.empty() && window.front().time < first) window.pop_front();
    for (; next < views.trajectory.size() && views.trajectory[next].time <= last; ++next) {
      const StampedPose& pose = views.trajectory[next];
      const bool is_new =
          window.empty() || pose.time - window.back().time >= FromSeconds(kPoseSpacing_s);
      if (pose.time >= first && is_new) window.push_back(viewer.See(pose));
    }
    frame.visible = ShownByAll(window, views.points.size());
  }
}

}  // namespace isotherm
