#include <gtest/gtest.h>

#include <cmath>

#include "common/testing/opencv_camera.h"
#include "ground/surface/depth_preprocessor.h"

namespace isotherm {
namespace {

/// Nearer than this to the border of two pixels, single precision decides which is the nearest.
constexpr float kNearBorder_px = 1e-3F;

CameraModel DistortedCamera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = 285.0;
  camera.fy = 287.0;
  camera.cx = 163.2;
  camera.cy = 117.9;
  camera.k1 = -0.21;
  camera.k2 = 0.09;
  camera.p1 = 0.0023;
  camera.p2 = -0.0031;
  camera.k3 = 0.02;
  return camera;
}

/// Another depth, in millimetres, than that of any pixel near it.
std::uint16_t RawAt(int x, int y) { return static_cast<std::uint16_t>(500 + (x + 61 * y) % 3000); }

TEST(DepthRectificationTest, EachPixelShowsTheDepthThatOpencvFindsThere) {
  const CameraModel camera = DistortedCamera();
  DepthFrame frame;
  frame.depth_scale = 1000.0;
  frame.depth_raw = Image<std::uint16_t>(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) frame.depth_raw.At(x, y) = RawAt(x, y);
  }
  ThreadPool pool(1);
  DepthPreprocessor preprocessor(PreprocessorOptions(), camera, DepthSensorModel());
  const Image<float>& depth_m = preprocessor.Process(frame, pool).depth_m;
  const testing::OpencvRectification truth(camera, camera.WithoutDistortion());
  int compared = 0;
  int outside = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const float x = truth.x(v, u);
      const float y = truth.y(v, u);
      const auto near_border = [](float c) {
        return std::abs(c + 0.5F - std::round(c + 0.5F)) < kNearBorder_px;
      };
      if (near_border(x) || near_border(y)) continue;
      const int column = static_cast<int>(std::lround(x));
      const int row = static_cast<int>(std::lround(y));
      const bool inside = frame.depth_raw.Contains(column, row);
      const double expected_m = inside ? RawAt(column, row) / 1000.0 : 0.0;
      ASSERT_NEAR(depth_m.At(u, v), expected_m, 1e-6) << "pixel " << u << ", " << v;
      ++(inside ? compared : outside);
    }
  }
  EXPECT_GT(compared, 70'000);
  EXPECT_LT(outside, 100) << "a barrel lens sees more than the ideal camera";
}

/// The bias belongs to the raw pixel, whichever pixel of the rectified image shows it.
TEST(DepthRectificationTest, ABiasIsCorrectedWhereTheRawImageShowsIt) {
  const CameraModel camera = DistortedCamera();
  DepthSensorModel sensor;
  sensor.bias = {.columns = 3, .rows = 2, .distances_m = {0.6F, 1.2F}, .multipliers = {}};
  for (int node = 0; node < 12; ++node)
    sensor.bias.multipliers.push_back(0.95F + 0.01F * static_cast<float>(node));
  DepthFrame frame;
  frame.depth_scale = 1000.0;
  frame.depth_raw = Image<std::uint16_t>(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      frame.depth_raw.At(x, y) = static_cast<std::uint16_t>(400 + 3 * x);
  ThreadPool pool(2);
  DepthPreprocessor preprocessor(PreprocessorOptions(), camera, sensor);
  DepthPreprocessor uncorrected(PreprocessorOptions(), camera, DepthSensorModel());
  const Image<float>& corrected_m = preprocessor.Process(frame, pool).depth_m;
  const Image<float>& measured_m = uncorrected.Process(frame, pool).depth_m;
  const testing::OpencvRectification truth(camera, camera.WithoutDistortion());
  int compared = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double measured = measured_m.At(u, v);
      if (measured == 0.0) {
        ASSERT_EQ(corrected_m.At(u, v), 0.0F);
        continue;
      }
      const double expected =
          measured * sensor.bias.At(truth.x(v, u) / 319.0, truth.y(v, u) / 239.0, measured);
      ASSERT_NEAR(corrected_m.At(u, v), expected, 2e-5) << "pixel " << u << ", " << v;
      ++compared;
    }
  EXPECT_GT(compared, 60'000);
}

}  // namespace
}  // namespace isotherm
