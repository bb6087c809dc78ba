#include "common/geometry/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

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

/// By what a lens multiplies the distance of a point from the axis, and that factor's derivative by
/// the squared distance, r2.
struct Radial {
  double factor, slope;
};

Radial PolynomialRadial(const CameraModel& c, double r2) {
  const double above = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double above_slope = c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3);
  if (c.lens != LensKind::kRational) return {above, above_slope};
  const double below = 1.0 + r2 * (c.k4 + r2 * (c.k5 + r2 * c.k6));
  const double below_slope = c.k4 + r2 * (2.0 * c.k5 + r2 * 3.0 * c.k6);
  const double factor = above / below;
  return {factor, (above_slope - factor * below_slope) / below};
}

/// Where a fisheye lens puts what it sees at an angle from the axis, in focal lengths from the
/// principal point, and the derivative by the angle.
struct FisheyeRadius {
  double radius, slope;
};

FisheyeRadius RadiusOf(const CameraModel& c, double angle) {
  const double a2 = angle * angle;
  const double k1 = c.k1, k2 = c.k2, k3 = c.k3, k4 = c.k4;
  return {angle * (1.0 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4)))),
          1.0 + a2 * (3.0 * k1 + a2 * (5.0 * k2 + a2 * (7.0 * k3 + a2 * 9.0 * k4)))};
}

Radial FisheyeRadial(const CameraModel& c, double r2) {
  // Nearer the axis than this the quotients lose digits and the first terms of the series have all:
  // atan(r) / r = 1 - r2 / 3 + ...
  constexpr double kSeries = 1e-8;
  if (r2 < kSeries) return {1.0 + r2 * (c.k1 - 1.0 / 3.0), c.k1 - 1.0 / 3.0};
  const double r = std::sqrt(r2);
  const auto [radius, slope] = RadiusOf(c, std::atan(r));
  const double factor = radius / r;
  return {factor, (slope / (1.0 + r2) - factor) / (2.0 * r2)};
}

Distorted Distort(const CameraModel& camera, const Eigen::Vector2d& normalized) {
  const double x = normalized.x();
  const double y = normalized.y();
  const double r2 = x * x + y * y;
  const auto [radial, slope] =
      camera.lens == LensKind::kFisheye ? FisheyeRadial(camera, r2) : PolynomialRadial(camera, r2);
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
  constexpr int kMaxIterations = 20;
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
    Eigen::Vector2d step(
        (derivative(1, 1) * error.x() - derivative(0, 1) * error.y()) / determinant,
        (derivative(0, 0) * error.y() - derivative(1, 0) * error.x()) / determinant);
    const bool is_outwards = (point - step).squaredNorm() > point.squaredNorm();
    if (is_outwards && step.norm() > kMaxStep) step *= kMaxStep / step.norm();
    point -= step;
  }
  return std::nullopt;
}

/// Returns what a fisheye lens puts at `distorted`; nullopt if there is nothing before the camera.
std::optional<Eigen::Vector2d> UnprojectFisheye(const CameraModel& camera,
                                                const Eigen::Vector2d& distorted) {
  constexpr int kMaxIterations = 20;
  const double radius = distorted.norm();
  double angle = radius;
  for (int i = 0; i < kMaxIterations; ++i) {
    const auto [there, slope] = RadiusOf(camera, angle);
    if (!(slope > 0.0)) return std::nullopt;
    const double error = there - radius;
    if (std::abs(error) < kConverged) {
      if (!(angle < 0.5 * std::numbers::pi)) return std::nullopt;
      return radius > 0.0 ? Eigen::Vector2d(std::tan(angle) / radius * distorted) : distorted;
    }
    angle -= error / slope;
  }
  return std::nullopt;
}

/// Checks that the lens has no coefficients of another one.
Status CheckCoefficients(const CameraModel& c, std::string_view name) {
  if (c.lens > kLastLensKind) {
    return InvalidArgument(fmt::format("{}: there is no lens model {}: it is of a later version",
                                       name, static_cast<int>(c.lens)));
  }
  const bool is_wide = c.k5 != 0.0 || c.k6 != 0.0;
  if (c.lens == LensKind::kBrownConrady && (is_wide || c.k4 != 0.0)) {
    return InvalidArgument(fmt::format(
        "{}: k4 k5 k6 are those of a wide lens: lens: RATIONAL (or FISHEYE, with k4) must be given "
        "with them",
        name));
  }
  if (c.lens == LensKind::kFisheye && (is_wide || c.p1 != 0.0 || c.p2 != 0.0)) {
    return InvalidArgument(
        fmt::format("{}: a FISHEYE lens has k1 k2 k3 k4 only, not p1 p2 k5 k6", name));
  }
  return OkStatus();
}

}  // namespace

bool CameraModel::HasDistortion() const {
  if (lens == LensKind::kFisheye) return true;
  for (const double k : {k1, k2, p1, p2, k3, k4, k5, k6})
    if (k != 0.0) return true;
  return false;
}

CameraModel CameraModel::WithoutDistortion() const {
  CameraModel result = *this;
  result.k1 = result.k2 = result.p1 = result.p2 = result.k3 = 0.0;
  result.k4 = result.k5 = result.k6 = 0.0;
  result.lens = LensKind::kBrownConrady;
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
  for (const double k : {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6}) {
    // Coefficients of real lenses are below 10; beyond this the iteration in Unproject overflows.
    constexpr double kMaxDistortion = 1e4;
    if (!(std::abs(k) <= kMaxDistortion)) {
      return InvalidArgument(fmt::format(
          "{}: distortion k1 k2 p1 p2 k3 k4 k5 k6 must be finite and at most {}, got {}", name,
          kMaxDistortion, k));
    }
  }
  return CheckCoefficients(c, name);
}

ProjectedPixel ProjectWithDerivative(const CameraModel& camera, const Eigen::Vector2d& normalized) {
  const Distorted distorted = Distort(camera, normalized);
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  return {distorted.xy.cwiseProduct(focal) + Eigen::Vector2d(camera.cx, camera.cy),
          focal.asDiagonal() * distorted.derivative};
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
  if (camera.lens == LensKind::kFisheye)
    return UnprojectFisheye(camera, distorted).value_or(distorted);
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
