#include "ground/calibration/texture_rendering.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "common/frame/frame.h"
#include "common/geometry/map_pose.h"
#include "ground/calibration/point_visibility.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

// More images would hardly change the mean.
constexpr std::size_t kMaxFrames = 100;
// Surface seen once may be noise beside an edge.
constexpr float kMinWeight = 2.0F;

/// Sums by pixel.
struct MeanOfPixel {
  double celsius = 0.0;
  int count = 0;
};

/// The temperature in the nearest pixel; nullopt where there is none.
std::optional<double> NearestCelsius(const StampedThermal& frame, const Eigen::Vector2d& pixel) {
  const auto x = static_cast<int>(std::lround(pixel.x()));
  const auto y = static_cast<int>(std::lround(pixel.y()));
  const Image<std::uint16_t>& raw = *frame.temperature_raw;
  if (x < 0 || y < 0 || x >= raw.width() || y >= raw.height() || raw.At(x, y) == 0)
    return std::nullopt;
  return frame.scale.Celsius(raw.At(x, y));
}

}  // namespace

Image<float> MeanTexture(const TsdfVolume& tsdf, const ScanViews& views,
                         const ThermalPlacement& placement, std::size_t shown, ThreadPool& pool) {
  const CameraModel camera = placement.camera.WithoutDistortion();
  Image<float> rendering(camera.width, camera.height, NAN);
  const auto pose_at = [&](const StampedThermal& frame) {
    return InterpolatePose(views.trajectory, frame.time + FromSeconds(placement.delay_s));
  };
  const auto T_world_depth = pose_at(views.frames[shown]);
  if (!T_world_depth) return rendering;
  SurfaceMaps maps;
  Raycaster().Cast(tsdf, camera, InFirstMap(*T_world_depth * placement.T_thermal_depth.inverse()),
                   kMinWeight, pool, maps);
  ScanViews seen;
  seen.thermal_camera = placement.camera;
  seen.T_thermal_depth = placement.T_thermal_depth;
  seen.delay_s = placement.delay_s;
  seen.trajectory = views.trajectory;
  const std::size_t stride = 1 + views.frames.size() / kMaxFrames;
  for (std::size_t i = shown % stride; i < views.frames.size(); i += stride)
    seen.frames.push_back(views.frames[i]);
  std::vector<std::size_t> pixels;
  for (int y = 0; y < maps.height(); ++y) {
    for (int x = 0; x < maps.width(); ++x) {
      if (std::isnan(maps.vz.At(x, y))) continue;
      pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(x));
      seen.points.push_back({{maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)},
                             {maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y)}});
    }
  }
  FindVisiblePoints(tsdf, 0.0, pool, seen, {});
  std::vector<MeanOfPixel> means(seen.points.size());
  for (const StampedThermal& frame : seen.frames) {
    const auto pose = pose_at(frame);
    if (!pose) continue;
    const RigidTransform T_thermal_world = placement.T_thermal_depth * pose->inverse();
    for (const std::uint32_t point : frame.visible) {
      const auto pixel = Project(placement.camera, T_thermal_world * seen.points[point].p_world);
      const auto celsius = pixel ? NearestCelsius(frame, *pixel) : std::nullopt;
      if (!celsius) continue;
      means[point].celsius += *celsius;
      ++means[point].count;
    }
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i].count > 0)
      rendering.pixels()[pixels[i]] = static_cast<float>(means[i].celsius / means[i].count);
  }
  return rendering;
}

std::size_t WidestFrame(const ScanViews& views) {
  const auto widest = std::max_element(views.frames.begin(), views.frames.end(),
                                       [](const StampedThermal& a, const StampedThermal& b) {
                                         return a.visible.size() < b.visible.size();
                                       });
  return static_cast<std::size_t>(std::distance(views.frames.begin(), widest));
}

}  // namespace isotherm
