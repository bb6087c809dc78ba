#pragma once

#include <cmath>
#include <limits>

#include "common/simulation/primitive.h"

/// Inlined into loops that are compiled for another instruction set than the rest of the program.
#define ISOTHERM_ALWAYS_INLINE inline __attribute__((always_inline))

namespace isotherm {

/// A ray in a primitive's coordinates: origin + t direction. The direction needs no unit length.
template <typename T>
struct LocalRay {
  T ox, oy, oz;
  T dx, dy, dz;
};

/// Primitive::size in the kernel's precision.
template <typename T>
struct LocalSize {
  T a, b, c;
};

/// Nothing is hit.
template <typename T>
inline constexpr T kNoHit = std::numeric_limits<T>::infinity();

// First t > 0 at which a ray from outside enters a shape, or kNoHit. Written without branches, so
// that loops over rays become SIMD code: conditions are combined with & and |, and comparisons with
// NaN are false.

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectBox(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const T ix = T(1) / ray.dx, iy = T(1) / ray.dy, iz = T(1) / ray.dz;
  const T x1 = (-size.a - ray.ox) * ix, x2 = (size.a - ray.ox) * ix;
  const T y1 = (-size.b - ray.oy) * iy, y2 = (size.b - ray.oy) * iy;
  const T z1 = (-size.c - ray.oz) * iz, z2 = (size.c - ray.oz) * iz;
  const T nx = x1 < x2 ? x1 : x2, fx = x1 < x2 ? x2 : x1;
  const T ny = y1 < y2 ? y1 : y2, fy = y1 < y2 ? y2 : y1;
  const T nz = z1 < z2 ? z1 : z2, fz = z1 < z2 ? z2 : z1;
  const T nxy = nx > ny ? nx : ny, fxy = fx < fy ? fx : fy;
  const T enter = nxy > nz ? nxy : nz, leave = fxy < fz ? fxy : fz;
  return ((enter <= leave) & (enter > T(0))) ? enter : kNoHit<T>;
}

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectRectangle(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const T t = -ray.oz / ray.dz;
  const T x = std::abs(ray.ox + t * ray.dx), y = std::abs(ray.oy + t * ray.dy);
  return ((x <= size.a) & (y <= size.b) & (t > T(0))) ? t : kNoHit<T>;
}

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectDisc(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const T t = -ray.oz / ray.dz;
  const T x = ray.ox + t * ray.dx, y = ray.oy + t * ray.dy;
  const T r2 = x * x + y * y;
  return ((r2 <= size.a * size.a) & (r2 >= size.b * size.b) & (t > T(0))) ? t : kNoHit<T>;
}

// For round shapes the discriminant is taken at the point of the ray that is closest to the centre
// or axis. That keeps float accurate when the radius is much smaller than the distance.

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectSphere(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const T inverse = T(1) / (ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz);
  const T closest = -(ray.ox * ray.dx + ray.oy * ray.dy + ray.oz * ray.dz) * inverse;
  const T x = ray.ox + closest * ray.dx, y = ray.oy + closest * ray.dy,
          z = ray.oz + closest * ray.dz;
  const T rest = (size.a * size.a - (x * x + y * y + z * z)) * inverse;
  const T t = closest - std::sqrt(rest);
  return t > T(0) ? t : kNoHit<T>;
}

/// Says where a ray meets an endless cylinder around z: at closest - half_chord and closest +
/// half_chord; NaN if it does not.
template <typename T>
struct Chord {
  T closest, half_chord;
};

template <typename T>
ISOTHERM_ALWAYS_INLINE Chord<T> IntersectEndless(const LocalRay<T>& ray, T radius) {
  const T inverse = T(1) / (ray.dx * ray.dx + ray.dy * ray.dy);
  const T closest = -(ray.ox * ray.dx + ray.oy * ray.dy) * inverse;
  const T x = ray.ox + closest * ray.dx, y = ray.oy + closest * ray.dy;
  const T rest = (radius * radius - (x * x + y * y)) * inverse;
  return {closest, std::sqrt(rest)};
}

/// The end (at +c or -c) that faces the ray's origin.
template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectCap(const LocalRay<T>& ray, const LocalSize<T>& size, T inner) {
  const T t = ((ray.dz > T(0) ? -size.c : size.c) - ray.oz) / ray.dz;
  const T x = ray.ox + t * ray.dx, y = ray.oy + t * ray.dy;
  const T r2 = x * x + y * y;
  return ((r2 <= size.a * size.a) & (r2 >= inner * inner) & (t > T(0))) ? t : kNoHit<T>;
}

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectCylinder(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const Chord<T> chord = IntersectEndless(ray, size.a);
  const T side = chord.closest - chord.half_chord;
  const T side_z = std::abs(ray.oz + side * ray.dz);
  const T t = ((side > T(0)) & (side_z <= size.c)) ? side : kNoHit<T>;
  const T cap = IntersectCap(ray, size, T(0));
  return cap < t ? cap : t;
}

template <typename T>
ISOTHERM_ALWAYS_INLINE T IntersectTube(const LocalRay<T>& ray, const LocalSize<T>& size) {
  const Chord<T> outer = IntersectEndless(ray, size.a);
  const T outside = outer.closest - outer.half_chord;
  const Chord<T> inner = IntersectEndless(ray, size.b);
  const T inside = inner.closest + inner.half_chord;
  const T outside_z = std::abs(ray.oz + outside * ray.dz);
  const T inside_z = std::abs(ray.oz + inside * ray.dz);
  const T t1 = ((outside > T(0)) & (outside_z <= size.c)) ? outside : kNoHit<T>;
  const T t2 = ((inside > T(0)) & (inside_z <= size.c)) ? inside : kNoHit<T>;
  const T cap = IntersectCap(ray, size, size.b);
  const T t = t1 < t2 ? t1 : t2;
  return cap < t ? cap : t;
}

template <Shape shape, typename T>
ISOTHERM_ALWAYS_INLINE T IntersectShape(const LocalRay<T>& ray, const LocalSize<T>& size) {
  if constexpr (shape == Shape::kBox) return IntersectBox(ray, size);
  if constexpr (shape == Shape::kRectangle) return IntersectRectangle(ray, size);
  if constexpr (shape == Shape::kSphere) return IntersectSphere(ray, size);
  if constexpr (shape == Shape::kCylinder) return IntersectCylinder(ray, size);
  if constexpr (shape == Shape::kTube) return IntersectTube(ray, size);
  if constexpr (shape == Shape::kDisc) return IntersectDisc(ray, size);
}

/// Calls `function.template operator()<shape>()` with the shape as a compile-time constant.
template <typename Function>
decltype(auto) VisitShape(Shape shape, const Function& function) {
  switch (shape) {
    case Shape::kBox:
      return function.template operator()<Shape::kBox>();
    case Shape::kRectangle:
      return function.template operator()<Shape::kRectangle>();
    case Shape::kSphere:
      return function.template operator()<Shape::kSphere>();
    case Shape::kCylinder:
      return function.template operator()<Shape::kCylinder>();
    case Shape::kTube:
      return function.template operator()<Shape::kTube>();
    case Shape::kDisc:
      break;
  }
  return function.template operator()<Shape::kDisc>();
}

}  // namespace isotherm
