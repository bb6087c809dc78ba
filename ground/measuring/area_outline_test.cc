#include "ground/measuring/area_outline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/measuring/testing/plate.h"

namespace isotherm {
namespace {

using testing::kPlate_m;
using testing::PlateModel;

double SumOf(const std::vector<AreaPiece>& pieces) {
  double sum = 0.0;
  for (const AreaPiece& piece : pieces) sum += piece.area_m2;
  return sum;
}

/// Meshes of planes are planes; what is left is quantisation.
constexpr double kRelative = 1e-3;

TEST(AreaOutlineTest, ARectangleOnAWallHasItsArea) {
  PlateModel model;
  model.AddPlane({0, 0, kPlate_m}, -Eigen::Vector3d::UnitZ());
  SurfaceProbe probe(model.tsdf, model.thermal, {});
  const std::vector<Eigen::Vector3d> corners = {{0.031, 0.042, kPlate_m},
                                                {0.153, 0.042, kPlate_m},
                                                {0.153, 0.131, kPlate_m},
                                                {0.031, 0.131, kPlate_m}};
  const double area = SumOf(AreaOutline(corners, Eigen::Vector3d::UnitZ()).Pieces(probe));
  EXPECT_NEAR(area / (0.122 * 0.089), 1.0, kRelative);
}

TEST(AreaOutlineTest, ATiltedWallHasMoreAreaThanItsOutline) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, 0.0, -std::sqrt(0.75));
  PlateModel model;
  model.AddPlane({0.096, 0.0, 0.096}, normal);  // At 30 degrees.
  SurfaceProbe probe(model.tsdf, model.thermal, {});
  const auto on_plane = [&](double x, double y) {
    return Eigen::Vector3d(x, y, 0.096 + 0.5 / std::sqrt(0.75) * (x - 0.096));
  };
  const std::vector<Eigen::Vector3d> corners = {on_plane(0.06, 0.05), on_plane(0.13, 0.05),
                                                on_plane(0.13, 0.14), on_plane(0.06, 0.14)};
  const double area = SumOf(AreaOutline(corners, Eigen::Vector3d::UnitZ()).Pieces(probe));
  EXPECT_NEAR(area / (0.07 * 0.09 / std::cos(M_PI / 6.0)), 1.0, kRelative);
}

TEST(AreaOutlineTest, WhatLiesBehindIsNotCounted) {
  PlateModel model;
  model.AddPlane({0, 0, 0.16}, -Eigen::Vector3d::UnitZ());
  // A box in front of the wall, further away than what may belong to what one sees.
  testing::FillVolume(model.tsdf, [](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q =
        (p - Eigen::Vector3d(0.096, 0.096, 0.1)).cwiseAbs() - Eigen::Vector3d(0.06, 0.06, 0.02);
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  });
  SurfaceProbe probe(model.tsdf, model.thermal, {});
  const std::vector<Eigen::Vector3d> corners = {
      {0.06, 0.06, 0.08}, {0.13, 0.06, 0.08}, {0.13, 0.13, 0.08}, {0.06, 0.13, 0.08}};
  const double area = SumOf(AreaOutline(corners, Eigen::Vector3d::UnitZ()).Pieces(probe));
  EXPECT_NEAR(area / (0.07 * 0.07), 1.0, kRelative);
}

TEST(AreaOutlineTest, SurfaceTurnedAwayIsNotCounted) {
  PlateModel model;
  model.AddPlane({0, 0, kPlate_m}, -Eigen::Vector3d::UnitZ());
  SurfaceProbe probe(model.tsdf, model.thermal, {});
  const std::vector<Eigen::Vector3d> corners = {
      {0.03, 0.04, kPlate_m}, {0.15, 0.04, kPlate_m}, {0.1, 0.13, kPlate_m}};
  EXPECT_TRUE(AreaOutline(corners, -Eigen::Vector3d::UnitZ()).Pieces(probe).empty());
}

TEST(AreaOutlineTest, ConcaveOutlinesLeaveTheirBayOut) {
  PlateModel model;
  model.AddPlane({0, 0, kPlate_m}, -Eigen::Vector3d::UnitZ());
  SurfaceProbe probe(model.tsdf, model.thermal, {});
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [x, y] :
       {std::pair(0.04, 0.04), {0.14, 0.04}, {0.14, 0.14}, {0.09, 0.06}, {0.04, 0.14}})
    corners.emplace_back(x, y, kPlate_m);
  // A square of 0.1 m without the triangle over its side of 0.1 m, 0.08 m deep.
  const double area = SumOf(AreaOutline(corners, Eigen::Vector3d::UnitZ()).Pieces(probe));
  EXPECT_NEAR(area / (0.01 - 0.004), 1.0, kRelative);
}

}  // namespace
}  // namespace isotherm
