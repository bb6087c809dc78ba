#include "ground/evaluation/surface_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "common/radiometry/radiometry.h"
#include "ground/evaluation/temperature_evaluation.h"

namespace isotherm {
namespace {

constexpr float kSpacing_m = 0.002F;

// Three faces of a corner, 0.1 m long, sampled every 2 mm; seen once on z = 0, ten times elsewhere.
// The temperature is 30 °C on x = 0, 80 °C on y = 0 and rises by 1 K per millimetre along x on z =
// 0.
TruePoints Corner() {
  TruePoints points;
  constexpr int kSide = 50;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        Eigen::Vector3f p = Eigen::Vector3f::Zero();
        p[(axis + 1) % 3] = (static_cast<float>(i) + 0.5F) * kSpacing_m;
        p[(axis + 2) % 3] = (static_cast<float>(j) + 0.5F) * kSpacing_m;
        points.positions_m.push_back(p);
        points.normals.push_back(Eigen::Vector3f::Unit(axis));
        points.celsius.push_back(axis == 0 ? 30.0F : axis == 1 ? 80.0F : 20.0F + 1000.0F * p.x());
        points.seen.push_back(axis == 2 ? 1 : 10);
        points.primitive.push_back(static_cast<std::uint32_t>(axis));
      }
    }
  }
  return points;
}

// Points on the same faces, at random places at least 5 mm away from the edges, with noise along
// the normal.
std::vector<Eigen::Vector3f> Cloud(int per_face, double noise_m, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0.005F, 0.095F);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Eigen::Vector3f> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < per_face; ++i) {
      Eigen::Vector3f p;
      p[axis] = static_cast<float>(noise_m * noise(random));
      p[(axis + 1) % 3] = place(random);
      p[(axis + 2) % 3] = place(random);
      points.push_back(p);
    }
  }
  return points;
}

TEST(PointIndexTest, AgreesWithExhaustiveSearch) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2000; ++i)
    points.emplace_back(place(random), place(random), 0.1F * place(random));
  points[5].x() = NAN;
  points[7] = points[6];
  const PointIndex index(points);
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3f p = (trial % 2 == 0 ? 1.5F : 0.5F) *
                              Eigen::Vector3f(place(random), place(random), place(random));
    std::size_t nearest = 0, within = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - p).norm() < (points[nearest] - p).norm()) nearest = i;
      if ((points[i] - p).norm() <= 0.2F) ++within;
    }
    EXPECT_EQ(index.Nearest(p, 100.0F)->index, nearest);
    std::size_t found = 0;
    index.ForEachWithin(p, 0.2F, [&](const PointIndex::Neighbour&) { ++found; });
    EXPECT_EQ(found, within);
  }
  EXPECT_EQ(index.Nearest(points[6], 1.0F)->index, 6U);
  EXPECT_FALSE(index.Nearest({50, 0, 0}, 1.0F));
  EXPECT_FALSE(index.Nearest({NAN, 0, 0}, 1.0F));
  EXPECT_FALSE(PointIndex({}).Nearest({0, 0, 0}, 1.0F));
}

TEST(TrueSurfaceTest, DistanceIsToThePlaneBetweenSamplesAndToTheRimBeyond) {
  const TrueSurface truth(Corner());
  EXPECT_NEAR(truth.spacing_m(), kSpacing_m, 1e-5F);
  // On the face between four samples: 1.4 mm from each of them, 0 from the surface.
  EXPECT_NEAR(truth.Project({0.0F, 0.02F, 0.02F})->distance_m, 0.0F, 1e-6F);
  EXPECT_NEAR(truth.Project({0.0015F, 0.02F, 0.02F})->distance_m, 0.0015F, 1e-6F);
  EXPECT_NEAR(truth.Project({-0.003F, 0.02F, 0.02F})->distance_m, 0.003F, 1e-6F);
  // 20 mm beyond the last sample (99 mm) of a face, whose disc ends at 101 mm.
  EXPECT_NEAR(truth.Project({0.0F, 0.119F, 0.051F})->distance_m, 0.018F, 1e-5F);
  EXPECT_FALSE(truth.Project({NAN, 0.0F, 0.0F}));
}

