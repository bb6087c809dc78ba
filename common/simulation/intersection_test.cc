#include "common/simulation/intersection.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "common/simulation/testing/shapes.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

constexpr unsigned kSeed = 11;
constexpr double kMarch_m = 1e-7;     // Where the reference calls it a hit.
constexpr double kExact_m = 2e-5;     // The reference's own error at grazing angles.
constexpr double kFloat_m = 2e-5;     // Closed form in float at 1 m.
constexpr double kGrazingCos = 0.05;  // Rays that graze hit or miss by rounding.

template <typename T>
T Intersect(const Primitive& primitive, const Vector3d& o, const Vector3d& d) {
  const Eigen::Matrix<T, 3, 1> of = o.cast<T>(), df = d.cast<T>(), s = primitive.size.cast<T>();
  const LocalRay<T> ray{of.x(), of.y(), of.z(), df.x(), df.y(), df.z()};
  const LocalSize<T> size{s.x(), s.y(), s.z()};
  return VisitShape(primitive.shape,
                    [&]<Shape shape>() { return IntersectShape<shape, T>(ray, size); });
}

/// Sphere tracing along a unit direction; infinity = no hit within 3 m.
double March(const Primitive& primitive, const Vector3d& o, const Vector3d& d) {
  constexpr double kFar_m = 3.0;
  double t = 0.0;
  while (t < kFar_m) {
    const double distance = SignedDistance(primitive, o + t * d);
    if (distance < kMarch_m) return t;
    t += distance;
  }
  return kNoHit<double>;
}

class IntersectionTest : public ::testing::Test {
 protected:
  IntersectionTest() : random_(kSeed) { std::cout << "seed " << kSeed << '\n'; }

  /// From a sphere of 0.7 m around the shape towards somewhere near it.
  void MakeRay() {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> near(-0.25, 0.25);
    origin_ = 0.7 * Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
    direction_ = (Vector3d(near(random_), near(random_), near(random_)) - origin_).normalized();
  }

  std::mt19937 random_;
  Vector3d origin_, direction_;
};

TEST_F(IntersectionTest, AgreesWithRayMarchingOnAllShapes) {
  for (const Primitive& primitive : OneOfEach()) {
    int hits = 0, misses = 0, different = 0;
    for (int i = 0; i < 3000; ++i) {
      MakeRay();
      const double expected = March(primitive, origin_, direction_);
      const double exact = Intersect<double>(primitive, origin_, direction_);
      const auto single = static_cast<double>(Intersect<float>(primitive, origin_, direction_));
      if (std::isinf(expected) != std::isinf(exact)) {
        ++different;  // Only just hits or misses.
        continue;
      }
      if (std::isinf(exact)) {
        ++misses;
        continue;
      }
      ++hits;
      const Vector3d normal = NormalAt(primitive, origin_ + exact * direction_);
      const double cosine = std::abs(normal.dot(direction_));
      if (cosine < kGrazingCos) continue;
      EXPECT_NEAR(exact, expected, kExact_m) << static_cast<int>(primitive.shape);
      if (!std::isinf(single)) {
        EXPECT_NEAR(single, exact, kFloat_m / cosine);
      }
    }
    EXPECT_LE(different, 2) << static_cast<int>(primitive.shape);
    EXPECT_GT(hits, 200) << static_cast<int>(primitive.shape);
    EXPECT_GT(misses, 200) << static_cast<int>(primitive.shape);
  }
}

TEST_F(IntersectionTest, NormalIsTheGradientOfTheDistance) {
  constexpr double kStep = 1e-8;
  constexpr double kBefore_m = 1e-5;  // In front of the surface flat shapes have a gradient too.
  for (const Primitive& primitive : OneOfEach()) {
    int hits = 0, different = 0;
    for (int i = 0; i < 2000; ++i) {
      MakeRay();
      const double t = Intersect<double>(primitive, origin_, direction_);
      if (std::isinf(t)) continue;
      const Vector3d p = origin_ + (t - kBefore_m) * direction_;
      Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep * Vector3d::Unit(axis);
        gradient[axis] =
            (SignedDistance(primitive, p + step) - SignedDistance(primitive, p - step)) /
            (2.0 * kStep);
      }
      Vector3d normal = NormalAt(primitive, origin_ + t * direction_);
      if (normal.dot(direction_) > 0.0) normal = -normal;  // Flat shapes seen from behind.
      ++hits;
      different += normal.dot(gradient) < 0.999;
    }
    // Within kBefore_m of an edge the gradient points somewhere in between.
    EXPECT_LE(different, 0.005 * hits) << static_cast<int>(primitive.shape);
  }
}

TEST_F(IntersectionTest, NothingBehindTheOriginIsHit) {
  for (const Primitive& primitive : OneOfEach()) {
    EXPECT_TRUE(std::isinf(Intersect<double>(primitive, {0.01, 0.1, 1.0}, {0.0, 0.001, 1.0})));
    EXPECT_TRUE(std::isinf(Intersect<float>(primitive, {0.01, 0.1, 1.0}, {0.0, 0.001, 1.0})));
  }
}

TEST_F(IntersectionTest, DirectionsNeedNoUnitLength) {
  for (const Primitive& primitive : OneOfEach()) {
    for (int i = 0; i < 100; ++i) {
      MakeRay();
      const double unit = Intersect<double>(primitive, origin_, direction_);
      const double twice = Intersect<double>(primitive, origin_, 2.0 * direction_);
      if (std::isinf(unit)) {
        EXPECT_TRUE(std::isinf(twice));
      } else {
        EXPECT_NEAR(twice, unit / 2.0, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace isotherm
