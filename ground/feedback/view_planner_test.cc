#include "ground/feedback/view_planner.h"

#include <gtest/gtest.h>

#include <numbers>

#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

using enum ConditionClass;
using Eigen::Vector3d;

const auto kNothingSpilled = [](std::int32_t) { return false; };

/// A rig before analytic surfaces of which a known part was never measured.
class ViewPlannerTest : public ::testing::Test {
 protected:
  ViewPlannerTest() {
    CameraModel camera;
    camera.width = 320;
    camera.height = 240;
    camera.fx = camera.fy = 285.0;
    camera.cx = 159.5;
    camera.cy = 119.5;
    rig_.depth = camera;
    rig_.thermal = camera;
    rig_.T_thermal_depth = MakeTransform({-0.05, 0, 0}, Eigen::Quaterniond::Identity());
    options_.mutable_expert()->set_views_per_message(4);
  }

  static VoxelGrid Grid() {
    return {.min_m = Vector3d::Zero(), .voxel_size_m = 0.008, .blocks = {16, 16, 16}};
  }
  const Vector3d centre_{0.51, 0.51, 0.51};
  bool is_measuring_ = true;
  /// In front of the scene, looking along z.
  RigidTransform here_ = MakeTransform({0.5, 0.5, -0.1}, Eigen::Quaterniond::Identity());

  /// All is measured well but where `is_missing`.
  template <typename IsMissing>
  void Measure(const IsMissing& is_missing) {
    testing::FillThermal(tsdf_, thermal_, [&](const Vector3d& p) {
      return is_missing(p) ? ThermalVoxel() : ThermalVoxel::Make(20.0F, kGood, kGood);
    });
    coverage_.Update(tsdf_, thermal_, kNothingSpilled, tsdf_.block_count() + 1, pool_);
  }
  /// The best view after this many steps with the rig held `here_`.
  std::optional<NextView> Plan(ViewPlanner& planner, int steps = 60) {
    for (int i = 0; i < steps; ++i)
      planner.Step(tsdf_, thermal_, coverage_, here_, is_measuring_, pool_);
    return planner.best();
  }
  ViewPlanner Planner() { return {options_, limits_, rig_, 1.0F}; }
  RigidTransform Thermal(const NextView& view) const {
    return view.T_map_depth * rig_.T_thermal_depth->inverse();
  }
  static double AngleDeg(const Vector3d& a, const Vector3d& b) {
    return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180.0 /
           std::numbers::pi;
  }

  FeedbackOptions options_;
  ThermalOptions limits_;
  Rig rig_;
  ThreadPool pool_{2};
  TsdfVolume tsdf_{Grid(), 0.032, 4096};
  ThermalVolume thermal_{4096};
  ModelCoverage coverage_{1.0F};
};

