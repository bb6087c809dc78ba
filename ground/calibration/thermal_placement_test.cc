#include "ground/calibration/thermal_placement.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

const CameraModel kLens{.width = 382,
                        .height = 288,
                        .fx = 371.4,
                        .fy = 372.1,
                        .cx = 205.5,
                        .cy = 150.5,
                        .k1 = -0.439,
                        .k2 = 0.29,
                        .p1 = 0.01,
                        .p2 = -0.02,
                        .k3 = -0.114};

ThermalPlacement SomePlacement() {
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.05, 0.03, -0.01, 0.02, -0.4, 0.3;
  return {kLens, TransformFromTwist(twist), 0.01, {.near_fraction = 0.04}};
}

TEST(ThermalPlacementTest, CorrectionLeadsFromOneToTheOther) {
  PlacementVector correction;
  correction << 0.1, -0.2, 0.05, 0.01, -0.02, 0.03, -0.004, 3.0, -2.0, -0.01, 0.02;
  const ThermalPlacement from = SomePlacement();
  const ThermalPlacement to = Corrected(from, correction);
  EXPECT_TRUE(CorrectionBetween(from, to).isApprox(correction, 1e-9));
  EXPECT_TRUE(IsRigid(to.T_thermal_depth));
  EXPECT_NEAR(RotationAngle(from.T_thermal_depth, to.T_thermal_depth), correction.head<3>().norm(),
              1e-9);
  EXPECT_TRUE(CorrectionBetween(from, from).isZero(1e-9));
}

TEST(ThermalPlacementTest, DerivativesOfTheProjectionAreThoseOfDifferences) {
  constexpr double kStep_m = 1e-6;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.0, 0.0, 0.5), Eigen::Vector3d(0.2, -0.1, 0.6),
                                   Eigen::Vector3d(-0.3, 0.25, 0.9)}) {
    const ProjectionDerivatives projection = ProjectWithDerivatives(kLens, p);
    EXPECT_TRUE(projection.pixel.isApprox(*Project(kLens, p), 1e-12));
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector2d slope =
          (*Project(kLens, p + step) - *Project(kLens, p - step)) / (2.0 * kStep_m);
      EXPECT_TRUE(projection.by_point.col(axis).isApprox(slope, 1e-6)) << "axis " << axis;
    }
  }
}

}  // namespace
}  // namespace isotherm
