#include "ground/thermal/near_range_occlusion.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Side of the thermal tiles that are assessed as one, pixels: a 64th of the work, and the rule has
/// no finer edge anyway (holes are found in squares). Larger: more is left out around a hand.
constexpr int kNearTile = 8;
/// Points that are looked at on a line of sight, even in inverse depth, so that they are evenly
/// apart in the depth image.
constexpr int kNearSteps = 10;
/// The nearest of those points, as a fraction of the near range: nearer, nothing fits between the
/// cameras and the lens. Smaller: points farther apart.
constexpr double kNearestFraction = 0.2;
/// A square is a hole if this fraction of its pixels shows known surface and gets no return now.
/// Less: new holes beside unknown ground are missed less often, but silhouettes count as holes. Not
/// tuned.
constexpr double kKnownFraction = 0.9;
/// A hole, or a square without known surface that counts as empty, may have returns in this
/// fraction of its pixels: speckle at the rim. Not tuned.
constexpr double kReturnFraction = 0.1;
/// From this fraction of returns on there certainly is a surface; between the two the square says
/// nothing. Not tuned.
constexpr double kSurfaceFraction = 0.5;
/// Between projector and camera of PrimeSense's cameras, with some reserve: beside the edge of
/// something near, what lies behind is in the projector's shadow.
constexpr double kProjectorBaseline_m = 0.08;

int Tiles(int pixels) { return (pixels + kNearTile - 1) / kNearTile; }

}  // namespace

NearRangeOcclusion::NearRangeOcclusion(const ThermalOcclusionOptions& options,
                                       const DepthSensorModel& depth_sensor,
                                       const CameraModel& thermal_camera)
    : near_range_m_(depth_sensor.near_range_m),
      hole_px_(options.hole_px()),
      thermal_camera_(thermal_camera),
      left_out_(Tiles(thermal_camera.width), Tiles(thermal_camera.height)) {}

NearRangeOcclusion::Square NearRangeOcclusion::Look(int column, int row,
                                                    const Image<float>& depth_m,
                                                    const SurfaceMaps& model) const {
  const int scale = std::max(1, depth_m.width() / model.width());
  int known = 0, returns = 0, known_returns = 0;
  float sum_m = 0.0F;
  // A quarter of the pixels says as much.
  for (int y = row * hole_side_; y < (row + 1) * hole_side_; y += 2) {
    for (int x = column * hole_side_; x < (column + 1) * hole_side_; x += 2) {
      const bool is_known = !std::isnan(model.vx.At(x, y));
      const float z_m = depth_m.At(x * scale, y * scale);
      const bool has_return = z_m > 0.0F;
      known += is_known ? 1 : 0;
      returns += has_return ? 1 : 0;
      known_returns += is_known && has_return ? 1 : 0;
      sum_m += z_m;
    }
  }
  const int looked_at = (hole_side_ + 1) / 2;
  const double pixels = looked_at * looked_at;
  if (known >= kKnownFraction * pixels && known_returns <= kReturnFraction * known)
    return {Kind::kHole, 0.0F};
  if (returns <= kReturnFraction * pixels) return {Kind::kEmpty, 0.0F};
  if (returns < kSurfaceFraction * pixels) return {Kind::kNeither, 0.0F};
  return {Kind::kSurface, sum_m / static_cast<float>(returns)};
}

bool NearRangeOcclusion::FindHoles(const Image<float>& depth_m, const SurfaceMaps& model,
                                   double model_fx) {
  const int scale = std::max(1, depth_m.width() / model.width());
  hole_side_ = std::max(1, hole_px_ / scale);
  squares_.Resize(model.width() / hole_side_, model.height() / hole_side_);
  for (int row = 0; row < squares_.height(); ++row) {
    for (int column = 0; column < squares_.width(); ++column)
      squares_.At(column, row) = Look(column, row, depth_m, model);
  }
  // Rows first: they know shadows, which lie along rows only, and columns must not take those for
  // holes.
  for (int row = 0; row < squares_.height(); ++row) AssessRow(row, model_fx);
  for (int column = 0; column < squares_.width(); ++column) AssessColumn(column);
  return std::ranges::count(squares_.pixels(), Kind::kHole, &Square::kind) > 0;
}

