#include "common/simulation/target_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/simulation/options.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/target_views.h"

namespace isotherm {
namespace {

constexpr double kFaceCelsius = 27.0;

CameraModel SmallCamera() {
  CameraModel camera;
  camera.width = 240;
  camera.height = 200;
  camera.fx = camera.fy = 220.0;
  camera.cx = 119.3;
  camera.cy = 100.6;
  camera.k1 = -0.2;
  return camera;
}

/// The board straight before the camera, its middle on the axis.
RigidTransform Facing(const PerforatedBoard& board, double distance_m, double tilt_deg = 0.0) {
  const Eigen::Vector2d half = board.HalfSize();
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(tilt_deg * kRadPerDeg, Eigen::Vector3d::UnitY()));
  return MakeTransform(
      Eigen::Vector3d(0.0, 0.0, distance_m) - rotation * Eigen::Vector3d(half.x(), half.y(), 0.0),
      rotation);
}

TargetCameraOptions Noiseless() {
  TargetCameraOptions options;
  options.netd_k = options.infrared_noise = options.disparity_noise_px = 0.0;
  return options;
}

TEST(PerforatedBoardTest, HolesLieAsOpenCvNumbersThem) {
  const PerforatedBoard board;
  EXPECT_EQ(board.HoleCentre(0), Eigen::Vector2d(0.0, 0.0));
  EXPECT_NEAR((board.HoleCentre(3) - Eigen::Vector2d(0.3, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((board.HoleCentre(4) - Eigen::Vector2d(0.05, 0.05)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((board.HoleCentre(35) - Eigen::Vector2d(0.3, 0.4)).norm(), 0.0, 1e-12);
}

TEST(PerforatedBoardTest, WarpIsWhatItsNameSaysAtTheCorners) {
  PerforatedBoard board;
  board.bowl_m = 0.0015;
  board.twist_m = 0.001;
  const Eigen::Vector2d half = board.HalfSize();
  EXPECT_NEAR(board.FaceZ({0.0, 0.0}), 0.0025, 1e-9);
  EXPECT_NEAR(board.FaceZ({2.0 * half.x(), 0.0}), 0.0005, 1e-9);
  EXPECT_NEAR(board.FaceZ(half), 0.0, 1e-9);
}

TEST(PerforatedBoardTest, ObliqueRaysMeetTheWallOfTheFrontLayerOnOneSide) {
  const PerforatedBoard board;
  // 0.2 mm inside the rim of the hole in the middle, on the side that the ray goes towards.
  const Eigen::Vector3d front(0.05 + 0.1 + 0.0248, 0.25, 0.0);
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
  EXPECT_EQ(CastAtBoard(board, front - direction, direction).surface, BoardSurface::kWall);
  const Eigen::Vector3d opposite(0.05 + 0.1 - 0.0248, 0.25, 0.0);
  EXPECT_EQ(CastAtBoard(board, opposite - direction, direction).surface, BoardSurface::kPlate);
  EXPECT_EQ(CastAtBoard(board, Eigen::Vector3d(0.1, 0.05, -1.0), Eigen::Vector3d::UnitZ()).surface,
            BoardSurface::kFace);
  EXPECT_EQ(CastAtBoard(board, Eigen::Vector3d(2.0, 0.0, -1.0), Eigen::Vector3d::UnitZ()).surface,
            BoardSurface::kBackground);
}

TEST(TargetCameraTest, HotAreaIsThatOfTheHoles) {
  // Without noise the excess over the face, over that of the plate, adds up to the holes' areas.
  PerforatedBoard board;
  board.face_celsius = board.background_celsius = kFaceCelsius;
  board.plate_uneven_k = 0.0;
  CameraModel camera = SmallCamera().WithoutDistortion();
  const double distance_m = 0.7;
  const Image<std::uint16_t> image =
      TargetCamera(camera, Noiseless()).Thermal(board, Facing(board, distance_m), 1);
  const BandRadiance band;
  const double face = band.RadianceFromCelsius(kFaceCelsius);
  const double plate = band.RadianceFromCelsius(board.plate_celsius);
  double area_px = 0.0;
  for (const std::uint16_t count : image.pixels()) {
    const double celsius = 0.01 * count - kCelsiusZero_k;
    area_px += (band.RadianceFromCelsius(celsius) - face) / (plate - face);
  }
  const double radius_px = 0.025 / distance_m * camera.fx;
  const double expected_px = board.holes() * std::numbers::pi * radius_px * radius_px;
  // A thousandth of the area; wall rays hide part of the holes beside the axis: up to 0.5 %.
  EXPECT_NEAR(area_px / expected_px, 0.996, 0.004);
}

TEST(TargetCameraTest, CentroidOfAHoleOnTheAxisIsItsCentre) {
  PerforatedBoard board;
  board.plate_uneven_k = 0.0;
  const CameraModel camera = SmallCamera();
  // The middle hole (row 4, column 1.5) does not exist; put hole 17 on the axis.
  const Eigen::Vector2d centre = board.HoleCentre(17);
  const RigidTransform pose =
      MakeTransform(Eigen::Vector3d(-centre.x(), -centre.y(), 0.7), Eigen::Quaterniond::Identity());
  const Image<std::uint16_t> image = TargetCamera(camera, Noiseless()).Thermal(board, pose, 1);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0.0;
  constexpr int kHalf_px = 11;
  const int u = 119, v = 101;
  // The face beside the hole is not everywhere alike.
  std::uint16_t face = 0;
  for (int i = -kHalf_px; i <= kHalf_px; ++i) {
    for (const int side : {-kHalf_px, kHalf_px})
      face = std::max({face, image.At(u + i, v + side), image.At(u + side, v + i)});
  }
  for (int y = v - kHalf_px; y <= v + kHalf_px; ++y) {
    for (int x = u - kHalf_px; x <= u + kHalf_px; ++x) {
      const double hot = std::max(0.0, static_cast<double>(image.At(x, y) - face));
      sum += hot * Eigen::Vector2d(x, y);
      total += hot;
    }
  }
  EXPECT_NEAR((sum / total - Eigen::Vector2d(camera.cx, camera.cy)).norm(), 0.0, 0.03);
}

TEST(TargetCameraTest, DepthShowsFacePlateAndTheProjectorsShadow) {
  const PerforatedBoard board;
  CameraModel camera = *DefaultSimulatedRig().depth;
  const Image<std::uint16_t> depth =
      TargetCamera(camera, Noiseless()).Depth(board, Facing(board, 0.7), 1);
  int face = 0, plate = 0, none = 0;
  for (const std::uint16_t value : depth.pixels()) {
    face += std::abs(value - 700) <= 3 ? 1 : 0;
    plate += std::abs(value - 713) <= 3 ? 1 : 0;
    none += value == 0 ? 1 : 0;
  }
  EXPECT_GT(face, 50'000);
  EXPECT_GT(plate, 30'000);
  EXPECT_GT(none, 1'000);
  // Where the background is, nothing comes back.
  EXPECT_EQ(depth.At(0, 0), 0);
}

TEST(TargetViewsTest, EachViewShowsEachHoleAndViewsDiffer) {
  PerforatedBoard board;
  const TargetObserver observer = {*DefaultSimulatedRig().depth};
  const auto poses = SampleTargetViews(board, {&observer, 1}, 20, {}, 3);
  ASSERT_EQ(poses.size(), 20U);
  double tilt_max = 0.0;
  for (const RigidTransform& pose : poses) {
    tilt_max = std::max(tilt_max, std::acos(pose.linear()(2, 2)) / kRadPerDeg);
    for (int hole = 0; hole < board.holes(); ++hole) {
      const Eigen::Vector2d xy = board.HoleCentre(hole);
      const auto pixel = Project(observer.camera, pose * Eigen::Vector3d(xy.x(), xy.y(), 0.0));
      ASSERT_TRUE(pixel.has_value());
      EXPECT_GT(pixel->minCoeff(), 0.0);
      EXPECT_LT(pixel->x(), observer.camera.width - 1);
      EXPECT_LT(pixel->y(), observer.camera.height - 1);
    }
  }
  EXPECT_GT(tilt_max, 25.0);
}

}  // namespace
}  // namespace isotherm
