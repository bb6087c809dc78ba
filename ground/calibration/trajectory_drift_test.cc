#include "ground/calibration/trajectory_drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/calibration/image_motion.h"

namespace isotherm {
namespace {

/// A scan of three seconds of one point.
ScanViews ThreeSeconds() {
  ScanViews views;
  views.points.push_back({{0.1, 0.2, 0.7}, -Eigen::Vector3d::UnitZ()});
  for (int i = 0; i <= 3; ++i)
    views.frames.push_back({CaptureTime(std::chrono::seconds(i)), {}, {}, {}});
  return views;
}

TEST(TrajectoryDriftTest, KnotsAreSpreadOverTheScanAndLinearBetween) {
  TrajectoryDrift drift(ThreeSeconds(), 1.0, 24);
  ASSERT_EQ(drift.size(), 4 * TrajectoryDrift::kPerKnot);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(drift.size());
  values[TrajectoryDrift::kPerKnot] = 0.004;  // Along x at one second.
  drift.Add(values);
  const auto shift_at = [&](double time_s) {
    return drift.MotionAt(drift.At(CaptureTime(FromSeconds(time_s)))).translation().x();
  };
  EXPECT_NEAR(shift_at(0.0), 0.0, 1e-12);
  EXPECT_NEAR(shift_at(0.25), 0.001, 1e-9);
  EXPECT_NEAR(shift_at(1.0), 0.004, 1e-9);
  EXPECT_NEAR(shift_at(1.5), 0.002, 1e-9);
  EXPECT_NEAR(shift_at(9.0), 0.0, 1e-12);  // Beyond the end, the last knot's.
  EXPECT_EQ(TrajectoryDrift(ThreeSeconds(), 0.001, 3).size(), 3 * TrajectoryDrift::kPerKnot);
}

TEST(TrajectoryDriftTest, DerivativesAreThoseOfDifferences) {
  const Eigen::Vector3d p_world(0.4, -0.1, 0.9);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < TrajectoryDrift::kPerKnot; ++i) {
    TrajectoryDrift drift(ThreeSeconds(), 1.0, 24);
    const Eigen::Vector3d slope = drift.ByKnot(p_world).col(i);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(drift.size());
    values[i] = kStep;
    drift.Add(values);
    const Eigen::Vector3d moved = drift.MotionAt(drift.At(CaptureTime())) * p_world;
    EXPECT_TRUE(slope.isApprox((moved - p_world) / kStep, 1e-5)) << "value " << i;
  }
}

TEST(TrajectoryDriftTest, KnotsAreOffAlikeByAsMuchAsPosesRemember) {
  const TrajectoryDrift drift(ThreeSeconds(), 1.0, 24);
  const Eigen::MatrixXd factor = drift.PriorFactor(0.2, 0.03);
  const Eigen::MatrixXd covariance = factor * factor.transpose();
  constexpr int kTurn = 4;  // About y.
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const double alike = std::exp(-std::abs(a - b) / kDriftMemory_s);
      const int row = TrajectoryDrift::kPerKnot * a, column = TrajectoryDrift::kPerKnot * b;
      EXPECT_NEAR(covariance(row, column), 0.04 * alike, 1e-12);
      EXPECT_NEAR(covariance(row + kTurn, column + kTurn), 0.0009 * alike, 1e-12);
      EXPECT_NEAR(covariance(row, column + 1), 0.0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace isotherm
