#include "ground/atlas/pose_graph.h"

#include <gtest/gtest.h>

#include <numbers>

namespace isotherm {
namespace {

constexpr double kPrecise = 1e-7;  // Metres and radians: Gauss-Newton has converged.

RigidTransform Pose(double x, double y, double z, double angle_rad = 0.0) {
  return MakeTransform({x, y, z},
                       Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY())));
}

/// The view is at `T` in both.
MapLink Handover(int a, int b, const RigidTransform& T) { return {a, b, T, T, 0.003, 0.005}; }

void ExpectNear(const RigidTransform& actual, const RigidTransform& expected, double tolerance) {
  EXPECT_LT(TranslationDistance(actual, expected), tolerance);
  EXPECT_LT(RotationAngle(actual, expected), tolerance);
}

TEST(PoseGraphTest, MapsThatAgreeStayWhereTheyAre) {
  const std::vector<MapLink> links = {Handover(0, 1, Pose(0.3, 0, 0, 0.5)),
                                      Handover(1, 2, Pose(0.6, 0, 0.1, 1.0))};
  std::vector<RigidTransform> maps(3, RigidTransform::Identity());
  OptimisePoseGraph(links, maps);
  for (const RigidTransform& map : maps) ExpectNear(map, RigidTransform::Identity(), kPrecise);
}

TEST(PoseGraphTest, AnUnknownPlaceFollowsFromOneLink) {
  const RigidTransform T_world_map = Pose(0.4, -0.2, 1.0, 2.0);
  const RigidTransform T_map_depth = Pose(0.1, 0.2, 0.3, -0.7);
  std::vector<RigidTransform> maps(2, RigidTransform::Identity());
  const std::vector<MapLink> links = {{0, 1, T_world_map * T_map_depth, T_map_depth, 0.001, 0.001}};
  OptimisePoseGraph(links, maps);
  ExpectNear(maps[0], RigidTransform::Identity(), kPrecise);
  ExpectNear(maps[1], T_world_map, kPrecise);
}

/// Pure translation: with equal uncertainties, n hand-overs and one closure share the gap equally.
TEST(PoseGraphTest, AGapIsSharedEqually) {
  const Eigen::Vector3d gap(0.009, 0.0, -0.006);
  std::vector<MapLink> links;
  for (int i = 0; i < 3; ++i) {
    links.push_back(Handover(i, i + 1, RigidTransform::Identity()));
    links.back().sigma_rad = 1e-5;  // Not by turning.
  }
  MapLink closure = Handover(3, 0, RigidTransform::Identity());
  closure.T_a_depth.translation() = gap;  // Map 3 believes to have moved on by the gap.
  closure.sigma_rad = 1e-5;
  links.push_back(closure);
  std::vector<RigidTransform> maps(4, RigidTransform::Identity());
  OptimisePoseGraph(links, maps);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((maps[i].translation() + gap * i / 4.0).norm(), kPrecise) << i;
  }
}

TEST(PoseGraphTest, ACertainClosureTakesAlmostAllOfTheGap) {
  std::vector<MapLink> links;
  std::vector<RigidTransform> maps;
  constexpr int kMaps = 6;
  for (int i = 0; i < kMaps; ++i) {
    maps.push_back(RigidTransform::Identity());
    if (i > 0) {
      const double angle = 2.0 * std::numbers::pi * i / kMaps;
      links.push_back(Handover(
          i - 1, i, Pose(0.8 * std::sin(angle), 0.0, 0.8 - 0.8 * std::cos(angle), -angle)));
    }
  }
  const RigidTransform truth = Pose(0, 0, 0);
  const RigidTransform drifted = Pose(0.012, -0.004, 0.007, 0.01);
  const MapLink closure = {kMaps - 1, 0, drifted, truth, 0.0003, 0.0005};
  links.push_back(closure);
  OptimisePoseGraph(links, maps);
  const RigidTransform left = Mismatch(closure, maps[kMaps - 1], maps[0]);
  constexpr double kFractionLeft = 0.05;
  EXPECT_LT(left.translation().norm(), kFractionLeft * drifted.translation().norm());
  // Each hand-over takes its part: none is torn open by more than twice the mean.
  for (const MapLink& link : std::span(links).first(kMaps - 1)) {
    EXPECT_LT(Mismatch(link, maps[link.a], maps[link.b]).translation().norm(),
              2.0 * drifted.translation().norm() / (kMaps - 1));
  }
}

TEST(PoseGraphTest, MapsWithoutAChainOfLinksStay) {
  const RigidTransform somewhere = Pose(3.0, 0.0, 0.0, 0.2);
  std::vector<RigidTransform> maps = {RigidTransform::Identity(), RigidTransform::Identity(),
                                      somewhere, somewhere};
  const std::vector<MapLink> links = {
      {0, 1, Pose(0.1, 0, 0), RigidTransform::Identity(), 0.001, 0.001},
      {2, 3, Pose(0.1, 0, 0), RigidTransform::Identity(), 0.001, 0.001}};
  OptimisePoseGraph(links, maps);
  ExpectNear(maps[1], Pose(0.1, 0, 0), kPrecise);
  ExpectNear(maps[2], somewhere, 1e-15);
  ExpectNear(maps[3], somewhere, 1e-15);
}

}  // namespace
}  // namespace isotherm
