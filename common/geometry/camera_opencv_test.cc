#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/rectified_camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/testing/opencv_camera.h"

namespace isotherm {
namespace {

/// Both compute the same polynomial in double precision, in another order.
constexpr double kRounding_px = 1e-9;
/// Both stop their iterations far below this, in normalised image coordinates.
constexpr double kIterations = 1e-9;

struct Lens {
  std::string name;
  CameraModel camera;
};

CameraModel Camera(int width, int height, double focal_px) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal_px;
  camera.fy = 1.003 * focal_px;
  camera.cx = 0.53 * width;
  camera.cy = 0.48 * height;
  return camera;
}

/// Lenses of the kind that calibrations of the rig's cameras give, and each coefficient alone, so
/// that none can stand in for another.
std::vector<Lens> Lenses() {
  std::vector<Lens> lenses = {{"None", Camera(640, 480, 570.0)}};
  CameraModel thermal = Camera(382, 288, 371.4);
  thermal.k1 = -0.439;
  thermal.k2 = 0.29;
  thermal.p1 = 0.000454;
  thermal.p2 = -0.000257;
  thermal.k3 = -0.114;
  lenses.push_back({"Thermal", thermal});
  CameraModel depth = Camera(320, 240, 285.0);
  depth.k1 = 0.08;
  depth.k2 = -0.21;
  depth.p1 = -0.0013;
  depth.p2 = 0.0021;
  depth.k3 = 0.11;
  lenses.push_back({"Depth", depth});
  const auto alone = [&](const char* name, double CameraModel::*coefficient, double value) {
    CameraModel camera = Camera(382, 288, 371.4);
    camera.*coefficient = value;
    lenses.push_back({name, camera});
  };
  alone("OnlyK1", &CameraModel::k1, -0.2);
  alone("OnlyK2", &CameraModel::k2, 0.3);
  alone("OnlyP1", &CameraModel::p1, 0.01);
  alone("OnlyP2", &CameraModel::p2, -0.01);
  alone("OnlyK3", &CameraModel::k3, 0.2);
  // Wide ones, of some 80 degrees across. The quotient is about that of an angle and its tangent.
  CameraModel rational = Camera(640, 480, 460.0);
  rational.lens = LensKind::kRational;
  rational.k1 = 0.778, rational.k2 = 0.068, rational.k3 = 0.002;
  rational.p1 = 0.0004, rational.p2 = -0.0007;
  rational.k4 = 1.11, rational.k5 = 0.238, rational.k6 = 0.004;
  lenses.push_back({"Rational", rational});
  CameraModel fisheye = Camera(382, 288, 285.0);
  fisheye.lens = LensKind::kFisheye;
  lenses.push_back({"FisheyeWithoutCoefficients", fisheye});
  fisheye.k1 = -0.05, fisheye.k2 = 0.03, fisheye.k3 = -0.02, fisheye.k4 = 0.004;
  lenses.push_back({"Fisheye", fisheye});
  return lenses;
}

class CameraAgainstOpencvTest : public ::testing::TestWithParam<Lens> {
 protected:
  const CameraModel& camera_ = GetParam().camera;
};

TEST_P(CameraAgainstOpencvTest, PointsOfARigProjectWhereProjectPointsPutsThem) {
  const Eigen::AngleAxisd rotation(0.21, Eigen::Vector3d(0.3, -0.8, 0.4).normalized());
  const Eigen::Vector3d translation(0.052, -0.011, 0.007);
  const RigidTransform T_camera_rig = MakeTransform(translation, Eigen::Quaterniond(rotation));
  std::vector<cv::Point3d> points;
  for (double z : {0.3, 0.8, 2.5}) {
    for (int y = -5; y <= 5; ++y) {
      for (int x = -6; x <= 6; ++x) points.emplace_back(0.1 * x * z, 0.1 * y * z, z);
    }
  }
  const Eigen::Vector3d axis_angle = rotation.angle() * rotation.axis();
  const std::vector<cv::Point2d> truth =
      testing::OpencvProject(camera_, points, {axis_angle.x(), axis_angle.y(), axis_angle.z()},
                             {translation.x(), translation.y(), translation.z()});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p_rig(points[i].x, points[i].y, points[i].z);
    const auto pixel = Project(camera_, T_camera_rig * p_rig);
    ASSERT_TRUE(pixel.has_value()) << p_rig.transpose();
    EXPECT_NEAR(pixel->x(), truth[i].x, kRounding_px) << p_rig.transpose();
    EXPECT_NEAR(pixel->y(), truth[i].y, kRounding_px) << p_rig.transpose();
  }
}

