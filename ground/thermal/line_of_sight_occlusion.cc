#include "ground/thermal/line_of_sight_occlusion.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Side of the squares of thermal pixels that share a line of sight.
constexpr int kSightTile = 4;
/// Points that are looked at on a line of sight, evenly in inverse depth: two to three pixels of a
/// halved depth image apart, with cameras 5 cm apart and surfaces up to 1.5 m away.
constexpr int kSightSteps = 12;
/// Every so manieth pixel of the model's view each way is looked at. Those between may be
/// interpolated (ViewRaycaster), and have no surface beside edges, where an occluder must not end
/// a pixel too early. Points on a line of sight are as far apart.
constexpr int kThinning = 2;

}  // namespace

LineOfSightOcclusion::LineOfSightOcclusion(const ThermalOcclusionOptions& options,
                                           const DepthSensorModel& depth_sensor,
                                           const CameraModel& thermal_camera)
    : near_range_m_(static_cast<float>(depth_sensor.near_range_m)),
      tolerance_m_(static_cast<float>(options.parallax_tolerance_m())),
      thermal_camera_(thermal_camera) {}

void LineOfSightOcclusion::Aim(const RigidTransform& T_depth_thermal) {
  R_depth_thermal_ = T_depth_thermal.linear().cast<float>();
  t_depth_thermal_ = T_depth_thermal.translation().cast<float>();
}

void LineOfSightOcclusion::Update(const SurfaceMaps& model, const CameraModel& model_camera,
                                  const RigidTransform& T_map_depth) {
  fx_ = static_cast<float>(model_camera.fx) / kThinning;
  fy_ = static_cast<float>(model_camera.fy) / kThinning;
  cx_ = static_cast<float>(model_camera.cx) / kThinning;
  cy_ = static_cast<float>(model_camera.cy) / kThinning;
  depth_m_.Resize((model.width() + kThinning - 1) / kThinning,
                  (model.height() + kThinning - 1) / kThinning);
  const Eigen::Vector4f z = T_map_depth.inverse().matrix().row(2).cast<float>();
  for (int v = 0; v < depth_m_.height(); ++v) {
    const float* const x_map = model.vx.Row(kThinning * v).data();
    const float* const y_map = model.vy.Row(kThinning * v).data();
    const float* const z_map = model.vz.Row(kThinning * v).data();
    float* const depth_m = depth_m_.Row(v).data();
    for (int u = 0; u < depth_m_.width(); ++u) {
      const int i = kThinning * u;
      depth_m[u] = z[0] * x_map[i] + z[1] * y_map[i] + z[2] * z_map[i] + z[3];
    }
  }
}

float LineOfSightOcclusion::ProvenUpTo(const Eigen::Vector2f& xy_thermal, float z_m) const {
  const Eigen::Vector3f ray = R_depth_thermal_ * xy_thermal.homogeneous();
  const auto last_u = static_cast<float>(depth_m_.width() - 1);
  const auto last_v = static_cast<float>(depth_m_.height() - 1);
  const float nearest = 1.0F / near_range_m_;
  const float step = (nearest - 1.0F / z_m) / kSightSteps;
  for (int i = 0; i < kSightSteps; ++i) {
    const float z_thermal = 1.0F / (nearest - static_cast<float>(i) * step);
    const Eigen::Vector3f p = z_thermal * ray + t_depth_thermal_;
    // What reaches the image's border goes on beyond it.
    if (!(p.z() > 0.0F)) continue;
    const float inverse_z = 1.0F / p.z();
    const float u = std::clamp(fx_ * p.x() * inverse_z + cx_ + 0.5F, 0.0F, last_u);
    const float v = std::clamp(fy_ * p.y() * inverse_z + cy_ + 0.5F, 0.0F, last_v);
    // NaN: no surface there, and nothing to be behind of.
    const bool behind =
        p.z() > depth_m_.At(static_cast<int>(u), static_cast<int>(v)) + tolerance_m_;
    if (behind && z_thermal < z_m - tolerance_m_) return z_thermal;
  }
  return z_m;
}

std::int64_t LineOfSightOcclusion::LeaveOut(int y, std::span<ThermalPixel> rows) const {
  const int width = thermal_camera_.width;
  const int height = static_cast<int>(rows.size()) / width;
  if (near_range_m_ <= 0.0F || depth_m_.width() == 0) return 0;
  const auto fx = static_cast<float>(thermal_camera_.fx),
             fy = static_cast<float>(thermal_camera_.fy);
  const auto cx = static_cast<float>(thermal_camera_.cx),
             cy = static_cast<float>(thermal_camera_.cy);
  std::int64_t count = 0;
  for (int top = 0; top < height; top += kSightTile) {
    for (int left = 0; left < width; left += kSightTile) {
      const int bottom = std::min(top + kSightTile, height),
                right = std::min(left + kSightTile, width);
      float farthest_m = 0.0F;
      for (int row = top; row < bottom; ++row) {
        for (int x = left; x < right; ++x) {
          const ThermalPixel& pixel = rows[static_cast<std::size_t>(row * width + x)];
          if ((pixel.flags & ThermalPixel::kAssignable) != 0)
            farthest_m = std::max(farthest_m, pixel.depth_m);
        }
      }
      if (farthest_m <= near_range_m_) continue;
      const Eigen::Vector2f xy(
          (0.5F * static_cast<float>(left + right - 1) - cx) / fx,
          (static_cast<float>(y) + 0.5F * static_cast<float>(top + bottom - 1) - cy) / fy);
      const float proven_m = ProvenUpTo(xy, farthest_m);
      if (proven_m >= farthest_m) continue;
      for (int row = top; row < bottom; ++row) {
        for (int x = left; x < right; ++x) {
          ThermalPixel& pixel = rows[static_cast<std::size_t>(row * width + x)];
          if ((pixel.flags & ThermalPixel::kAssignable) == 0 || pixel.depth_m <= proven_m) continue;
          pixel.flags &= ~ThermalPixel::kAssignable;
          ++count;
        }
      }
    }
  }
  return count;
}

}  // namespace isotherm
