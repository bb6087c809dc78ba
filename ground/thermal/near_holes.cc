#include "ground/thermal/near_holes.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Side of the thermal tiles that are judged as one, pixels.
constexpr int kTile = 8;
/// Points that are looked at on a line of sight, even in inverse depth down to this share of the
/// near range.
constexpr int kSteps = 10;
constexpr double kNearestShare = 0.2;
/// Pixels of a square that must show known surface, and those of them that may have a return.
constexpr double kKnownShare = 0.9;
constexpr double kReturnShare = 0.1;

int Tiles(int pixels) { return (pixels + kTile - 1) / kTile; }

}  // namespace

NearHoles::NearHoles(const ThermalOptions& options, const CameraModel& thermal_camera,
                     const RigidTransform& T_thermal_depth)
    : near_range_m_(options.near_range_m()),
      hole_px_(options.hole_px()),
      thermal_camera_(thermal_camera),
      T_depth_thermal_(T_thermal_depth.inverse()),
      left_out_(Tiles(thermal_camera.width), Tiles(thermal_camera.height)) {}

bool NearHoles::FindHoles(const Image<float>& depth_m, const SurfaceMaps& model) {
  const int scale = std::max(1, depth_m.width() / model.width());
  hole_side_ = std::max(1, hole_px_ / scale);
  holes_.Resize(model.width() / hole_side_, model.height() / hole_side_);
  const int known_needed = static_cast<int>(std::ceil(kKnownShare * hole_side_ * hole_side_));
  bool found = false;
  for (int row = 0; row < holes_.height(); ++row) {
    for (int column = 0; column < holes_.width(); ++column) {
      int known = 0;
      int returns = 0;
      for (int y = row * hole_side_; y < (row + 1) * hole_side_; ++y) {
        for (int x = column * hole_side_; x < (column + 1) * hole_side_; ++x) {
          if (std::isnan(model.vx.At(x, y))) continue;
          ++known;
          returns += depth_m.At(x * scale, y * scale) > 0.0F ? 1 : 0;
        }
      }
      const bool hole = known >= known_needed && returns <= kReturnShare * known;
      holes_.At(column, row) = hole ? 1 : 0;
      found = found || hole;
    }
  }
  return found;
}

bool NearHoles::CrossesHole(const Eigen::Vector2d& xy_thermal,
                            const CameraModel& model_camera) const {
  for (int i = 0; i < kSteps; ++i) {
    const double share = 1.0 + i * (1.0 / kNearestShare - 1.0) / (kSteps - 1);
    const double z_m = near_range_m_ / share;
    const Eigen::Vector3d p =
        T_depth_thermal_ * (z_m * Eigen::Vector3d(xy_thermal.x(), xy_thermal.y(), 1.0));
    if (!(p.z() > 0.0 && p.z() <= near_range_m_)) continue;
    const double u = model_camera.fx * p.x() / p.z() + model_camera.cx + 0.5;
    const double v = model_camera.fy * p.y() / p.z() + model_camera.cy + 0.5;
    if (!(u >= 0.0 && v >= 0.0)) continue;
    const double column = u / hole_side_;
    const double row = v / hole_side_;
    if (column >= holes_.width() || row >= holes_.height()) continue;
    if (holes_.At(static_cast<int>(column), static_cast<int>(row)) != 0) return true;
  }
  return false;
}

void NearHoles::Update(const Image<float>& depth_m, const SurfaceMaps& model,
                       const CameraModel& model_camera) {
  any_ = false;
  if (near_range_m_ <= 0.0 || model.width() == 0 || !FindHoles(depth_m, model)) return;
  for (int row = 0; row < left_out_.height(); ++row) {
    for (int column = 0; column < left_out_.width(); ++column) {
      const double u = (column + 0.5) * kTile - 0.5;
      const double v = (row + 0.5) * kTile - 0.5;
      const Eigen::Vector2d xy((u - thermal_camera_.cx) / thermal_camera_.fx,
                               (v - thermal_camera_.cy) / thermal_camera_.fy);
      const bool crosses = CrossesHole(xy, model_camera);
      left_out_.At(column, row) = crosses ? 1 : 0;
      any_ = any_ || crosses;
    }
  }
}

std::int64_t NearHoles::LeaveOut(int y, std::span<ThermalPixel> row) const {
  std::int64_t count = 0;
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (left_out_.At(static_cast<int>(x) / kTile, y / kTile) == 0) continue;
    count += (row[x].flags & ThermalPixel::kAssignable) != 0 ? 1 : 0;
    row[x].flags &= ~ThermalPixel::kAssignable;
  }
  return count;
}

}  // namespace isotherm