template <typename At, typename Assess>
void NearRangeOcclusion::ForEmptyRuns(int count, const At& at, const Assess& assess) {
  // Depth of the surface next to a run, 0 = the image's border or nothing certain.
  const auto beside_m = [&](int i, int step) {
    while (i >= 0 && i < count && at(i).kind == Kind::kNeither) i += step;
    return i >= 0 && i < count ? at(i).depth_m : 0.0F;
  };
  for (int first = 0, end = 0; first < count; first = end + 1) {
    end = first;
    while (end < count && at(end).is_empty()) ++end;
    if (end > first) assess(first, end, beside_m(first - 1, -1), beside_m(end, 1));
  }
}

void NearRangeOcclusion::AssessRow(int row, double model_fx) {
  const auto at = [&](int i) -> Square& { return squares_.At(i, row); };
  ForEmptyRuns(squares_.width(), at, [&](int first, int end, float left_m, float right_m) {
    const auto inverse = [](float z_m) { return z_m > 0.0F ? 1.0F / z_m : 0.0F; };
    // Width of the projector's shadow beside an edge, by triangulation.
    const double shadow_px = kProjectorBaseline_m * model_fx *
                             static_cast<double>(std::abs(inverse(left_m) - inverse(right_m)));
    const int width_px = (end - first) * hole_side_;
    const bool is_shadow = width_px <= shadow_px + 2 * hole_side_ && shadow_px > hole_side_;
    const bool is_between = left_m > 0.0F && right_m > 0.0F;
    if (!is_shadow && !is_between) return;
    for (int i = first; i < end; ++i) at(i).kind = is_shadow ? Kind::kNeither : Kind::kHole;
  });
}

void NearRangeOcclusion::AssessColumn(int column) {
  const auto at = [&](int i) -> Square& { return squares_.At(column, i); };
  ForEmptyRuns(squares_.height(), at, [&](int first, int end, float above_m, float below_m) {
    if (!(above_m > 0.0F && below_m > 0.0F)) return;
    for (int i = first; i < end; ++i) at(i).kind = Kind::kHole;
  });
}

bool NearRangeOcclusion::CrossesHole(const Eigen::Vector2d& xy_thermal) const {
  for (int i = 0; i < kNearSteps; ++i) {
    const double fraction = 1.0 + i * (1.0 / kNearestFraction - 1.0) / (kNearSteps - 1);
    const double z_m = near_range_m_ / fraction;
    const Eigen::Vector3d p =
        T_depth_thermal_ * (z_m * Eigen::Vector3d(xy_thermal.x(), xy_thermal.y(), 1.0));
    if (!(p.z() > 0.0 && p.z() <= near_range_m_)) continue;
    const double u = model_camera_.fx * p.x() / p.z() + model_camera_.cx + 0.5;
    const double v = model_camera_.fy * p.y() / p.z() + model_camera_.cy + 0.5;
    if (!(u >= 0.0 && v >= 0.0)) continue;
    const double column = u / hole_side_;
    const double row = v / hole_side_;
    if (column >= squares_.width() || row >= squares_.height()) continue;
    if (squares_.At(static_cast<int>(column), static_cast<int>(row)).kind == Kind::kHole)
      return true;
  }
  return false;
}

void NearRangeOcclusion::Update(const Image<float>& depth_m, const SurfaceMaps& model,
                                const CameraModel& model_camera) {
  model_camera_ = model_camera;
  any_ = false;
  has_holes_ =
      near_range_m_ > 0.0 && model.width() > 0 && FindHoles(depth_m, model, model_camera.fx);
}

void NearRangeOcclusion::Aim(const RigidTransform& T_depth_thermal) {
  T_depth_thermal_ = T_depth_thermal;
  any_ = false;
  if (!has_holes_) return;
  for (int row = 0; row < left_out_.height(); ++row) {
    for (int column = 0; column < left_out_.width(); ++column) {
      const double u = (column + 0.5) * kNearTile - 0.5;
      const double v = (row + 0.5) * kNearTile - 0.5;
      const Eigen::Vector2d xy((u - thermal_camera_.cx) / thermal_camera_.fx,
                               (v - thermal_camera_.cy) / thermal_camera_.fy);
      const bool crosses = CrossesHole(xy);
      left_out_.At(column, row) = crosses ? 1 : 0;
      any_ = any_ || crosses;
    }
  }
}

std::int64_t NearRangeOcclusion::LeaveOut(int y, std::span<ThermalPixel> row) const {
  std::int64_t count = 0;
  if (!any_) return count;
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (left_out_.At(static_cast<int>(x) / kNearTile, y / kNearTile) == 0) continue;
    count += (row[x].flags & ThermalPixel::kAssignable) != 0 ? 1 : 0;
    row[x].flags &= ~ThermalPixel::kAssignable;
  }
  return count;
}

}  // namespace isotherm
