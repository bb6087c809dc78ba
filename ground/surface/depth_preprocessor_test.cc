#include "ground/surface/depth_preprocessor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "ground/surface/testing/analytic_views.h"

namespace isotherm {
namespace {

class DepthPreprocessorTest : public ::testing::Test {
 protected:
  const PreparedDepth& Process(const DepthFrame& frame) {
    preprocessor_ = std::make_unique<DepthPreprocessor>(options_, camera_, DepthSensorModel());
    return preprocessor_->Process(frame, pool_);
  }
  DepthFrame Flat(std::uint16_t raw) const {
    DepthFrame frame;
    frame.depth_raw = Image<std::uint16_t>(camera_.width, camera_.height, raw);
    return frame;
  }

  PreprocessorOptions options_;
  CameraModel camera_ = testing::SmallDepthCamera();
  ThreadPool pool_{2};
  std::unique_ptr<DepthPreprocessor> preprocessor_;
};

TEST_F(DepthPreprocessorTest, F12ValuesWithoutReturnOrOutOfRangeAreMasked) {
  DepthFrame frame = Flat(500);
  frame.depth_raw.At(100, 100) = kNoDepth;
  frame.depth_raw.At(101, 100) = kNoDepthSaturated;
  frame.depth_raw.At(102, 100) = 299;   // Nearer than 0.3 m.
  frame.depth_raw.At(103, 100) = 4001;  // Beyond 4 m.
  const PreparedDepth& depth = Process(frame);
  EXPECT_EQ(depth.valid_pixels, camera_.width * camera_.height - 4);
  for (int x = 100; x < 104; ++x) {
    EXPECT_EQ(depth.depth_m.At(x, 100), 0.0F);
    EXPECT_TRUE(std::isnan(depth.maps[0].vz.At(x, 100)));
  }
  EXPECT_FLOAT_EQ(depth.maps[0].vz.At(150, 100), 0.5F);
}

TEST_F(DepthPreprocessorTest, NormalsOfATiltedPlaneAreExactAtEachLevel) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, -1.0).normalized();
  const auto plane = [&](const Eigen::Vector3d& p) {
    return normal.dot(p - Eigen::Vector3d(0.3, 0.26, 0.5));
  };
  options_.mutable_expert()->set_bilateral_radius_px(0);
  const PreparedDepth& depth = Process(testing::RenderDepth(plane, camera_, testing::FirstPose()));
  for (int level = 0; level < kPyramidLevels; ++level) {
    const SurfaceMaps& maps = depth.maps[static_cast<std::size_t>(level)];
    const int x = maps.width() / 3;
    const int y = maps.height() / 2;
    const Eigen::Vector3d n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
    EXPECT_GT(n.dot(normal), std::cos(0.3 * kRadPerDeg)) << "level " << level;
    const Eigen::Vector3d p(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
    EXPECT_NEAR(plane(testing::FirstPose() * p), 0.0, 2e-5) << "level " << level;
  }
}

/// Says which pixels of an image have no return.
struct HolePattern {
  const char* name;
  std::function<bool(int x, int y, std::mt19937& random)> is_hole;
};

const HolePattern kHolePatterns[] = {
    {"every third row and column",
     [](int x, int y, std::mt19937& random) {
       return x % 3 == 2 || y % 3 == 2 || std::bernoulli_distribution(0.19)(random);
     }},
    {"two of five rows and columns",
     [](int x, int y, std::mt19937&) { return x % 5 >= 3 || y % 5 >= 3; }},
    {"60 % at random",
     [](int, int, std::mt19937& random) { return std::bernoulli_distribution(0.6)(random); }},
    {"every second row", [](int, int y, std::mt19937&) { return y % 2 == 0; }},
    {"every second column", [](int x, int, std::mt19937&) { return x % 2 == 0; }},
};

void Punch(const HolePattern& pattern, DepthFrame& frame) {
  std::mt19937 random(5);
  for (int y = 0; y < frame.depth_raw.height(); ++y) {
    for (int x = 0; x < frame.depth_raw.width(); ++x) {
      if (pattern.is_hole(x, y, random)) frame.depth_raw.At(x, y) = kNoDepth;
    }
  }
}

/// Angles in degrees between the normals of maps and the true ones, where these are turned away
/// from the line of sight by less than 60 degrees.
std::vector<double> NormalErrors(
    const SurfaceMaps& maps,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d& p_depth)>& true_normal) {
  std::vector<double> errors_deg;
  for (int y = 0; y < maps.height(); ++y) {
    for (int x = 0; x < maps.width(); ++x) {
      const Eigen::Vector3d p(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y));
      if (!p.allFinite()) continue;
      const Eigen::Vector3d n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
      const Eigen::Vector3d truth = true_normal(p);
      if (-truth.dot(p.normalized()) < 0.5) continue;
      errors_deg.push_back(std::acos(std::min(1.0, n.dot(truth))) / kRadPerDeg);
    }
  }
  std::ranges::sort(errors_deg);
  return errors_deg;
}

