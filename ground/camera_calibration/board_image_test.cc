#include "ground/camera_calibration/board_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/simulation/perforated_board.h"
#include "common/simulation/target_camera.h"
#include "ground/camera_calibration/simulated_session.h"
#include "ground/camera_calibration/target_detector.h"

namespace isotherm {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A board before a wall, tilted, with a table in front of it.
class BoardImageTest : public ::testing::Test {
 protected:
  BoardImageTest() {
    const TargetCamera camera(ThesisDepth(), {});
    const Image<std::uint16_t> depth = camera.Depth(PerforatedBoard(), pose_, 3);
    depth_ = Image<float>(depth.width(), depth.height(), kNone);
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        const float wall = 1400.0F + 0.2F * static_cast<float>(x);
        const float table = y > 450 ? 500.0F : kNone;
        const float board = depth.At(x, y) == 0 ? wall : static_cast<float>(depth.At(x, y));
        depth_.At(x, y) = std::isnan(table) ? board : table;
      }
    }
  }

  const RigidTransform pose_ =
      MakeTransform({-0.17, -0.22, 0.75},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.6, 0.8, 0.0))));
  const CalibrationTarget target_ = *ParseTarget("thesis-board");
  Image<float> depth_;
};

TEST_F(BoardImageTest, HolesAreWhereTheBoardIsNot) {
  const Image<float> holes = BoardImage({depth_}, target_);
  const auto detected = DetectTarget(holes, target_);
  ASSERT_TRUE(detected.has_value()) << detected.error().message();
  EXPECT_TRUE(detected->holes_bright);
  const PerforatedBoard board;
  for (int hole = 0; hole < board.holes(); ++hole) {
    const Eigen::Vector2d xy = board.HoleCentre(hole);
    const auto seen = Project(ThesisDepth(), pose_ * Eigen::Vector3d(xy.x(), xy.y(), 0.0));
    ASSERT_TRUE(seen.has_value());
    constexpr double kOneImage_px = 1.5;  // Its rims wander by 0.7.
    EXPECT_LT((detected->features[static_cast<std::size_t>(hole)] - *seen).norm(), kOneImage_px)
        << hole;
    EXPECT_EQ(holes.At(static_cast<int>(seen->x()), static_cast<int>(seen->y())), 1.0F);
  }
}

TEST_F(BoardImageTest, TheContrastIsThatAskedFor) {
  const Image<float> holes = BoardImage({depth_}, target_);
  CalibrationTarget dark = target_;
  dark.contrast = CalibrationTarget::Contrast::kDark;
  const Image<float> inverted = BoardImage({depth_}, dark);
  for (std::size_t i = 0; i < holes.size(); ++i)
    ASSERT_EQ(inverted.pixels()[i], 1.0F - holes.pixels()[i]);
}

/// A room full of things: nothing beside the board is plane.
TEST_F(BoardImageTest, ABoardInClutterIsFound) {
  Image<float> clutter = depth_;
  for (int y = 0; y < clutter.height(); ++y) {
    for (int x = 0; x < clutter.width(); ++x) {
      float& depth = clutter.At(x, y);
      if (depth > 1000.0F || y > 450)
        depth = 1200.0F + 400.0F * std::sin(0.11F * static_cast<float>(x)) *
                              std::cos(0.13F * static_cast<float>(y));
    }
  }
  EXPECT_TRUE(DetectTarget(BoardImage({clutter}, target_), target_).has_value());
}

TEST_F(BoardImageTest, WithoutABoardThereIsNoTarget) {
  const Image<float> nothing(320, 240, kNone);
  EXPECT_FALSE(DetectTarget(BoardImage({nothing}, target_), target_).has_value());
  const Image<float> wall(320, 240, 900.0F);
  EXPECT_FALSE(DetectTarget(BoardImage({wall}, target_), target_).has_value());
  Image<float> speckles(320, 240, kNone);
  for (std::size_t i = 0; i < speckles.size(); i += 97)
    speckles.pixels()[i] = 300.0F + static_cast<float>(i % 4001);
  EXPECT_FALSE(DetectTarget(BoardImage({speckles}, target_), target_).has_value());
}

}  // namespace
}  // namespace isotherm