TEST_P(CameraAgainstOpencvTest, PixelsLookWhereUndistortPointsSays) {
  std::vector<cv::Point2d> pixels;
  for (int v = 0; v < camera_.height; v += 7) {
    for (int u = 0; u < camera_.width; u += 7) pixels.emplace_back(u + 0.3, v - 0.2);
  }
  const std::vector<cv::Point2d> truth =
      testing::OpencvUndistort(camera_, pixels, cv::Matx33d::eye());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2d ray = Unproject(camera_, {pixels[i].x, pixels[i].y});
    EXPECT_NEAR(ray.x(), truth[i].x, kIterations) << pixels[i];
    EXPECT_NEAR(ray.y(), truth[i].y, kIterations) << pixels[i];
  }
}

TEST_P(CameraAgainstOpencvTest, ARectifiedImageHoldsTheWholeBorderAndNoMore) {
  const CameraModel ideal = RectifiedCamera(camera_);
  EXPECT_FALSE(ideal.HasDistortion());
  EXPECT_EQ(ideal.fx, camera_.fx) << "as sharp at the centre";
  EXPECT_EQ(ideal.fy, camera_.fy);
  EXPECT_NEAR(ideal.cx - camera_.cx, std::round(ideal.cx - camera_.cx), kRounding_px);
  std::vector<cv::Point2d> border;
  for (int v = 0; v < camera_.height; ++v) {
    for (const int u : {0, camera_.width - 1}) border.emplace_back(u, v);
  }
  for (int u = 0; u < camera_.width; ++u) {
    for (const int v : {0, camera_.height - 1}) border.emplace_back(u, v);
  }
  const std::vector<cv::Point2d> truth =
      testing::OpencvUndistort(camera_, border, testing::OpencvMatrix(ideal));
  double left = ideal.width, right = 0.0, top = ideal.height, bottom = 0.0;
  for (const cv::Point2d& pixel : truth) {
    left = std::min(left, pixel.x);
    right = std::max(right, pixel.x);
    top = std::min(top, pixel.y);
    bottom = std::max(bottom, pixel.y);
  }
  // Whole pixels are kept, so less than one remains beyond each side.
  const auto just_inside = ::testing::AllOf(::testing::Ge(-1e-5), ::testing::Lt(1.0));
  EXPECT_THAT(left, just_inside);
  EXPECT_THAT(top, just_inside);
  EXPECT_THAT(ideal.width - 1 - right, just_inside);
  EXPECT_THAT(ideal.height - 1 - bottom, just_inside);
}

TEST_P(CameraAgainstOpencvTest, WhatIsInTheImageIsThereByProjectPointsToo) {
  std::vector<cv::Point3d> points;
  for (int y = -12; y <= 12; ++y) {
    for (int x = -14; x <= 14; ++x) points.emplace_back(0.05 * x, 0.05 * y, 1.0);
  }
  const std::vector<cv::Point2d> truth = testing::OpencvProject(camera_, points, {}, {});
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = ProjectIntoImage(camera_, {points[i].x, points[i].y});
    const bool expected = truth[i].x >= -0.5 && truth[i].x < camera_.width - 0.5 &&
                          truth[i].y >= -0.5 && truth[i].y < camera_.height - 0.5;
    ASSERT_EQ(pixel.has_value(), expected) << points[i];
    if (!pixel) continue;
    ++inside;
    EXPECT_NEAR(pixel->x(), truth[i].x, kRounding_px);
    EXPECT_NEAR(pixel->y(), truth[i].y, kRounding_px);
  }
  EXPECT_GT(inside, 250);
}

INSTANTIATE_TEST_SUITE_P(Lenses, CameraAgainstOpencvTest, ::testing::ValuesIn(Lenses()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace isotherm
