#include "ground/console/group_codec.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ground/thermal/sigma_code.h"

namespace isotherm {
namespace {

constexpr double kCodecVoxel_m = 0.002;

VoxelGrid CodecGrid() {
  VoxelGrid grid;
  grid.min_m = {-0.48, 0.1, 2.0};
  grid.voxel_size_m = kCodecVoxel_m;
  grid.blocks = GridIndex::Constant(60);
  return grid;
}

/// A bent sheet of points within group (1, 2, 3), with all numbers set.
Surface Sheet() {
  Surface surface;
  const Eigen::Vector3d origin = CodecGrid().VoxelCentre(32 * GridIndex(1, 2, 3));
  constexpr int kSide = 20;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      CloudPoint point;
      point.position_m =
          (origin + kCodecVoxel_m * Eigen::Vector3d(x, y, 10.0 + 0.02 * x * y)).cast<float>();
      point.normal = Eigen::Vector3f::UnitZ();
      point.celsius = 20.0F + static_cast<float>(x);
      point.distance_class = 1;
      point.angle_class = 2;
      point.motion_class = 0;
      point.disagreement_class = 255;
      point.measured_distance_m = 0.5F + 0.01F * static_cast<float>(y);
      point.measured_angle_deg = static_cast<float>(x);
      point.nuc_age_s = static_cast<float>(y);
      point.sigma_k = 0.25F;
      point.nuc_epoch = 3;
      point.good_count = 7;
      surface.points.push_back(point);
    }
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x;
      surface.triangles.emplace_back(a, a + 1, a + kSide);
      surface.triangles.emplace_back(a + 1, a + kSide + 1, a + kSide);
    }
  }
  return surface;
}

struct Decoded {
  std::vector<GroupVertex> vertices;
  std::vector<unsigned int> indices;
};
Decoded Decode(const live::SurfaceGroup& group) {
  Decoded decoded;
  decoded.vertices.resize(group.vertex_count());
  decoded.indices.resize(group.index_count());
  EXPECT_EQ(
      meshopt_decodeVertexBuffer(decoded.vertices.data(), group.vertex_count(), sizeof(GroupVertex),
                                 reinterpret_cast<const unsigned char*>(group.vertices().data()),
                                 group.vertices().size()),
      0);
  EXPECT_EQ(
      meshopt_decodeIndexBuffer(decoded.indices.data(), group.index_count(),
                                reinterpret_cast<const unsigned char*>(group.indices().data()),
                                group.indices().size()),
      0);
  return decoded;
}

using Corner = std::array<float, 4>;
/// Triangles as sets of corners (position and temperature), each beginning with its smallest
/// corner.
std::vector<std::array<Corner, 3>> Sorted(std::vector<std::array<Corner, 3>> triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::ranges::min_element(t), t.end());
  std::ranges::sort(triangles);
  return triangles;
}

TEST(GroupCodecTest, TheMeshComesBackToWithinAStep) {
  const Surface surface = Sheet();
  const live::SurfaceGroup group =
      EncodeGroup({.map = 4, .x = 1, .y = 2, .z = 3}, 9, CodecGrid(), surface).group;
  EXPECT_EQ(group.key().map(), 4U);
  EXPECT_EQ(group.version(), 9U);
  const Decoded decoded = Decode(group);
  ASSERT_EQ(decoded.vertices.size(), surface.points.size());
  ASSERT_EQ(decoded.indices.size(), 3 * surface.triangles.size());
  std::vector<std::array<Corner, 3>> sent, got;
  const auto step = [&](float value, double origin) {
    return static_cast<float>(std::lround((value - origin) / group.scale()));
  };
  for (const Eigen::Vector3i& t : surface.triangles) {
    std::array<Corner, 3> triangle;
    for (int i = 0; i < 3; ++i) {
      const CloudPoint& p = surface.points[static_cast<std::size_t>(t[i])];
      triangle[static_cast<std::size_t>(i)] = {
          step(p.position_m.x(), group.origin().x()), step(p.position_m.y(), group.origin().y()),
          step(p.position_m.z(), group.origin().z()),
          static_cast<float>(1 + std::lround((p.celsius + 100.0F) * 40.0F))};
    }
    sent.push_back(triangle);
  }
  for (std::size_t i = 0; i < decoded.indices.size(); i += 3) {
    std::array<Corner, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const GroupVertex& v = decoded.vertices[decoded.indices[i + k]];
      triangle[k] = {static_cast<float>(v.position[0]), static_cast<float>(v.position[1]),
                     static_cast<float>(v.position[2]), static_cast<float>(v.temperature)};
    }
    got.push_back(triangle);
  }
  EXPECT_EQ(Sorted(got), Sorted(sent));
  EXPECT_LT(group.scale(), 1.1e-6);  // A step is about a micrometre: 64 mm in 65535.
}

