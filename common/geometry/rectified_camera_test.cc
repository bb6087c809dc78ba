#include "common/geometry/rectified_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace isotherm {
namespace {

CameraModel Camera() {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = camera.fy = 371.4;
  camera.cx = 190.5;
  camera.cy = 143.5;
  return camera;
}

/// Across the middle row, between the centres of the outer pixels.
double FieldOfViewDeg(const CameraModel& camera) {
  const double left = Unproject(camera, {0.0, camera.cy}).x();
  const double right = Unproject(camera, {camera.width - 1.0, camera.cy}).x();
  return (std::atan(right) - std::atan(left)) * 180.0 / std::numbers::pi;
}

TEST(RectifiedCameraTest, KeepsTheFieldOfViewOfABarrelLens) {
  CameraModel camera = Camera();
  camera.k1 = -0.439;
  camera.k2 = 0.29;
  camera.k3 = -0.114;
  EXPECT_GT(FieldOfViewDeg(camera), FieldOfViewDeg(camera.WithoutDistortion()) + 5.0);
  EXPECT_GE(FieldOfViewDeg(RectifiedCamera(camera)), FieldOfViewDeg(camera));
}

TEST(RectifiedCameraTest, WithoutDistortionItIsTheSameCamera) {
  const CameraModel ideal = RectifiedCamera(Camera());
  EXPECT_EQ(ideal.width, 382);
  EXPECT_EQ(ideal.height, 288);
  EXPECT_EQ(ideal.cx, 190.5);
  EXPECT_EQ(ideal.cy, 143.5);
}

TEST(RectifiedCameraTest, WhatNeedsATooLargeImageGetsAShorterFocalLength) {
  CameraModel camera = Camera();
  // A fish's eye: what lies at 1.2 is drawn in to 0.52.
  camera.k1 = -0.6;
  camera.k2 = 0.27;
  camera.k3 = -0.045;
  const CameraModel ideal = RectifiedCamera(camera);
  EXPECT_LE(ideal.width, 1.5 * camera.width + 2.0);
  EXPECT_LE(ideal.height, 1.5 * camera.height + 2.0);
  EXPECT_LT(ideal.fx, camera.fx);
  EXPECT_EQ(ideal.fx, ideal.fy);
  EXPECT_GE(FieldOfViewDeg(ideal), FieldOfViewDeg(camera));
}

TEST(RectifiedCameraTest, NoDistortionMakesAnImageWithoutBound) {
  const std::map<LensKind, std::vector<double CameraModel::*>> coefficients = {
      {LensKind::kBrownConrady,
       {&CameraModel::k1, &CameraModel::k2, &CameraModel::k3, &CameraModel::p1, &CameraModel::p2}},
      {LensKind::kRational,
       {&CameraModel::k1, &CameraModel::k4, &CameraModel::k5, &CameraModel::k6}},
      {LensKind::kFisheye,
       {&CameraModel::k1, &CameraModel::k2, &CameraModel::k3, &CameraModel::k4}}};
  for (const auto& [lens, members] : coefficients) {
    for (const double k : {-1e4, -20.0, -1.0, 1.0, 20.0, 1e4}) {
      for (double CameraModel::*const coefficient : members) {
        for (const double focal_px : {1.0, 371.4, 1e6}) {
          CameraModel camera = Camera();
          camera.lens = lens;
          camera.fx = camera.fy = focal_px;
          camera.*coefficient = k;
          const CameraModel ideal = RectifiedCamera(camera);
          EXPECT_TRUE(Validate(ideal, "thermal").ok()) << k << ", focal " << focal_px;
          EXPECT_LE(ideal.width, 1.5 * camera.width + 2.0) << k;
          EXPECT_LE(ideal.height, 1.5 * camera.height + 2.0) << k;
        }
      }
    }
  }
}

TEST(RectifiedCameraTest, OfAHemisphereTheInner70DegreesAreKept) {
  CameraModel camera = Camera();
  camera.lens = LensKind::kFisheye;
  for (const double degrees : {170.0, 180.0, 200.0}) {
    camera.fx = camera.fy = camera.width / (degrees * std::numbers::pi / 180.0);
    const CameraModel ideal = RectifiedCamera(camera);
    EXPECT_NEAR(FieldOfViewDeg(ideal), 140.0, 0.5) << degrees;
    EXPECT_LE(ideal.width, 1.5 * camera.width + 2.0);
    EXPECT_GT(ideal.fx, 0.6 * camera.fx) << "the middle keeps its pixels";
  }
}

TEST(ProjectIntoImageTest, WhatThePolynomialFoldsBackIsNotInTheImage) {
  CameraModel camera = Camera();
  camera.k1 = -2.0;
  // x (1 - 2 x^2) is 0.16 at x = 0.17 and again at x = 0.59.
  EXPECT_TRUE(ProjectIntoImage(camera, {0.17, 0.0}).has_value());
  EXPECT_FALSE(ProjectIntoImage(camera, {0.59, 0.0}).has_value());
  EXPECT_FALSE(ProjectIntoImage(camera, {1e30, 0.0}).has_value());
}

}  // namespace
}  // namespace isotherm