TEST(SurfaceEvaluationTest, NoiseGivesItsOwnSize) {
  constexpr double kSigma_m = 0.0005;
  constexpr double kStatistical = 0.05 * kSigma_m;  // Three standard deviations at 9000 points.
  const SurfaceErrors errors = EvaluateSurface(Cloud(3000, kSigma_m), TrueSurface(Corner()), {});
  EXPECT_NEAR(errors.distance_m.rms, kSigma_m, kStatistical);
  EXPECT_NEAR(errors.distance_m.median, 0.6745 * kSigma_m, kStatistical);
  EXPECT_NEAR(errors.distance_m.p95, 1.96 * kSigma_m, 2 * kStatistical);
  EXPECT_LE(errors.fitted_distance_m.rms, errors.distance_m.rms + 0.1 * kStatistical);
}

TEST(SurfaceEvaluationTest, FitTakesAKnownMotionBack) {
  const RigidTransform motion = MakeTransform(
      {0.002, -0.001, 0.003},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 1, 1).normalized())));
  const SurfaceErrors errors =
      EvaluateSurface(Transformed(motion, Cloud(1000, 0.0)), TrueSurface(Corner()), {});
  EXPECT_GT(errors.distance_m.rms, 0.001);
  EXPECT_NEAR(errors.fitted_distance_m.rms, 0.0, 2e-6);
  EXPECT_NEAR(TranslationDistance(errors.fit, motion.inverse()), 0.0, 1e-5);
  EXPECT_NEAR(RotationAngle(errors.fit, motion.inverse()), 0.0, 1e-4);
}

TEST(SurfaceEvaluationTest, CompletenessCountsOnlySurfaceThatWasSeen) {
  const TrueSurface truth(Corner());
  std::vector<Eigen::Vector3f> cloud;
  for (const Eigen::Vector3f& p : Corner().positions_m) {
    if (p.x() == 0.0F)
      cloud.push_back(p);  // The face x = 0 alone: one of the two faces seen three times.
  }
  const SurfaceErrors errors = EvaluateSurface(cloud, truth, {});
  EXPECT_EQ(errors.surface_points, 5000U);
  // And a strip of two samples (1 and 3 mm) of the other face, which lies within 5 mm; the third is
  // at 5 mm.
  EXPECT_NEAR(errors.completeness, 0.5 * (1.0 + 2.0 / 50.0), 0.011);
  EXPECT_EQ(EvaluateSurface({}, truth, {}).completeness, 0.0);
}

MeasuredCloud MeasuredOn(const std::vector<Eigen::Vector3f>& positions, double emissivity,
                         double offset_kelvin) {
  const BandRadiance band;
  MeasuredCloud cloud;
  cloud.positions_m = positions;
  for (const Eigen::Vector3f& p : positions) {
    const double celsius = p.z() == 0.0F ? 20.0 + 1000.0 * p.x() : p.x() == 0.0F ? 30.0 : 80.0;
    cloud.celsius.push_back(
        static_cast<float>(ApparentCelsius(band, celsius, emissivity, 23.0) + offset_kelvin));
  }
  cloud.distance_class.assign(positions.size(), 1);
  cloud.angle_class.assign(positions.size(), 1);
  return cloud;
}

TEST(TemperatureEvaluationTest, KnownOffsetComesBackInItsClass) {
  const TrueSurface truth(Corner());
  const std::vector<Eigen::Vector3f> positions = Cloud(1000, 0.0);
  MeasuredCloud cloud = MeasuredOn(positions, 0.8, 0.5);
  for (int i = 0; i < 300; ++i) cloud.angle_class[i] = 2;
  for (int i = 300; i < 500; ++i) {
    cloud.distance_class[i] = 0;
    cloud.celsius[i] += 9.5F;
  }
  for (int i = 500; i < 600; ++i) {
    cloud.celsius[i] = NAN;
    cloud.distance_class[i] = cloud.angle_class[i] = 255;
  }
  TemperatureEvaluationOptions options;
  options.emissivity = 0.8;
  const auto report = EvaluateTemperatures(cloud, positions, truth, options);
  ASSERT_TRUE(report) << report.error().message();
  EXPECT_EQ(report->good.all.magnitude.count, 2400U);
  EXPECT_EQ(report->acceptable.all.magnitude.count, 300U);
  EXPECT_EQ(report->bad.all.magnitude.count, 200U);
  EXPECT_EQ(report->never_measured, 100U);
  constexpr double kInterpolation_kelvin = 0.02;
  EXPECT_NEAR(report->good.all.magnitude.median, 0.5, kInterpolation_kelvin);
  EXPECT_NEAR(report->good.all.mean, 0.5, kInterpolation_kelvin);
  EXPECT_NEAR(report->acceptable.all.magnitude.median, 0.5, kInterpolation_kelvin);
  EXPECT_NEAR(report->bad.all.magnitude.median, 10.0, kInterpolation_kelvin);
  EXPECT_EQ(report->good.all.gross_fraction, 0.0);
  EXPECT_EQ(report->bad.all.gross_fraction, 1.0);
  EXPECT_NEAR(report->any.all.gross_fraction, 200.0 / 2900.0, 1e-9);
}