TEST(GroupCodecTest, AVertexSaysHowItWasMeasured) {
  const GroupVertex vertex = ToVertex(Sheet().points[25], {1.4F, 70000.0F, -3.0F});
  EXPECT_EQ(vertex.position[0], 1);
  EXPECT_EQ(vertex.position[1], 65535);  // Limited, not wrapped.
  EXPECT_EQ(vertex.position[2], 0);
  EXPECT_EQ(vertex.classes & 3, 3);       // Distance good.
  EXPECT_EQ(vertex.classes >> 2 & 3, 2);  // Angle acceptable.
  EXPECT_EQ(vertex.classes >> 4 & 3, 1);  // Motion bad.
  EXPECT_EQ(vertex.classes >> 6 & 3, 0);  // Disagreement not checked.
  EXPECT_EQ(vertex.angle, 10);            // 5 degrees.
  EXPECT_EQ(vertex.distance, 51);         // 0.51 m.
  EXPECT_NEAR(1024.0 * std::pow(vertex.age / 254.0, 2.0), 1.0, 0.15);
}

TEST(GroupCodecTest, WhatWasNeverMeasuredIsSaidSo) {
  const GroupVertex vertex = ToVertex(CloudPoint(), Eigen::Vector3f::Zero());
  EXPECT_EQ(vertex.temperature, 0);
  EXPECT_EQ(vertex.classes, 0);
  EXPECT_EQ(vertex.angle, kNoAngle);
  EXPECT_EQ(vertex.distance, kNoDistance);
  EXPECT_EQ(vertex.age, kNoNucAge);
  EXPECT_EQ(ToDetails(CloudPoint()).sigma, 0);
}

TEST(GroupCodecTest, DetailsAreInTheOrderOfTheVertices) {
  Surface surface = Sheet();
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    surface.points[i].good_count = static_cast<std::uint8_t>(surface.points[i].celsius);
  const EncodedGroup encoded = EncodeGroup({.x = 1, .y = 2, .z = 3}, 1, CodecGrid(), surface);
  const Decoded decoded = Decode(encoded.group);
  std::vector<VertexDetails> details(encoded.details.vertex_count());
  ASSERT_EQ(meshopt_decodeVertexBuffer(
                details.data(), details.size(), sizeof(VertexDetails),
                reinterpret_cast<const unsigned char*>(encoded.details.details().data()),
                encoded.details.details().size()),
            0);
  ASSERT_EQ(details.size(), decoded.vertices.size());
  for (std::size_t i = 0; i < details.size(); ++i) {
    EXPECT_EQ(details[i].sigma, SigmaCode::Of(0.25F));
    EXPECT_EQ(details[i].epoch, 3);
    EXPECT_EQ(1 + 40 * (details[i].observations + 100), decoded.vertices[i].temperature);
  }
}

TEST(GroupCodecTest, AGroupWithoutSurfaceHasNoVertices) {
  const live::SurfaceGroup group = EncodeGroup({.x = 1}, 2, CodecGrid(), Surface()).group;
  EXPECT_EQ(group.vertex_count(), 0U);
  EXPECT_TRUE(group.vertices().empty());
  EXPECT_EQ(group.key().x(), 1);
}

}  // namespace
}  // namespace isotherm
