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
/// Pixels of a square that have a return where there certainly is a surface.
constexpr double kSurfaceShare = 0.5;

int Tiles(int pixels) { return (pixels + kTile - 1) / kTile; }

}  // namespace

NearHoles::NearHoles(const ThermalOptions& options, const CameraModel& thermal_camera,
                     const RigidTransform& T_thermal_depth)
    : near_range_m_(options.near_range_m()),
      hole_px_(options.hole_px()),
      thermal_camera_(thermal_camera),
      T_depth_thermal_(T_thermal_depth.inverse()),
      left_out_(Tiles(thermal_camera.width), Tiles(thermal_camera.height)) {}

NearHoles::Square NearHoles::Look(int column, int row, const Image<float>& depth_m,
                                  const SurfaceMaps& model) const {
  const int scale = std::max(1, depth_m.width() / model.width());
  int known = 0, returns = 0, known_returns = 0;
  for (int y = row * hole_side_; y < (row + 1) * hole_side_; ++y) {
    for (int x = column * hole_side_; x < (column + 1) * hole_side_; ++x) {
      const bool is_known = !std::isnan(model.vx.At(x, y));
      const bool has_return = depth_m.At(x * scale, y * scale) > 0.0F;
      known += is_known ? 1 : 0;
      returns += has_return ? 1 : 0;
      known_returns += is_known && has_return ? 1 : 0;
    }
  }
  const double pixels = hole_side_ * hole_side_;
  if (known >= kKnownShare * pixels && known_returns <= kReturnShare * known) return Square::kHole;
  if (returns <= kReturnShare * pixels) return Square::kEmpty;
  return returns >= kSurfaceShare * pixels ? Square::kSurface : Square::kNeither;
}

bool NearHoles::FindHoles(const Image<float>& depth_m, const SurfaceMaps& model) {
  const int scale = std::max(1, depth_m.width() / model.width());
  hole_side_ = std::max(1, hole_px_ / scale);
  squares_.Resize(model.width() / hole_side_, model.height() / hole_side_);
  for (int row = 0; row < squares_.height(); ++row) {
    for (int column = 0; column < squares_.width(); ++column)
      squares_.At(column, row) = Look(column, row, depth_m, model);
  }
  for (int row = 0; row < squares_.height(); ++row) FillBetween(0, row, 1, 0);
  for (int column = 0; column < squares_.width(); ++column) FillBetween(column, 0, 0, 1);
  return std::ranges::count(squares_.pixels(), Square::kHole) > 0;
}

void NearHoles::FillBetween(int column, int row, int step_x, int step_y) {
  const int count = step_x != 0 ? squares_.width() : squares_.height();
  const auto square = [&](int i) -> Square& {
    return squares_.At(column + i * step_x, row + i * step_y);
  };
  int first = 0, last = count - 1;
  while (first < count && square(first) != Square::kSurface) ++first;
  while (last > first && square(last) != Square::kSurface) --last;
  for (int i = first + 1; i < last; ++i) {
    if (square(i) == Square::kEmpty) square(i) = Square::kHole;
  }
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
    if (column >= squares_.width() || row >= squares_.height()) continue;
    if (squares_.At(static_cast<int>(column), static_cast<int>(row)) == Square::kHole) return true;
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