TEST(TemperatureEvaluationTest, WrongEmissivityShowsUpAsABias) {
  const TrueSurface truth(Corner());
  const std::vector<Eigen::Vector3f> positions = Cloud(1000, 0.0);
  const MeasuredCloud cloud = MeasuredOn(positions, 0.8, 0.0);
  EXPECT_LT(EvaluateTemperatures(cloud, positions, truth, {})->good.all.mean, -2.0);
}

TEST(TemperatureEvaluationTest, PointsNearTemperatureEdgesAreReportedApart) {
  const TrueSurface truth(Corner());
  // On the face x = 0 (30 °C), at 1 mm and at 50 mm from the face y = 0 (80 °C).
  const std::vector<Eigen::Vector3f> positions{{0.0F, 0.001F, 0.05F}, {0.0F, 0.05F, 0.05F}};
  MeasuredCloud cloud = MeasuredOn(positions, 1.0, 0.0);
  cloud.celsius[0] += 20.0F;
  const auto report = EvaluateTemperatures(cloud, positions, truth, {});
  EXPECT_EQ(report->good.all.magnitude.count, 2U);
  EXPECT_EQ(report->good.away_from_edges.magnitude.count, 1U);
  EXPECT_NEAR(report->good.away_from_edges.magnitude.max, 0.0, 0.01);
}

TEST(TemperatureEvaluationTest, RefusesWhatCannotBeCompared) {
  const TrueSurface truth(Corner());
  const std::vector<Eigen::Vector3f> positions = Cloud(10, 0.0);
  MeasuredCloud cloud = MeasuredOn(positions, 1.0, 0.0);
  TemperatureEvaluationOptions options;
  options.emissivity = 0.0;
  EXPECT_FALSE(EvaluateTemperatures(cloud, positions, truth, options));
  options.emissivity = 1.0;
  options.ambient_celsius = NAN;
  EXPECT_FALSE(EvaluateTemperatures(cloud, positions, truth, options));
  cloud.celsius.clear();
  EXPECT_EQ(EvaluateTemperatures(cloud, positions, truth, {}).error().code(),
            StatusCode::kFailedPrecondition);
}

TEST(SurfaceEvaluationTest, ReferenceSurfaceAgreesWithItself) {
  const char* set = std::getenv("ISOTHERM_DATA_DIR");
  const std::filesystem::path data = set != nullptr ? set : ISOTHERM_SOURCE_DIR "/../shared/data";
  const std::filesystem::path path = data / "furnace_dev" / "surface.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no test data; set ISOTHERM_DATA_DIR";
  Result<TruePoints> points = ReadTruePoints(path);
  ASSERT_TRUE(points) << points.error().message();
  const TrueSurface truth(*points);
  EXPECT_NEAR(truth.spacing_m(), 0.0019F, 0.0002F);
  const SurfaceErrors errors = EvaluateSurface(points->positions_m, truth, {});
  EXPECT_EQ(errors.distance_m.max, 0.0);
  EXPECT_EQ(errors.completeness, 1.0);
  EXPECT_NEAR(RotationAngle(errors.fit, RigidTransform::Identity()), 0.0, 1e-9);
  MeasuredCloud cloud;
  const BandRadiance band;
  for (const float celsius : points->celsius) {
    cloud.celsius.push_back(static_cast<float>(ApparentCelsius(band, celsius, 0.96, 23.0)));
  }
  cloud.distance_class.assign(cloud.celsius.size(), 1);
  cloud.angle_class = cloud.distance_class;
  TemperatureEvaluationOptions options;
  options.emissivity = 0.96;
  const auto report = EvaluateTemperatures(cloud, points->positions_m, truth, options);
  ASSERT_TRUE(report) << report.error().message();
  // Smoothing the truth between its samples costs so much.
  EXPECT_LT(report->good.all.magnitude.median, 0.05);
  EXPECT_LT(report->good.all.magnitude.p95, 0.5);
}

}  // namespace
}  // namespace isotherm
