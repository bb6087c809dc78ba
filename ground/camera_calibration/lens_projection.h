#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "common/geometry/camera.h"

namespace isotherm {

constexpr std::string_view ToString(LensKind kind) {
  switch (kind) {
    case LensKind::kBrownConrady:
      return "brown-conrady";
    case LensKind::kRational:
      return "rational";
    case LensKind::kFisheye:
      return "fisheye";
  }
  return "";
}

inline constexpr int kMaxLensParameters = 12;

/// The parameters of a lens: fx fy cx cy and its kind's coefficients; those that it does not have
/// are 0.
using LensParameters = std::array<double, kMaxLensParameters>;

constexpr int LensParameterCount(LensKind kind) {
  switch (kind) {
    case LensKind::kBrownConrady:
      return 9;
    case LensKind::kRational:
      return 12;
    case LensKind::kFisheye:
      return 8;
  }
  return 0;
}

constexpr std::string_view LensParameterName(LensKind kind, int index) {
  constexpr std::array<std::string_view, kMaxLensParameters> kPolynomial = {
      "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  constexpr std::array<std::string_view, 8> kFisheye = {"fx", "fy", "cx", "cy",
                                                        "k1", "k2", "k3", "k4"};
  const auto i = static_cast<std::size_t>(index);
  return kind == LensKind::kFisheye ? kFisheye[i] : kPolynomial[i];
}

/// The polynomials of Brown-Conrady and rational lenses: normalised coordinates (x, y) to pixels.
template <typename T>
void ProjectPolynomial(LensKind kind, const T* p, const T& x, const T& y, T* pixel) {
  const T r2 = x * x + y * y;
  T radial = T(1.0) + r2 * (p[4] + r2 * (p[5] + r2 * p[8]));
  if (kind == LensKind::kRational)
    radial = radial / (T(1.0) + r2 * (p[9] + r2 * (p[10] + r2 * p[11])));
  const T xd = x * radial + T(2.0) * p[6] * x * y + p[7] * (r2 + T(2.0) * x * x);
  const T yd = y * radial + p[6] * (r2 + T(2.0) * y * y) + T(2.0) * p[7] * x * y;
  pixel[0] = p[0] * xd + p[2];
  pixel[1] = p[1] * yd + p[3];
}

/// A fisheye lens: the distance from the principal point is a polynomial of the angle.
template <typename T>
void ProjectFisheye(const T* p, const T* point, T* pixel) {
  using std::atan2;
  using std::sqrt;
  const T r2 = point[0] * point[0] + point[1] * point[1];
  T scale = T(1.0) / point[2];
  constexpr double kOnAxis = 1e-20;  // Square metres; a root has no derivative at 0.
  if (r2 > T(kOnAxis)) {
    const T r = sqrt(r2);
    const T theta = atan2(r, point[2]);
    const T t2 = theta * theta;
    scale = theta * (T(1.0) + t2 * (p[4] + t2 * (p[5] + t2 * (p[6] + t2 * p[7])))) / r;
  }
  pixel[0] = p[0] * scale * point[0] + p[2];
  pixel[1] = p[1] * scale * point[1] + p[3];
}

/// Projects a point of the camera's optical frame (metres). Returns false behind the camera.
template <typename T>
bool ProjectLens(LensKind kind, const T* p, const T* point, T* pixel) {
  if (!(point[2] > T(0.0))) return false;
  if (kind == LensKind::kFisheye) {
    ProjectFisheye(p, point, pixel);
  } else {
    ProjectPolynomial(kind, p, T(point[0] / point[2]), T(point[1] / point[2]), pixel);
  }
  return true;
}

}  // namespace isotherm
