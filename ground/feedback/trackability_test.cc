#include "ground/feedback/trackability.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

const Eigen::Vector3d kCamera(0.1, 0.2, 0.3);
/// The tracker gives a direction up below this.
constexpr double kSlides = 0.0003;
constexpr int kRays = 2000;

/// A square of 0.4 m, half a metre ahead.
void AddWall(Trackability& view) {
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      view.Add(kCamera + Eigen::Vector3d(0.01 * i - 0.2, 0.01 * j - 0.2, 0.5), {0.0, 0.0, -1.0},
               0.5);
    }
  }
}

/// A decimetre square that stands out from the wall at (x, y), and its like opposite.
void AddFaces(Trackability& view, const Eigen::Vector3d& normal, double x, double y) {
  const Eigen::Vector3d along(normal.y(), normal.x(), 0.0);
  for (const double side : {1.0, -1.0}) {
    for (int i = 0; i < 10; ++i) {
      for (int j = 0; j < 10; ++j) {
        const double z = 0.4 + 0.01 * j;
        view.Add(kCamera + Eigen::Vector3d(side * x, side * y, z) + (0.01 * i - 0.045) * along,
                 normal, z);
      }
    }
  }
}

void AddStructure(Trackability& view) {
  AddFaces(view, {1.0, 0.0, 0.0}, 0.15, 0.1);
  AddFaces(view, {0.0, 1.0, 0.0}, 0.1, 0.15);
}

TEST(TrackabilityTest, ABareWallLetsTheRigSlide) {
  Trackability view(kCamera, kRays);
  AddWall(view);
  EXPECT_LT(view.Strength(), kSlides);
  EXPECT_EQ(view.Firmness(), 0.0);
}

TEST(TrackabilityTest, AStepInOneDirectionHoldsOnlyOne) {
  Trackability view(kCamera, kRays);
  AddWall(view);
  AddFaces(view, {1.0, 0.0, 0.0}, 0.15, 0.1);
  EXPECT_LT(view.Strength(), kSlides);
}

TEST(TrackabilityTest, FacesTowardsTwoSidesHoldTheRig) {
  Trackability view(kCamera, kRays);
  AddWall(view);
  AddStructure(view);
  EXPECT_GT(view.Strength(), 10.0 * kSlides);
  EXPECT_EQ(view.Firmness(), 1.0) << "all rays meet surface";
}

TEST(TrackabilityTest, WithLittleSurfaceInViewTrackingIsUnsureHoweverItIsShaped) {
  constexpr int kWide = 4 * kRays;
  Trackability view(kCamera, kWide);
  AddWall(view);
  AddStructure(view);
  EXPECT_NEAR(view.surface(), 0.25, 0.001);
  EXPECT_EQ(view.Firmness(), 0.0);
}

TEST(TrackabilityTest, NothingHoldsNothing) {
  const Trackability view(kCamera, kRays);
  EXPECT_EQ(view.Strength(), 0.0);
  EXPECT_EQ(view.Firmness(), 0.0);
}

}  // namespace
}  // namespace isotherm
