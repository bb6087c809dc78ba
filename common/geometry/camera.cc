#include "common/geometry/camera.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {
namespace {

/// Far more than depth and thermal cameras have; larger ones would make maps of gigabytes.
constexpr int kMaxImageSide = 16384;

/// A point that the lens has moved, in normalised image coordinates, and its derivative by where it
/// was.
struct Distorted {
  Eigen::Vector2d xy;
  Eigen::Matrix2d derivative;
};

Distorted Distort(const CameraModel& camera, const Eigen::Vector2d& normalized) {
  const double x = normalized.x();
  const double y = normalized.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double slope = camera.k1 + r2 * (2.0 * camera.k2 + r2 * 3.0 * camera.k3);  // By r2.
  Distorted result;
  result.xy.x() = x * radial + 2.0 * camera.p1 * x * y + camera.p2 * (r2 + 2.0 * x * x);
  result.xy.y() = y * radial + camera.p1 * (r2 + 2.0 * y * y) + 2.0 * camera.p2 * x * y;
  const double across = 2.0 * (x * y * slope + camera.p1 * x + camera.p2 * y);
  result.derivative << radial + 2.0 * (x * x * slope + camera.p1 * y) + 6.0 * camera.p2 * x, across,
      across, radial + 2.0 * (y * y * slope + camera.p2 * x) + 6.0 * camera.p1 * y;
  return result;
}

/// Normalised; far below what a double's pixel can tell.
constexpr double kConverged = 1e-12;

/// Returns the point that the lens moves to `distorted`; nullopt if it was not found without
/// passing a fold of the polynomial: there may be none.
std::optional<Eigen::Vector2d> UnprojectByNewton(const CameraModel& camera,
                                                 const Eigen::Vector2d& distorted) {
  constexpr int kMaxIterations = 10;
  /// Longer steps outwards, normalised, may lead across a fold.
  constexpr double kMaxStep = 0.5;
  Eigen::Vector2d point = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const auto [xy, derivative] = Distort(camera, point);
    const Eigen::Vector2d error = xy - distorted;
    const double determinant =
        derivative(0, 0) * derivative(1, 1) - derivative(0, 1) * derivative(1, 0);
    if (!(determinant > 0.0)) return std::nullopt;
    if (error.squaredNorm() < kConverged * kConverged) return point;
    const Eigen::Vector2d step(
        (derivative(1, 1) * error.x() - derivative(0, 1) * error.y()) / determinant,
        (derivative(0, 0) * error.y() - derivative(1, 0) * error.x()) / determinant);
    const bool is_outwards = (point - step).squaredNorm() > point.squaredNorm();
    if (is_outwards && step.squaredNorm() > kMaxStep * kMaxStep) return std::nullopt;
    point -= step;
  }
  return std::nullopt;
}

}  // namespace

CameraModel CameraModel::WithoutDistortion() const {
  CameraModel result = *this;
  result.k1 = result.k2 = result.p1 = result.p2 = result.k3 = 0.0;
  return result;
}

CameraModel CameraModel::Downscaled(int levels) const {
  CameraModel result = *this;
  const double scale = 1.0 / static_cast<double>(1 << levels);
  result.width = width >> levels;
  result.height = height >> levels;
  result.fx *= scale;
  result.fy *= scale;
  // Pixel centres are at integers: the centre of a 2x2 group of pixels (0, 1) is at 0.5.
  result.cx = (cx + 0.5) * scale - 0.5;
  result.cy = (cy + 0.5) * scale - 0.5;
  return result;
}

Status Validate(const CameraModel& c, std::string_view name) {
  if (c.width < 1 || c.height < 1 || c.width > kMaxImageSide || c.height > kMaxImageSide) {
    return InvalidArgument(fmt::format("{}: width and height must be 1..{} pixels, got {} x {}",
                                       name, kMaxImageSide, c.width, c.height));
  }
  if (!(std::isfinite(c.fx) && c.fx > 0.0 && std::isfinite(c.fy) && c.fy > 0.0)) {
    return InvalidArgument(fmt::format(
        "{}: fx and fy (focal lengths in pixels) must be given and positive, got {} and {}", name,
        c.fx, c.fy));
  }
  // Fields of view of less than a thousandth of a degree or within as much of 180 degrees.
  constexpr double kMinFocal = 1e-4, kMaxFocal = 1e5;
  for (const double sides : {c.fx / c.width, c.fy / c.height}) {
    if (sides >= kMinFocal && sides <= kMaxFocal) continue;
    return InvalidArgument(fmt::format(
        "{}: fx and fy are focal lengths in pixels; {} and {} make no sense for {} x {} pixels",
        name, c.fx, c.fy, c.width, c.height));
  }
  if (!(c.cx > -c.width && c.cx < 2 * c.width && c.cy > -c.height && c.cy < 2 * c.height)) {
    return InvalidArgument(
        fmt::format("{}: principal point cx cy must be given and lie near the image of {} x {} "
                    "pixels, got {} {}",
                    name, c.width, c.height, c.cx, c.cy));
  }
  for (const double k : {c.k1, c.k2, c.p1, c.p2, c.k3}) {
    // Coefficients of real lenses are below 10; beyond this the iteration in Unproject overflows.
    constexpr double kMaxDistortion = 1e4;
    if (!(std::abs(k) <= kMaxDistortion)) {
      return InvalidArgument(
          fmt::format("{}: distortion k1 k2 p1 p2 k3 must be finite and at most {}, got {}", name,
                      kMaxDistortion, k));
    }
  }
  return OkStatus();
}

Eigen::Vector2d ProjectNormalized(const CameraModel& camera, const Eigen::Vector2d& normalized) {
  const Eigen::Vector2d distorted = Distort(camera, normalized).xy;
  return {camera.fx * distorted.x() + camera.cx, camera.fy * distorted.y() + camera.cy};
}

std::optional<Eigen::Vector2d> Project(const CameraModel& camera, const Eigen::Vector3d& p_camera) {
  if (!(p_camera.z() > 0.0)) return std::nullopt;
  return ProjectNormalized(camera, p_camera.head<2>() / p_camera.z());
}

Eigen::Vector2d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d distorted((pixel.x() - camera.cx) / camera.fx,
                                  (pixel.y() - camera.cy) / camera.fy);
  if (!camera.HasDistortion()) return distorted;
  if (const auto point = UnprojectByNewton(camera, distorted)) return *point;
  // Fixed-point iteration, which also ends somewhere where no point is seen. With the default rig's
  // wide thermal lens the corners of the image take it 29 to 39 steps.
  constexpr int kMaxIterations = 50;
  Eigen::Vector2d point = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d error = Distort(camera, point).xy - distorted;
    point -= error;
    if (error.squaredNorm() < kConverged * kConverged) break;
  }
  return point;
}

}  // namespace isotherm
