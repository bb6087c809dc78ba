#include "common/geometry/rectified_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Longest side of a rectified image, in sides of the raw one. The rectified view of a cubic barrel
/// lens is at most so large: its polynomial turns over there.
constexpr double kMaxGrowth = 1.5;
/// A pixel is looked back at from the point that it sees: farther away than this, normalised, the
/// polynomial has folded or the iteration has not ended.
constexpr double kSamePoint = 1e-3;
/// Tangent of 70 degrees: nothing that a very wide lens sees farther from its axis is kept. A plane
/// image of all of it would have hardly any pixels left for the middle.
constexpr double kMaxNormalized = 2.75;

/// Returns what the centres of the border's pixels see, in normalised image coordinates.
Eigen::AlignedBox2d UndistortedBorder(const CameraModel& camera) {
  Eigen::AlignedBox2d border;
  const auto extend = [&](int u, int v) {
    const Eigen::Vector2d pixel(u, v);
    const Eigen::Vector2d point = Unproject(camera, pixel);
    const Eigen::Vector2d error_px = ProjectNormalized(camera, point) - pixel;
    const bool is_seen = error_px.norm() <= kSamePoint * camera.fx;
    if (is_seen && point.norm() <= kMaxNormalized) {
      border.extend(point);
    } else if (is_seen || camera.lens == LensKind::kFisheye) {
      // A pixel that looks aside or backwards, or beyond a fold, where what it sees is not known.
      border.extend(kMaxNormalized * point.normalized());
    }
  };
  for (int u = 0; u < camera.width; ++u) {
    extend(u, 0);
    extend(u, camera.height - 1);
  }
  for (int v = 0; v < camera.height; ++v) {
    extend(0, v);
    extend(camera.width - 1, v);
  }
  return border;
}

}  // namespace

std::optional<Eigen::Vector2d> ProjectIntoImage(const CameraModel& camera,
                                                const Eigen::Vector2d& normalized) {
  const Eigen::Vector2d pixel = ProjectNormalized(camera, normalized);
  if (!(pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 &&
        pixel.y() < camera.height - 0.5)) {
    return std::nullopt;
  }
  if (!((Unproject(camera, pixel) - normalized).norm() <= kSamePoint)) return std::nullopt;
  return pixel;
}

CameraModel RectifiedCamera(const CameraModel& camera) {
  CameraModel result = camera.WithoutDistortion();
  if (!camera.HasDistortion()) return result;
  const Eigen::AlignedBox2d border = UndistortedBorder(camera);
  if (border.isEmpty() || !border.sizes().allFinite()) return result;
  // With the principal point in the image it sees what is straight ahead, or it is no lens.
  const bool is_centred = camera.cx >= 0.0 && camera.cx <= camera.width - 1.0 && camera.cy >= 0.0 &&
                          camera.cy <= camera.height - 1.0;
  if (is_centred && !border.contains(Eigen::Vector2d(0.0, 0.0))) return result;
  const double shortened =
      std::min({1.0, (kMaxGrowth * camera.width - 1.0) / camera.fx / border.sizes().x(),
                (kMaxGrowth * camera.height - 1.0) / camera.fy / border.sizes().y()});
  result.fx *= shortened;
  result.fy *= shortened;
  // A border that is whole pixels but for rounding must not cost another row.
  constexpr double kRounding_px = 1e-6;
  const auto place = [](double focal_px, double min, double max, double& principal, int& size) {
    const double first = std::floor(focal_px * min + principal + kRounding_px);
    const double last = std::ceil(focal_px * max + principal - kRounding_px);
    principal -= first;
    size = static_cast<int>(last - first) + 1;
  };
  place(result.fx, border.min().x(), border.max().x(), result.cx, result.width);
  place(result.fy, border.min().y(), border.max().y(), result.cy, result.height);
  return result;
}

}  // namespace isotherm