TEST_F(ViewPlannerTest, TheBestViewLooksAtTheSideThatIsMissing) {
  testing::FillSphere(tsdf_, centre_, 0.2);
  for (const Vector3d& side :
       {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    // A cap of 35 degrees around `side`: a third of a metre wide.
    Measure([&](const Vector3d& p) { return AngleDeg(p - centre_, side) < 35.0; });
    // The rig is held on that side: elsewhere a nearer view may be worth more.
    const Vector3d x = side.unitOrthogonal();
    here_.linear() << x, x.cross(side), -side;
    here_.translation() = centre_ + 0.8 * side;
    ViewPlanner planner = Planner();
    const std::optional<NextView> view = Plan(planner);
    ASSERT_TRUE(view.has_value()) << side.transpose();
    const RigidTransform T_map_thermal = Thermal(*view);
    // From the missing side, towards it, at a good distance.
    EXPECT_LT(AngleDeg(T_map_thermal.translation() - centre_, side), 30.0) << side.transpose();
    EXPECT_LT(AngleDeg(-T_map_thermal.linear().col(2), side), 30.0) << side.transpose();
    const double distance_m = (T_map_thermal.translation() - (centre_ + 0.2 * side)).norm();
    EXPECT_GT(distance_m, limits_.distance().min_m());
    EXPECT_LT(distance_m, limits_.distance().good_m());
  }
}

TEST_F(ViewPlannerTest, TheGainIsTheAreaThatWouldBecomeGood) {
  // A wall that faces -z, of which a square of 0.2 m was never measured.
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  const auto in_square = [](const Vector3d& p) {
    return std::abs(p.x() - 0.5) < 0.1 && std::abs(p.y() - 0.5) < 0.1;
  };
  Measure(in_square);
  ViewPlanner planner = Planner();
  const auto from = [&](double z) {
    return MakeTransform({0.5, 0.5, z}, Eigen::Quaterniond::Identity()) * *rig_.T_thermal_depth;
  };
  // The edge of the square falls between coarse rays, and a voxel counts for its neighbours.
  constexpr double kTolerance_m2 = 0.15 * 0.04;
  EXPECT_NEAR(planner.Gain(from(0.25), tsdf_, thermal_, pool_), 0.04, kTolerance_m2);
  EXPECT_EQ(planner.Gain(from(0.0), tsdf_, thermal_, pool_), 0.0) << "0.70 m is not good";
  EXPECT_EQ(planner.Gain(from(0.45), tsdf_, thermal_, pool_), 0.0) << "0.25 m is too close";
  EXPECT_EQ(planner.Gain(from(0.72), tsdf_, thermal_, pool_), 0.0) << "inside the wall";
  Measure([](const Vector3d&) { return false; });
  EXPECT_EQ(planner.Gain(from(0.25), tsdf_, thermal_, pool_), 0.0) << "nothing is missing";
}

TEST_F(ViewPlannerTest, WhatHidesTheSurfaceIsLookedAround) {
  // A post stands before the missing square: from straight ahead it hides all of it.
  const auto scene = [](const Vector3d& p) {
    const double wall = 0.80 - p.z();
    const Vector3d d = (p - Vector3d(0.5, 0.5, 0.68)).cwiseAbs() - Vector3d(0.035, 0.3, 0.02);
    const double post = d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
    return std::min(wall, post);
  };
  testing::FillVolume(tsdf_, scene);
  const auto missing = [](const Vector3d& p) {
    return p.z() > 0.75 && std::abs(p.x() - 0.5) < 0.04 && std::abs(p.y() - 0.5) < 0.04;
  };
  Measure(missing);
  ViewPlanner planner = Planner();
  const RigidTransform straight =
      MakeTransform({0.5, 0.5, 0.35}, Eigen::Quaterniond::Identity()) * *rig_.T_thermal_depth;
  EXPECT_EQ(planner.Gain(straight, tsdf_, thermal_, pool_), 0.0);
  const std::optional<NextView> view = Plan(planner, 120);
  ASSERT_TRUE(view.has_value());
  EXPECT_GT(view->gain_m2, 0.3 * 0.08 * 0.08);
  EXPECT_GT(std::abs(Thermal(*view).translation().x() - 0.5), 0.09) << "beside the post";
}

TEST_F(ViewPlannerTest, AViewInWhichTheDepthCameraSeesTooLittleGainsNothing) {
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure([](const Vector3d&) { return true; });
  const auto gain = [this] {
    ViewPlanner planner = Planner();
    return planner.Gain(MakeTransform({0.5, 0.5, 0.30}, Eigen::Quaterniond::Identity()), tsdf_,
                        thermal_, pool_);
  };
  EXPECT_GT(gain(), 0.05) << "0.40 m away";
  rig_.depth_sensor.near_range_m = 0.45;
  EXPECT_EQ(gain(), 0.0) << "the rig would be lost";
}

TEST_F(ViewPlannerTest, AViewThatNobodyTakesMakesWay) {
  testing::FillSphere(tsdf_, centre_, 0.2);
  Measure([&](const Vector3d& p) { return AngleDeg(p - centre_, {-1, 0, 0}) < 20.0; });
  ViewPlanner planner = Planner();
  const std::optional<NextView> first = Plan(planner);
  ASSERT_TRUE(first.has_value());
  is_measuring_ = false;  // Tracking is lost, or the shutter is closed: nobody can go there.
  const std::optional<NextView> meanwhile = Plan(planner, 200);
  ASSERT_TRUE(meanwhile.has_value());
  EXPECT_LT(TranslationDistance(first->T_map_depth, meanwhile->T_map_depth), 0.05);
  is_measuring_ = true;
  const std::optional<NextView> later = Plan(planner, 200);  // The rig stays where it is.
  EXPECT_TRUE(!later || TranslationDistance(first->T_map_depth, later->T_map_depth) > 0.05);
}

TEST_F(ViewPlannerTest, AViewThatWasTakenInVainIsNotProposedAgain) {
  testing::FillSphere(tsdf_, centre_, 0.2);
  Measure([&](const Vector3d& p) { return AngleDeg(p - centre_, {-1, 0, 0}) < 20.0; });
  ViewPlanner planner = Planner();
  const std::optional<NextView> first = Plan(planner);
  ASSERT_TRUE(first.has_value());
  for (int i = 0; i < 25; ++i) {  // The rig is there, and nothing gets better.
    planner.Step(tsdf_, thermal_, coverage_, first->T_map_depth, true, pool_);
  }
  const std::optional<NextView> second = planner.best();
  if (!second) return;
  const bool same =
      (second->T_map_depth.translation() - first->T_map_depth.translation()).norm() < 0.05;
  EXPECT_FALSE(same);
}

TEST_F(ViewPlannerTest, WhereTheOperatorWouldBeReflectedViewsAreAskew) {
  limits_.mutable_angle()->set_min_deg(15);
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure([](const Vector3d& p) { return (p - Vector3d(0.5, 0.5, 0.7)).norm() < 0.05; });
  ViewPlanner planner = Planner();
  const std::optional<NextView> view = Plan(planner);
  ASSERT_TRUE(view.has_value());
  const double angle = AngleDeg(-Thermal(*view).linear().col(2), {0, 0, -1});
  EXPECT_GT(angle, 15.0);
  EXPECT_LT(angle, 40.0);
}

TEST_F(ViewPlannerTest, WhatNoViewCanMeasureIsOutOfReach) {
  // A square on a wall, and a lid close before it that hides it from all sides.
  const auto wall = [](const Vector3d& p) { return 0.80 - p.z(); };
  const auto lid = [](const Vector3d& p) {
    const Vector3d d = (p - Vector3d(0.5, 0.5, 0.72)).cwiseAbs() - Vector3d(0.25, 0.25, 0.02);
    return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
  };
  testing::FillVolume(tsdf_, [&](const Vector3d& p) { return std::min(wall(p), lid(p)); });
  const auto missing = [](const Vector3d& p) {
    return p.z() > 0.77 && std::abs(p.x() - 0.5) < 0.06 && std::abs(p.y() - 0.5) < 0.06;
  };
  Measure(missing);
  ViewPlanner planner = Planner();
  EXPECT_EQ(planner.OutOfReach(coverage_), 0.0) << "nothing was tried yet";
  EXPECT_FALSE(Plan(planner, 200).has_value());
  constexpr double kSquare_m2 = 0.12 * 0.12;
  EXPECT_NEAR(planner.OutOfReach(coverage_), kSquare_m2, 0.25 * kSquare_m2);
}

TEST_F(ViewPlannerTest, WhatCanBeSeenIsNeverOutOfReachHoweverLongItIsNotMeasured) {
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure([](const Vector3d& p) { return (p - Vector3d(0.5, 0.5, 0.7)).norm() < 0.1; });
  ViewPlanner planner = Planner();
  is_measuring_ = false;
  EXPECT_TRUE(Plan(planner, 200).has_value());
  EXPECT_EQ(planner.OutOfReach(coverage_), 0.0);
}

TEST_F(ViewPlannerTest, AModelThatIsMeasuredWellNeedsNoView) {
  testing::FillSphere(tsdf_, centre_, 0.2);
  Measure([](const Vector3d&) { return false; });
  ViewPlanner planner = Planner();
  EXPECT_FALSE(Plan(planner).has_value());
}

/// A wall that faces -z with two bare squares that were never measured, at x = 0.2 and x = 0.8.
constexpr double kLeft_m = 0.2, kRight_m = 0.8;
bool IsInSquareAt(double x_m, const Vector3d& p) {
  return std::abs(p.x() - x_m) < 0.07 && std::abs(p.y() - 0.5) < 0.07;
}

TEST_F(ViewPlannerTest, OfTwoViewsThatGainTheSameTheNearerOneIsTakenFirst) {
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure([](const Vector3d& p) { return IsInSquareAt(kLeft_m, p) || IsInSquareAt(kRight_m, p); });
  is_measuring_ = false;  // No surface counts as looked at without gain.
  for (const double x : {kLeft_m, kRight_m}) {
    here_ = MakeTransform({x, 0.5, 0.25}, Eigen::Quaterniond::Identity());
    ViewPlanner planner = Planner();
    const std::optional<NextView> view = Plan(planner);
    ASSERT_TRUE(view.has_value()) << x;
    EXPECT_NEAR(Thermal(*view).translation().x(), x, 0.15);
  }
}

TEST_F(ViewPlannerTest, WhereTheRigWouldSlideViewsComeLast) {
  is_measuring_ = false;  // No surface counts as looked at without gain.
  here_ = MakeTransform({0.5, 0.5, 0.25}, Eigen::Quaterniond::Identity());
  // Around one of two squares that are equally far stand blocks that hold the rig.
  for (const double x : {kLeft_m, kRight_m}) {
    const auto block = [&](const Vector3d& p, double dx, double dy) {
      const Vector3d d =
          (p - Vector3d(x + dx, 0.5 + dy, 0.66)).cwiseAbs() - Vector3d::Constant(0.05);
      return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
    };
    testing::FillVolume(tsdf_, [&](const Vector3d& p) {
      return std::min({0.7 - p.z(), block(p, 0.14, 0.0), block(p, -0.14, 0.0), block(p, 0.0, 0.14),
                       block(p, 0.0, -0.14)});
    });
    Measure([](const Vector3d& p) {
      return p.z() > 0.69 && (IsInSquareAt(kLeft_m, p) || IsInSquareAt(kRight_m, p));
    });
    ViewPlanner planner = Planner();
    const std::optional<NextView> view = Plan(planner, 120);
    ASSERT_TRUE(view.has_value()) << x;
    EXPECT_NEAR(Thermal(*view).translation().x(), x, 0.25);
    EXPECT_GT(view->firmness, 0.3);
  }
}

TEST_F(ViewPlannerTest, WhatWasLookedAtInVainIsOutOfReach) {
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure([](const Vector3d& p) { return IsInSquareAt(0.5, p); });
  // The rig is held before the square, which is never measured well, whatever hinders it.
  here_ = MakeTransform({0.5, 0.5, 0.25}, Eigen::Quaterniond::Identity());
  ViewPlanner planner = Planner();
  ASSERT_TRUE(Plan(planner, 3).has_value());
  EXPECT_EQ(planner.OutOfReach(coverage_), 0.0) << "it may take a moment";
  for (int i = 0; i < 12; ++i) {  // It sways a little.
    here_.translation().x() += 0.002;
    here_.translation().y() -= 0.001;
    Plan(planner, 1);
  }
  const std::optional<NextView> view = Plan(planner, 1);
  constexpr double kSquare_m2 = 0.14 * 0.14;
  // What is left is at its border, where points of both kinds are near each other.
  constexpr double kBorder = 0.3;
  EXPECT_LT(view ? view->gain_m2 : 0.0, kBorder * kSquare_m2);
  EXPECT_NEAR(planner.OutOfReach(coverage_), kSquare_m2, kBorder * kSquare_m2);
}

/// A strip that was never measured.
bool IsInStrip(const Vector3d& p) {
  return p.x() > 0.4 && p.x() < 0.5 && std::abs(p.y() - 0.5) < 0.1;
}

TEST_F(ViewPlannerTest, WhereTheKnownSurfaceEndsThereMayBeMore) {
  here_ = MakeTransform({0.3, 0.5, 0.25}, Eigen::Quaterniond::Identity());
  testing::FillVolume(tsdf_, [](const Vector3d& p) { return p.x() < 0.5 ? 0.7 - p.z() : 0.3; });
  Measure(IsInStrip);
  ViewPlanner planner = Planner();
  ASSERT_TRUE(Plan(planner, 3).has_value());
  EXPECT_GT(planner.Unseen(), 0.01);

  ViewPlanner informed = Planner();  // From another sub-map the rig has looked there, too.
  for (const double x : {0.5, 0.7, 0.9}) {
    for (const double y : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      informed.NoteSeen(MakeTransform({x, y, 0.1}, Eigen::Quaterniond::Identity()), tsdf_.grid());
    }
  }
  ASSERT_TRUE(Plan(informed, 3).has_value());
  EXPECT_EQ(informed.Unseen(), 0.0);
}

TEST_F(ViewPlannerTest, WhereAllIsKnownThereIsNoMore) {
  here_ = MakeTransform({0.3, 0.5, 0.25}, Eigen::Quaterniond::Identity());
  testing::FillPlane(tsdf_, {0, 0, 0.7}, {0, 0, -1});
  Measure(IsInStrip);
  ViewPlanner planner = Planner();
  ASSERT_TRUE(Plan(planner, 3).has_value());
  EXPECT_EQ(planner.Unseen(), 0.0) << "the wall goes on to the volume's end";
}

TEST_F(ViewPlannerTest, AViewThatTheRigWasLostOnTheWayToIsNotProposedAgain) {
  testing::FillSphere(tsdf_, centre_, 0.2);
  Measure([&](const Vector3d& p) { return AngleDeg(p - centre_, {-1, 0, 0}) < 20.0; });
  ViewPlanner planner = Planner();
  const std::optional<NextView> first = Plan(planner);
  ASSERT_TRUE(first.has_value());
  planner.GiveUpBest();
  EXPECT_FALSE(planner.best().has_value());
  for (int i = 0; i < 120; ++i) {
    const std::optional<NextView> view = Plan(planner, 1);
    ASSERT_TRUE(!view || TranslationDistance(first->T_map_depth, view->T_map_depth) > 0.05) << i;
  }
}

}  // namespace
}  // namespace isotherm
