#include "ground/surface/upsample_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "ground/surface/reference/upsample_reference.h"

namespace isotherm {
namespace {

using testing::Random;
using testing::Tribool;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kSinglePrecision = 1e-6;  ///< Metres, at up to a metre.

std::array<Image<float>*, 6> Planes(SurfaceMaps& maps) {
  return {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz};
}

class UpsampleRowTest : public ::testing::Test {
 protected:
  /// A wavy wall with a step in it, and pixels without a surface, the last column perhaps as well.
  void Fill(int width, int height, double holes) {
    coarse_ = {};
    coarse_.Resize(width / 2 + 1 + random_.Integer(0, 2), height / 2 + 1 + random_.Integer(0, 2));
    const float step_at = random_.Uniform(0.0F, static_cast<float>(coarse_.width()));
    for (int y = 0; y < coarse_.height(); ++y) {
      for (int x = 0; x < coarse_.width(); ++x) {
        const float n_x = random_.Uniform(-0.3F, 0.3F);
        const Eigen::Vector3f n =
            Eigen::Vector3f(n_x, random_.Uniform(-0.3F, 0.3F), -1).normalized();
        const float z =
            (static_cast<float>(x) < step_at ? 0.6F : 0.8F) + random_.Uniform(0, 0.005F);
        const float vertex[6] = {
            0.004F * static_cast<float>(x), 0.004F * static_cast<float>(y), z, n.x(), n.y(), n.z()};
        const bool hole = random_.Chance(holes);
        for (std::size_t k = 0; k < 6; ++k) Planes(coarse_)[k]->At(x, y) = hole ? kNan : vertex[k];
      }
    }
    fine_ = {};
    fine_.Resize(width, height);
    for (Image<float>* plane : Planes(fine_)) plane->Fill(static_cast<float>(testing::kCanary));
    distance_m_.assign(static_cast<std::size_t>(width) + 1, static_cast<float>(testing::kCanary));
    args_.coarse = &coarse_;
    args_.max_plane_distance_m = 0.005F;
    for (float& coordinate : args_.position) coordinate = random_.Uniform(-0.1F, 0.1F);
  }

  void CompareRow(int y) {
    UpsampleRow(args_, y, fine_, distance_m_.data());
    ASSERT_EQ(distance_m_.back(), static_cast<float>(testing::kCanary)) << "wrote beyond the row";
    if (y + 1 < fine_.height()) {
      for (const Image<float>* plane : Planes(fine_))
        ASSERT_EQ(plane->At(0, y + 1), static_cast<float>(testing::kCanary)) << "into the next row";
    }
    ExpectTheSameWithoutDistances(y);
    for (int x = 0; x < fine_.width() && !HasFatalFailure(); ++x) {
      SCOPED_TRACE(::testing::Message() << "pixel " << x << ", " << y << " of " << fine_.width());
      ComparePixel(x, y);
    }
  }
  void ExpectTheSameWithoutDistances(int y) {
    SurfaceMaps maps;
    maps.Resize(fine_.width(), fine_.height());
    UpsampleRow(args_, y, maps, nullptr);
    for (std::size_t k = 0; k < 6; ++k) {
      ASSERT_EQ(std::memcmp(Planes(maps)[k]->Row(y).data(), Planes(fine_)[k]->Row(y).data(),
                            sizeof(float) * static_cast<std::size_t>(fine_.width())),
                0);
    }
  }
  void ComparePixel(int x, int y) {
    const reference::FinePixel truth = reference::UpsamplePixel(args_, x, y);
    const reference::Vertex vertex = reference::At(fine_, x, y);
    const bool has_vertex = vertex.p.allFinite() && vertex.n.allFinite();
    ASSERT_TRUE(has_vertex || (vertex.p.array().isNaN().all() && vertex.n.array().isNaN().all()));
    if (truth.has_vertex != Tribool::kEither) {
      ASSERT_EQ(has_vertex, truth.has_vertex == Tribool::kYes);
    }
    const float distance = distance_m_[static_cast<std::size_t>(x)];
    if (!has_vertex) {
      ASSERT_NEAR(distance, truth.distance_without, kSinglePrecision);
      (distance == kFar ? far_ : without_) += 1;
      return;
    }
    ASSERT_LT((vertex.p - truth.vertex.p).norm(), kSinglePrecision);
    ASSERT_LT((vertex.n - truth.vertex.n).norm(), kSinglePrecision);
    ASSERT_NEAR(distance, truth.distance_with, kSinglePrecision);
    ++with_;
  }

  Random random_;
  UpsampleRowArgs args_{};
  SurfaceMaps coarse_, fine_;
  std::vector<float> distance_m_;
  int with_ = 0;
  int without_ = 0;
  int far_ = 0;
};

TEST_F(UpsampleRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    with_ = without_ = far_ = 0;
    for (int width = 1; width <= 5 * testing::kMaxLanes; ++width) {
      Fill(width, random_.Integer(1, 6), random_.Chance(0.5) ? 0.1 : 0.6);
      for (int y = 0; y < fine_.height() && !HasFatalFailure(); ++y) CompareRow(y);
    }
    EXPECT_GT(with_, 1000);
    EXPECT_GT(without_, 1000);
    EXPECT_GT(far_, 100);
  });
}

TEST_F(UpsampleRowTest, BetweenNothingThereIsNothing) {
  testing::ForEachInstructionSet([&] {
    Fill(75, 5, 1.0);
    for (int y = 0; y < 5 && !HasFatalFailure(); ++y) CompareRow(y);
    EXPECT_EQ(with_ + without_, 0);
  });
}

TEST_F(UpsampleRowTest, AVertexAtInfinityIsAsFarAsNone) {
  testing::ForEachInstructionSet([&] {
    Fill(75, 4, 0.0);
    coarse_.vz.Fill(kInfinity);
    UpsampleRow(args_, 1, fine_, distance_m_.data());
    for (int x = 0; x < 75; ++x) EXPECT_EQ(distance_m_[static_cast<std::size_t>(x)], kFar);
  });
}

TEST_F(UpsampleRowTest, FromAPositionThatIsNoneAllIsFar) {
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      Fill(75, 4, 0.2);
      args_.position[1] = bad;
      UpsampleRow(args_, 1, fine_, distance_m_.data());
      for (int x = 0; x < 75; ++x) EXPECT_EQ(distance_m_[static_cast<std::size_t>(x)], kFar);
    }
  });
}

}  // namespace
}  // namespace isotherm