TEST_F(DepthPreprocessorTest, NormalsOfImagesFullOfHolesAreThoseOfTheShape) {
  const Eigen::Vector3d tilted = Eigen::Vector3d(0.5, -0.3, -1.0).normalized();
  const Eigen::Vector3d centre(0.02, -0.01, 0.7);
  struct Shape {
    const char* name;
    testing::SignedDistance distance_m;
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> normal;
  };
  const Shape shapes[] = {
      {"plane",
       [&](const Eigen::Vector3d& p) { return tilted.dot(p - Eigen::Vector3d(0.0, 0.0, 0.6)); },
       [&](const Eigen::Vector3d&) { return tilted; }},
      {"ball", [&](const Eigen::Vector3d& p) { return (p - centre).norm() - 0.2; },
       [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return (p - centre).normalized(); }}};
  for (const Shape& shape : shapes) {
    const DepthFrame whole =
        testing::RenderDepth(shape.distance_m, camera_, RigidTransform::Identity());
    std::array<std::size_t, kPyramidLevels> normals{};
    const PreparedDepth& prepared = Process(whole);
    for (std::size_t level = 0; level < kPyramidLevels; ++level)
      normals[level] = NormalErrors(prepared.maps[level], shape.normal).size();
    for (const HolePattern& pattern : kHolePatterns) {
      DepthFrame frame = whole;
      Punch(pattern, frame);
      const PreparedDepth& depth = Process(frame);
      for (std::size_t level = 0; level < kPyramidLevels; ++level) {
        SCOPED_TRACE(::testing::Message()
                     << shape.name << ", " << pattern.name << ", level " << level);
        const std::vector<double> errors = NormalErrors(depth.maps[level], shape.normal);
        ASSERT_GE(errors.size(), normals[level] * 9 / 10);
        EXPECT_LE(errors[errors.size() / 2], 0.2);
        EXPECT_LE(errors[errors.size() * 95 / 100], 1.5);
        EXPECT_LE(errors[errors.size() * 99 / 100], 4.0);
      }
    }
  }
}

TEST_F(DepthPreprocessorTest, HolesAreFilledOnSurfacesOnly) {
  // A step in depth, and nothing in the lower half.
  DepthFrame frame = Flat(500);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (x >= camera_.width / 2) frame.depth_raw.At(x, y) = 600;
      if (y >= camera_.height / 2) frame.depth_raw.At(x, y) = kNoDepth;
    }
  }
  Punch(kHolePatterns[2], frame);
  const int measured = static_cast<int>(std::ranges::count_if(
      frame.depth_raw.pixels(), [](std::uint16_t raw) { return raw != kNoDepth; }));
  const PreparedDepth& depth = Process(frame);
  EXPECT_EQ(depth.valid_pixels, measured) << "filled pixels are not measured";
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth.depth_m.At(x, y);
      if (y > camera_.height / 2) {
        ASSERT_EQ(z, 0.0F) << x << ", " << y;
      } else if (z > 0.0F) {
        ASSERT_NEAR(z, x < camera_.width / 2 ? 0.5F : 0.6F, 1e-4F) << x << ", " << y;
      }
    }
  }
}

TEST_F(DepthPreprocessorTest, AnImageThatIsNotFullOfHolesIsLeftAsItIs) {
  DepthFrame frame = Flat(500);
  std::mt19937 random(5);
  for (std::uint16_t& raw : frame.depth_raw.pixels()) {
    if (std::bernoulli_distribution(0.05)(random)) raw = kNoDepth;
  }
  const PreparedDepth& depth = Process(frame);
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i)
    ASSERT_EQ(depth.depth_m.data()[i] > 0.0F, frame.depth_raw.data()[i] != kNoDepth);
}

TEST_F(DepthPreprocessorTest, FilterSmoothsNoiseButNotAnEdge) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::normal_distribution<double> noise(0.0, 0.5);  // Millimetres, as at half a metre.
  DepthFrame frame = Flat(0);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const double truth = x < 160 ? 500.0 : 560.0;
      frame.depth_raw.At(x, y) = static_cast<std::uint16_t>(std::lround(truth + noise(random)));
    }
  }
  options_.mutable_expert()->set_min_depth_m(0.1);
  const PreparedDepth& depth = Process(frame);
  const SurfaceMaps& maps = depth.maps[0];
  double squared = 0.0;
  int count = 0;
  for (int y = 20; y < 200; ++y) {
    for (int x = 20; x < 140; ++x, ++count) squared += std::pow(maps.vz.At(x, y) - 0.5, 2);
    EXPECT_NEAR(maps.vz.At(155, y), 0.5, 0.003) << "left of the edge, row " << y;
    EXPECT_NEAR(maps.vz.At(165, y), 0.56, 0.003) << "right of the edge, row " << y;
  }
  EXPECT_LT(std::sqrt(squared / count), 0.00025) << "half of the noise";
}

TEST_F(DepthPreprocessorTest, DepthOfADistortedCameraIsRectified) {
  camera_.k1 = -0.2;
  const auto ball = [](const Eigen::Vector3d& p) {
    return std::min(0.5 - p.z(), (p - Eigen::Vector3d(0.10, 0.06, 0.42)).norm() - 0.04);
  };
  const DepthFrame frame = testing::RenderDepth(ball, camera_, RigidTransform::Identity());
  const PreparedDepth& depth = Process(frame);
  // The rectified image shows the ball where an ideal camera would.
  const CameraModel ideal = camera_.WithoutDistortion();
  const auto centre = Project(ideal, {0.10, 0.06, 0.38});
  EXPECT_LT(depth.depth_m.At(static_cast<int>(centre->x()), static_cast<int>(centre->y())), 0.39F);
}

}  // namespace
}  // namespace isotherm
